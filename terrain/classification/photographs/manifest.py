"""The file beside labelled photographs that groups them and states their scale."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from odometry.io.csv_columns import opened_csv, unquoted_text
from odometry.io.files import leads_out
from terrain.errors import PatchError


@dataclass(frozen=True)
class Manifest:
    """What `manifest.csv` says.

    Attributes
    ----------
    file : Path
    photo_ids : Mapping[Path, str]
        By resolved path.
    metres_per_pixel : float or None
        The scale of all photographs, where a column `metres_per_pixel` states it.
    runs : tuple of str
        Recordings that patches were cut from, where a column `run` names them.
    """

    file: Path
    photo_ids: Mapping[Path, str]
    metres_per_pixel: float | None
    runs: tuple[str, ...] = ()


def read_manifest(root: Path) -> Manifest | None:
    """The manifest in `root` or its parent; None where neither has one with path and photo_id.

    The parent's is about other folders if it names no file by a name that lies in
    ``root/<class>/``; then there is none.

    Raises
    ------
    PatchError
        Naming file, row and column: no CSV, empty, an empty cell, a path out of its folder, a
        scale that is not a number above zero, or several scales.
    """
    for file in (root / "manifest.csv", root.parent / "manifest.csv"):
        if file.exists() and (table := _columns(file)):
            columns, lines = table
            if file.parent != root and not _names_files_in(root, columns["path"]):
                continue
            runs = tuple(sorted({*columns.get("run", ())} - {""}))
            return Manifest(file, _photo_ids(file, columns, lines), _scale(file, columns), runs)
    return None


def photo_ids_of(manifest: Manifest | None, photos: Sequence[Path]) -> dict[Path, str]:
    """The photo_id of each resolved path that the manifest names; PatchError if it names none.

    A file that was moved to another class is named by its old path: where nothing lies there, and
    no other row of a class beside has its name, the row is of the moved file.
    """
    if manifest is None:
        return {}
    present = {photo.resolve() for photo in photos}
    names = Counter(map(_beside, manifest.photo_ids))
    gone = {
        _beside(path): photo_id
        for path, photo_id in manifest.photo_ids.items()
        if path not in present and names[_beside(path)] == 1
    }
    found = {
        path: photo_id
        for path in present
        if (photo_id := manifest.photo_ids.get(path, gone.get(_beside(path)))) is not None
    }
    if not found:
        raise PatchError(
            f"{manifest.file}: none of its {len(manifest.photo_ids)} paths is one of the "
            f"{len(photos)} photographs: it names {next(iter(manifest.photo_ids))}, and there is "
            f"{photos[0].resolve()}; paths are relative to the folder of manifest.csv"
        )
    return found


def _names_files_in(root: Path, paths: Sequence[str]) -> bool:
    """Whether a path ends in the name of a file in ``root/<class>/``, wherever it leads."""
    named = {path.replace("\\", "/").rpartition("/")[2] for path in paths}
    return any(file.name in named for file in root.glob("*/*"))


def _columns(file: Path) -> tuple[dict[str, list[str]], list[int]] | None:
    """Cells by column, and the line of each row; None where the file is about something else."""
    with opened_csv(file, PatchError) as (header, blocks):
        if header and not {"path", "photo_id"} <= set(header):
            return None
        columns: dict[str, list[str]] = {name: [] for name in header}
        lines: list[int] = []
        for block_lines, cells in blocks:
            lines.extend(block_lines)
            for name, column in zip(header, cells, strict=True):
                columns[name].extend(unquoted_text(cell.strip()) for cell in column)
    if not lines:
        raise PatchError(f"{file}: it is empty; expected the columns path and photo_id, and rows")
    return columns, lines


def _photo_ids(file: Path, columns: Mapping[str, list[str]], lines: list[int]) -> dict[Path, str]:
    photo_ids: dict[Path, str] = {}
    for line, path, photo_id in zip(lines, columns["path"], columns["photo_id"], strict=True):
        for name, cell in (("path", path), ("photo_id", photo_id)):
            if not cell:
                raise PatchError(f"{file}: row {line}, column {name!r}: it is empty")
        if leads_out(file.parent, path):
            raise PatchError(
                f"{file}: row {line}, column 'path': {path!r} leads out of the folder {file.parent}"
            )
        photo_ids[(file.parent / path).resolve()] = photo_id
    return photo_ids


def _scale(file: Path, columns: Mapping[str, list[str]]) -> float | None:
    cells = {cell for cell in columns.get("metres_per_pixel", ()) if cell}
    if not cells:
        return None
    try:
        (scale,) = {float(cell) for cell in cells}
    except ValueError:
        seen = ", ".join(sorted(cells)[:4])
        raise PatchError(f"{file}: metres_per_pixel is {seen}; expected one number") from None
    if not 0 < scale < math.inf:
        raise PatchError(f"{file}: metres_per_pixel is {scale}; expected a number above zero")
    return scale


def _beside(path: Path) -> tuple[Path, str]:
    """What a file keeps when it is moved to a class beside: the folder of classes and its name."""
    return path.parent.parent, path.name
