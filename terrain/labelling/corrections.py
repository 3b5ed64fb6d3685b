"""What someone corrected in a folder of labelled patches: files moved to another class, or gone."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from odometry.io.csv_columns import opened_csv, unquoted_text
from odometry.outputs.manifest import FINISHED, read_manifest
from terrain.errors import PatchError

COLUMNS = {"path", "told"}


@dataclass(frozen=True)
class Corrections:
    """By the name of the file, which no other patch of the folder has.

    Attributes
    ----------
    moved : Mapping of str to str
        The class to which each was moved.
    removed : frozenset of str
    paths : tuple of str
        Of files that do not lie where the manifest says, relative, with slashes.
    """

    moved: Mapping[str, str] = field(default_factory=dict)
    removed: frozenset[str] = frozenset()
    paths: tuple[str, ...] = ()


def read_corrections(folder: Path) -> Corrections:
    """Compare the files of a folder with the manifest that `label` wrote into it.

    A patch that lies in another class than the one of its label was moved; one that lies nowhere
    was removed, unless the folder is unfinished. A folder without such a manifest has no
    corrections.

    Raises
    ------
    PatchError
        If the manifest cannot be read, or a file lies in several classes.
    """
    manifest = folder / "manifest.csv"
    if not manifest.is_file():
        return Corrections()
    output = read_manifest(folder)
    whole = output is not None and output.state == FINISHED
    moved, paths, removed = {}, [], set()
    for path, first in _rows(manifest):
        name = Path(path).name
        found = [path] if (folder / path).is_file() else _elsewhere(folder, name)
        if len(found) > 1:
            raise PatchError(
                f"{folder}: {name} lies in {', '.join(found)}; leave it in one of them"
            )
        if not found and whole:
            removed.add(name)
        label = Path(found[0]).parent.name if found else first
        if label != first:
            moved[name] = label
        paths += [place for place in found if place != path]
    return Corrections(moved, frozenset(removed), tuple(paths))


def _rows(manifest: Path) -> list[tuple[str, str]]:
    with opened_csv(manifest, PatchError) as (header, blocks):
        if not set(header) >= COLUMNS:
            return []
        cells = [cells for _, cells in blocks]
    path, label = (header.index(name) for name in ("path", "told"))
    return [
        (unquoted_text(name), unquoted_text(terrain))
        for block in cells
        for name, terrain in zip(block[path], block[label], strict=True)
    ]


def _elsewhere(folder: Path, name: str) -> list[str]:
    classes = sorted(entry for entry in folder.iterdir() if entry.is_dir())
    return [f"{of.name}/{name}" for of in classes if (of / name).is_file()]
