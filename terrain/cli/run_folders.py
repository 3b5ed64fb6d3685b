"""Run folders on the command line: those of the verb, and those of its options."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click


class RunFolder(click.Path):
    """A run folder; for a bag the error says how to import it."""

    def __init__(self) -> None:
        super().__init__(file_okay=False, path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The path, click's error for another file, or a RunFolderError for a bag."""
        from odometry.errors import RunFolderError
        from odometry.io.run_folder import bag_at, this_is_a_bag

        if bag_at(Path(value)):
            raise RunFolderError(this_is_a_bag(Path(value)))
        return super().convert(value, param, ctx)


class RunsFirst(click.Command):
    """Refuses runs that follow the one run of an option: nobody could say whose they are.

    What a shell makes of `--calibration yard_*` would be one calibration run, and the others
    measured ones.
    """

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Click's own, or its error; a run that is the only one of the verb may stand anywhere."""
        options = {o: p for p in self.params if isinstance(p, click.Option) for o in p.opts}
        after: dict[str, list[str]] = {}
        option, words = "", iter(args)
        for word in words:
            name = word.partition("=")[0]
            if name not in options:
                after.setdefault(option, []).append(word)
                continue
            option = name
            if "=" not in word and not options[name].is_flag:
                next(words, None)
        if sum(map(len, after.values())) > 1:
            for option, runs in after.items():
                if option and isinstance(options[option].type, RunFolder):
                    ctx.fail(
                        f"{' '.join(runs)} after a run of {option}: write {option} before "
                        f"each of its runs, and {self._runs()} before all options"
                    )
        return super().parse_args(ctx, args)

    def _runs(self) -> str:
        """What the usage calls the runs that belong to no option."""
        return next(str(p.metavar) for p in self.params if isinstance(p, click.Argument))


def run_folders(command: Callable[..., None]) -> Callable[..., None]:
    """Add the run folders RUN...; the command gets them as `folders`."""
    return click.argument("folders", metavar="RUN...", nargs=-1, required=True, type=RunFolder())(
        command
    )
