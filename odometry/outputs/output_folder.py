"""A folder as an output: made aside, then moved into its place, and marked while that lasts."""

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from odometry.errors import OutputError
from odometry.io.files import check_writable, naming_full
from odometry.outputs.leftovers import is_temporary, remove_stages, remove_temporaries, stage_name
from odometry.outputs.manifest import FINISHED, NAME, TO_DO, UNFINISHED, Manifest, read_manifest
from odometry.outputs.own_names import files_of_version_0_4, has_own_name
from odometry.outputs.provenance import Made
from odometry.outputs.written_tables import table_sums

SUMMED_VERBS = ("run",)  # other verbs read its tables; a run folder is meant to be edited


@dataclass(frozen=True)
class OutputFolder:
    """A folder that was found to be free, or to hold what the same verb made before.

    Attributes
    ----------
    out : Path
    made : Made
    earlier : tuple of str
        Names of the files that an earlier run wrote there, relative, with slashes.
    when_whole : callable
        Of `out`, once it is written and whole.
    """

    out: Path
    made: Made
    earlier: tuple[str, ...]
    when_whole: Callable[[Path], None] = lambda _: None

    @contextmanager
    def writing(self) -> Iterator[Path]:
        """Give a folder to write to; its files move to `out` if the block succeeds.

        A block that fails leaves `out` as it was. `out` is marked unfinished while it has no
        whole result, and while files move; what an earlier run wrote and this one did not is
        removed. A file of the same name that is no output of ours stops the move before it
        begins.

        Raises
        ------
        OutputError
            If a file cannot be written or moved.
        """
        made = [folder for folder in (self.out, *self.out.parents) if not folder.exists()]
        stage = self.out / stage_name()
        try:
            with _naming(stage, self.out):
                stage.mkdir(parents=True)
                if not self.earlier:
                    Manifest(self.made.verb, UNFINISHED, ()).write(self.out)
                yield stage
                self._move(stage)
                self.when_whole(self.out)
        except BaseException as error:
            shutil.rmtree(stage, ignore_errors=True)
            error.add_note(self._left(made))
            raise
        shutil.rmtree(stage, ignore_errors=True)

    def _move(self, stage: Path) -> None:
        """Move the files of the temporary folder to their places, and mark the folder finished."""
        new = tuple(
            f.relative_to(stage).as_posix() for f in sorted(stage.rglob("*")) if f.is_file()
        )
        _refuse_in_the_way(self.out, new, self.earlier, self.made.verb)
        both = tuple(sorted({*self.earlier, *new}))
        Manifest(self.made.verb, UNFINISHED, both).write(self.out)
        for name in sorted({*self.earlier} - {*new}):
            (self.out / name).unlink(missing_ok=True)
        for name in new:
            (self.out / name).parent.mkdir(parents=True, exist_ok=True)
            (stage / name).replace(self.out / name)
        for name in both:
            _remove_empty((self.out / name).parent, self.out)
        sums = table_sums(self.out, new) if self.made.verb in SUMMED_VERBS else {}
        Manifest(self.made.verb, FINISHED, new, self.made.to_table(), sums).write(self.out)

    def _left(self, made: list[Path]) -> str:
        """Tidy up after a failure, and say what there is in the folder now."""
        now = read_manifest(self.out) if self.out.is_dir() else None
        if now is not None and now.state == UNFINISHED and now.files:
            return f"{self.out} is unfinished: run the command again"
        if now is not None and now.state == UNFINISHED:
            (self.out / NAME).unlink()
            for folder in made:
                _remove_empty(folder, folder.parent)
        if self.earlier:
            return f"{self.out} holds the earlier result, unchanged"
        return f"nothing was written to {self.out}"


def claim_folder(out: Path, made: Made) -> OutputFolder:
    """Find out before long work whether a folder may be written to; clean up after a killed run.

    Raises
    ------
    OutputError
        If the folder cannot be written to, is not empty and was not made by the same verb, has
        files of the names of our own that are not ours, or another process is writing there.
    """
    check_writable(out)
    if not out.exists() or all(is_temporary(entry.name) for entry in out.iterdir()):
        earlier: tuple[str, ...] = ()
    else:
        earlier = _earlier_files(out, made.verb)
    if out.exists():
        remove_stages(out)
        _refuse_strangers(out, made.verb, earlier)
        for folder in sorted({out, *((out / name).parent for name in earlier)}):
            remove_temporaries(folder, _is_own_in(folder, out, made.verb))
    return OutputFolder(out, made, earlier)


def _earlier_files(out: Path, verb: str) -> tuple[str, ...]:
    """What an earlier run of the same verb wrote into a folder that is not empty."""
    manifest = read_manifest(out)
    if manifest is not None:
        if manifest.verb != verb:
            raise OutputError(f"{out} holds what `{manifest.verb}` made; {TO_DO}")
        return manifest.files
    found = files_of_version_0_4(out, verb)
    if not found:
        raise OutputError(f"{out} is not empty, and `{verb}` did not make it; {TO_DO}")
    return found


def _refuse_strangers(out: Path, verb: str, earlier: tuple[str, ...]) -> None:
    """Raise if files that are not ours have names that the verb may want to write."""
    names = (f.relative_to(out).as_posix() for f in out.rglob("*") if not f.is_dir())
    wanted = tuple(name for name in names if has_own_name(verb, name))
    _refuse_in_the_way(out, wanted, earlier, verb)


def _refuse_in_the_way(
    out: Path, wanted: tuple[str, ...], earlier: tuple[str, ...], verb: str
) -> None:
    for name in wanted:
        place = out / name
        inner = [parent for parent in place.parents if out in parent.parents]
        foreign = [p for p in inner if p.is_symlink() or (p.exists() and not p.is_dir())]
        if place.is_dir() or (name not in earlier and (place.exists() or place.is_symlink())):
            foreign.append(place)
        if foreign:
            raise OutputError(
                f"{foreign[0]}: it is in the way, and `{verb}` did not make it; move it, or "
                "choose another --out"
            )


def _is_own_in(folder: Path, out: Path, verb: str) -> Callable[[str], bool]:
    def is_own(name: str) -> bool:
        inside = (folder / name).relative_to(out).as_posix()
        return inside == NAME or has_own_name(verb, inside)

    return is_own


def _remove_empty(folder: Path, root: Path) -> None:
    """Remove a folder, and those that hold it up to `root`, as long as they are empty."""
    while folder != root and folder.is_dir() and not any(folder.iterdir()):
        folder.rmdir()
        folder = folder.parent


@contextmanager
def _naming(stage: Path, out: Path) -> Iterator[None]:
    """Name in messages the file that was to be made, not the temporary one."""
    try:
        with naming_full(stage):
            yield
    except OutputError as error:
        raise OutputError(str(error).replace(str(stage), str(out))) from error
