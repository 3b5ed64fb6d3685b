"""Whether the tables of a results folder are those that were written: their sums and rows."""

import hashlib
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from odometry.outputs.manifest import Manifest, read_manifest

SUMMED = (".csv", ".tum", ".toml", ".json")  # by which other programs go on; no pictures, no pages
# tables of results that have one row for each stamp of the same
EQUAL_ROWS = (
    ("odometer.tum", "odometer.csv", "estimate.csv", "estimate.tum"),
    ("reference.tum", "reference.csv"),
)
SAME_M = 1e-6  # CSV has nine decimals, TUM twelve
BLOCK_BYTES = 2**20
LAST_BYTES = 4096  # more than a row of numbers has


@dataclass(frozen=True)
class Changes:
    """What was done to a folder after it was written, a sentence each.

    Attributes
    ----------
    lost : tuple of str
        Tables that have lost rows.
    edited : tuple of str
        Files that hold something else.
    """

    lost: tuple[str, ...] = ()
    edited: tuple[str, ...] = ()


def table_sums(folder: Path, names: Iterable[str]) -> dict[str, dict[str, Any]]:
    """SHA-256 and number of lines of the tables among some files of a folder."""
    return {
        name: dict(zip(("sha256", "lines"), _sum(folder / name), strict=True))
        for name in names
        if name.endswith(SUMMED)
    }


def changes_of(folder: Path) -> Changes:
    """Compare a results folder with its manifest; of an older one, its tables with each other.

    Parameters
    ----------
    folder : Path
        That `run` wrote; without a manifest where the library wrote it.

    Raises
    ------
    OutputError
        If the manifest is damaged.
    """
    manifest = read_manifest(folder)
    if manifest is None or not manifest.sums:
        return _by_each_other(folder)
    return _by_sums(folder, manifest)


def _by_sums(folder: Path, manifest: Manifest) -> Changes:
    lost, edited = [], []
    for name, written in manifest.sums.items():
        with suppress(OSError):  # a file that is missing is missed by those who read it
            sha256, lines = _sum(folder / name)
            if sha256 == written["sha256"]:
                continue
            if lines < written["lines"] and name.endswith((".csv", ".tum")):
                lost.append(_lost(folder / name, lines, written["lines"]))
            else:
                edited.append(f"{folder / name} is not as `{manifest.verb}` wrote it: edited since")
    return Changes(tuple(lost), tuple(edited))


def _by_each_other(folder: Path) -> Changes:
    lost, edited = [], []
    for names in EQUAL_ROWS:
        files = [folder / name for name in names if (folder / name).is_file()]
        rows = {file: _rows(file, _sum(file)[1]) for file in files}
        most = max(rows.values(), key=lambda n: (list(rows.values()).count(n), n), default=0)
        like = next((file.name for file in files if rows[file] == most), "")
        for file in files:
            tum = file.with_suffix(".tum")
            if rows[file] < most:
                lost.append(_said(file, rows[file], most, f"in {like}"))
            elif rows[file] > most:
                edited.append(f"{file} has {rows[file]} rows, and {like} {most}")
            elif file != tum and rows.get(tum) == most and not _same_ends(file, tum):
                edited.append(f"{file} differs from {tum.name}")
    return Changes(tuple(lost), tuple(edited))


def _lost(file: Path, lines: int, written: int) -> str:
    return _said(file, _rows(file, lines), _rows(file, written), "as it was written")


def _said(file: Path, rows: int, wanted: int, where: str) -> str:
    return f"{file} has {rows} rows, and {wanted} {where}: rows are lost"


def _rows(file: Path, lines: int) -> int:
    """Rows of a file of so many lines, the header of a CSV file left out."""
    return lines - (file.suffix == ".csv")


def _same_ends(table: Path, tum: Path) -> bool:
    """Whether the first and last t, x, y of two files agree; so it is said of odd ones."""
    try:
        pairs = zip(_ends(table, ",", 1), _ends(tum, None, 0), strict=True)
        return all(abs(a - b) <= SAME_M for a, b in pairs)
    except (OSError, ValueError):
        return True  # whoever reads them says what is wrong


def _ends(file: Path, separator: str | None, header: int) -> list[float]:
    with file.open("rb") as stream:
        first = [stream.readline() for _ in range(header + 1)][-1]
        stream.seek(max(0, file.stat().st_size - LAST_BYTES))
        last = stream.read().rstrip().split(b"\n")[-1]
    rows = [line.decode().split(separator)[:3] for line in (first, last)]
    return [float(cell) for row in rows for cell in row]


def _sum(file: Path) -> tuple[str, int]:
    """SHA-256 of a file's bytes in hexadecimal, and its number of lines, blank ones at its end not.

    A line that an editor adds at the end is no row.
    """
    digest, lines, ends = hashlib.sha256(), 0, 0  # ends: of lines that may be the last
    with file.open("rb") as stream:
        while block := stream.read(BLOCK_BYTES):
            digest.update(block)
            content = block.rstrip()
            if content:
                lines, ends = lines + ends + content.count(b"\n"), 0
            ends += block.count(b"\n", len(content))
    return digest.hexdigest(), lines + 1
