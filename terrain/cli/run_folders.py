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
        if not ctx.resilient_parsing:
            self._refuse_doubtful(ctx, args)
        return super().parse_args(ctx, args)

    def _refuse_doubtful(self, ctx: click.Context, args: list[str]) -> None:
        """Click's error where one of several runs follows that of an option.

        Nothing where help is asked for, or an option that there is not: click says so.
        """
        params = [p for p in self.get_params(ctx) if isinstance(p, click.Option)]
        options = {name: p for p in params for name in (*p.opts, *p.secondary_opts)}
        option: click.Option | None = None
        runs: list[str] = []
        following: dict[str, list[str]] = {}
        words = iter(args)
        for word in words:
            name = word.partition("=")[0]
            if word == "--":
                runs += words
            elif name in ctx.help_option_names or (word[:1] == "-" and name not in options):
                return
            elif name in options:
                option = options[name]
                if "=" not in word and not option.is_flag:
                    next(words, None)
            else:
                runs.append(word)
                if option is not None and isinstance(option.type, RunFolder):
                    following.setdefault(option.opts[0], []).append(word)
        for name, own in following.items():
            if len(runs) > 1:
                ctx.fail(
                    f"{' '.join(own)} after a run of {name}: write {name} before each of its runs, "
                    f"and {self._runs()} before all options"
                )

    def _runs(self) -> str:
        """What the usage calls the runs that belong to no option."""
        return next(str(p.metavar) for p in self.params if isinstance(p, click.Argument))


def run_folders(command: Callable[..., None]) -> Callable[..., None]:
    """Add the run folders RUN...; the command gets them as `folders`."""
    return click.argument("folders", metavar="RUN...", nargs=-1, required=True, type=RunFolder())(
        command
    )
