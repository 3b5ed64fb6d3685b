"""Rows of a CSV file of satellite fixes that are places: what is left out, and why."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.errors import TrajectoryError
from odometry.fixes.degrees import far_away, in_degrees, rounded
from odometry.fixes.fix_file import FixFile, read_fix_file
from odometry.fixes.fix_states import kinds, lesser, no_fix
from odometry.fixes.local_metres import on_earth, zeros_within_deg
from odometry.fixes.nmea import read_nmea
from odometry.fixes.rtklib import read_rtklib
from odometry.tables.table import Table

# A log that is faster than its receiver holds each place for nearly the same number of rows; a
# rounded place stays for as long as the robot needs to leave it
HELD, EVENLY = 0.5, 0.8  # shares of the rows that repeat a place, and of even holds
FEWEST = 4  # places: fewer are of a receiver that stands, or is frozen


@dataclass(frozen=True)
class Fixes:
    """Places by satellites.

    Attributes
    ----------
    stamps_s : (N,)
        Strictly increasing.
    places : (N, 3)
        Latitude, longitude [degrees, WGS 84], altitude [m] or NaN.
    notes, losses : tuple of str
        How the file was read; what was left out.
    """

    stamps_s: FloatArray
    places: FloatArray
    notes: tuple[str, ...]
    losses: tuple[str, ...]


def read_fixes(file: Path, odometry: Table | None = None) -> Fixes | None:
    """Read places of CSV with latitude and longitude, RTKLIB or NMEA; None of any other file.

    Parameters
    ----------
    file : Path
    odometry : Table, optional
        Of several columns of stamps the first that shares time with it is taken.

    Raises
    ------
    TrajectoryError
        Naming file, row and column of what cannot be read; if no row is a place, or most stamps
        go back.
    """
    found = read_rtklib(Path(file)) or read_nmea(Path(file)) or read_fix_file(Path(file))
    if found is None:
        return None
    losses: list[str] = []
    stamps_s, words = _stamps(found, odometry)
    angles = found.angles
    kept = np.asarray(np.isfinite(angles).all(axis=1))
    _lose(losses, ~kept, "without latitude or longitude", found)
    for state in found.columns.states:
        none = no_fix(found, state)
        _lose(losses, none & kept, f"without a fix ({state.column!r} says so)", found)
        kept &= ~none
    if not kept.any():
        raise TrajectoryError(f"{file}: no row has a fix: {'; '.join(losses)}")
    for state in found.columns.states:
        worse, why = lesser(found, state, kept)
        _lose(losses, worse, why, found)
        kept &= ~worse
    angles[kept], unit = in_degrees(angles[kept], found.columns.latitude.says, found.file)
    for wrong, why in _no_places(angles, kept):
        _lose(losses, wrong, why, found)
        kept &= ~wrong
    for wrong, why in _no_stamps(stamps_s, kept, found):
        _lose(losses, wrong, why, found)
        kept &= ~wrong
    if not kept.any():
        raise TrajectoryError(f"{file}: no row has a place: {'; '.join(losses)}")
    held = _held(angles, kept)
    _lose(losses, held, "that hold the place before: the log is faster than its receiver", found)
    kept &= ~held
    altitudes_m, altitude_note = found.altitudes_m(of_whole_degrees=unit.startswith("whole"))
    angles[:, 1] = (angles[:, 1] + 180) % 360 - 180
    notes = [f"stamps: {words}"]
    notes += [f"latitude and longitude are read as {unit}"] if unit else []
    notes += filter(None, (kinds(found, state, kept) for state in found.columns.states))
    digits = "" if unit else rounded(angles[kept])
    notes += [note for note in (altitude_note, digits) if note]
    places = np.column_stack([angles, altitudes_m])[kept]
    return Fixes(stamps_s[kept], places, tuple(notes), tuple(losses))


def _stamps(found: FixFile, odometry: Table | None) -> tuple[FloatArray, str]:
    """Stamps of the first column that shares time with the odometry, else of the first one."""
    if odometry is None:
        return found.stamps_s(found.columns.stamps[0])
    begin_s, end_s = odometry.stamps_s[[0, -1]].tolist()
    others: list[tuple[FloatArray, str]] = []
    errors: list[TrajectoryError] = []
    for of in found.columns.stamps:
        try:
            stamps_s, words = found.stamps_s(of, end_s - begin_s)
        except TrajectoryError as error:
            errors.append(error)
            continue
        if ((stamps_s >= begin_s) & (stamps_s <= end_s)).any():
            return stamps_s, words
        others.append((stamps_s, words))
    if not others:
        raise errors[0]
    return others[0]


def _no_places(degrees: FloatArray, kept: BoolArray) -> Iterator[tuple[BoolArray, str]]:
    farthest_deg = float(np.abs(degrees[kept]).max())
    zeros = (np.abs(degrees) <= zeros_within_deg(farthest_deg)).all(axis=1) & kept
    yield zeros, "without a fix (latitude and longitude are zero)"
    outside = kept & ~zeros & ~on_earth(degrees)
    yield outside, "that are no place on Earth"
    near = kept & ~zeros & ~outside
    far = np.zeros(len(degrees), dtype=bool)
    if near.any():
        far[near] = far_away(degrees[near])
    yield far, "more than 100 km from the others"


def _no_stamps(
    stamps_s: FloatArray, kept: BoolArray, found: FixFile
) -> Iterator[tuple[BoolArray, str]]:
    """Rows whose stamps are missing, are there already, or go back.

    Raises
    ------
    TrajectoryError
        If most go back.
    """
    missing = kept & ~np.isfinite(stamps_s)
    yield missing, "without a stamp"
    rows = np.flatnonzero(kept & ~missing)
    before_s = np.concatenate([[-np.inf], np.maximum.accumulate(stamps_s[rows])[:-1]])
    back, again = np.zeros_like(kept), np.zeros_like(kept)
    back[rows] = stamps_s[rows] < before_s
    again[rows] = stamps_s[rows] == before_s
    if np.count_nonzero(back) > len(rows) / 2:
        row = int(np.flatnonzero(back)[0])
        raise TrajectoryError(
            f"{found.file}: row {found.lines[row]}: its stamp goes back, as in "
            f"{np.count_nonzero(back)} of {len(rows)} rows. Sort the rows by time, or name the "
            "right column 't'"
        )
    yield again, "that repeat a stamp"
    yield back, "whose stamp goes back"


def _held(degrees: FloatArray, kept: BoolArray) -> BoolArray:
    """Rows (N,) that only repeat the place before, where a log does so evenly; else none.

    Nor where places have few digits: a moving robot leaves such small cells evenly as well.
    """
    rows = np.flatnonzero(kept)
    repeats = np.append(False, (np.diff(degrees[rows], axis=0) == 0).all(axis=1))
    held = np.zeros_like(kept)
    lengths = np.diff(np.append(np.flatnonzero(~repeats), len(rows)))
    evenly = np.abs(lengths - np.median(lengths)) <= 1
    is_fine = not rounded(degrees[rows])
    if is_fine and len(lengths) >= FEWEST and repeats.mean() >= HELD and evenly.mean() >= EVENLY:
        held[rows] = repeats
    return held


def _lose(losses: list[str], wrong: BoolArray, why: str, found: FixFile) -> None:
    if wrong.any():
        first = int(found.lines[int(np.argmax(wrong))])
        losses.append(f"{np.count_nonzero(wrong)} of {len(wrong)} rows {why}, row {first} first")
