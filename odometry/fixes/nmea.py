"""NMEA 0183 as receivers log it: places and quality of GGA, the date of RMC or ZDA.

`$GNGGA,101530.20,4807.0380000,N,01131.0000000,E,4,12,0.6,512.5,M,46.9,M,1.0,0000*5C`. Other
sentences, and what a program wrote before the $, are passed over.
"""

import re
from collections.abc import Iterator
from datetime import UTC, datetime
from functools import reduce
from itertools import islice
from operator import xor
from pathlib import Path

import numpy as np

from odometry.errors import TrajectoryError
from odometry.fixes.fix_columns import MOST_LINES, solution_columns
from odometry.fixes.fix_file import FixFile
from odometry.io.files import opened_lines

SENTENCE = re.compile(r"\$([A-Z]{2}(GGA|RMC|ZDA),[^*$]*)\*([0-9A-Fa-f]{2})")
GGA = re.compile(r"\$[A-Z]{2}GGA,")
KINDS = (
    *("no fix", "single", "dgps", "pps", "fix", "float"),
    *("estimated", "manual", "simulated"),
)  # by the quality of GGA
DAY_S = 86_400.0
TIME, LATITUDE, LONGITUDE, HEIGHT, QUALITY = "UTC", "latitude", "longitude", "height", "quality"
NAMES = (TIME, LATITUDE, LONGITUDE, HEIGHT, QUALITY)


def read_nmea(file: Path) -> FixFile | None:
    """The GGA sentences of a log, heights above the ellipsoid; None of other files.

    Raises
    ------
    TrajectoryError
        If no sentence is whole, none states a date, or naming the row of one that cannot be read.
    """
    with opened_lines(file, TrajectoryError) as lines:
        if not any(map(GGA.search, islice(lines, MOST_LINES))):
            return None
    with opened_lines(file, TrajectoryError) as lines:
        places, days = _sentences(lines, file)
    days = _since_first_fix(days, places) or days
    if not places or not days:
        missing = "RMC or ZDA, which state the date" if places else "GGA with a right checksum"
        raise TrajectoryError(f"{file}: it has no sentence {missing}")
    rows = [(dated, *place[2]) for dated, place in zip(_dated(places, days), places, strict=True)]
    named = solution_columns(LATITUDE, LONGITUDE, HEIGHT, TIME, QUALITY)
    cells = {
        name: list(column) for name, column in zip(NAMES, zip(*rows, strict=True), strict=True)
    }
    return FixFile(file, named, np.array([row for row, _, _ in places], dtype=np.int64), cells)


Place = tuple[int, float, tuple[str, ...]]  # line, seconds of the day, cells
Stamp = tuple[int, float, bool]  # line, seconds since 1970, whether the receiver vouches for it


def _sentences(lines: Iterator[str], file: Path) -> tuple[list[Place], list[Stamp]]:
    """Places, and full stamps of the sentences that state a date, each with its line."""
    places: list[Place] = []
    stamps: list[Stamp] = []
    for number, line in enumerate(lines, 1):
        found = SENTENCE.search(line)
        if found is None or reduce(xor, found[1].encode()) != int(found[3], 16):
            continue
        fields = found[1].split(",")
        try:
            if found[2] == "GGA" and fields[1]:
                places.append((number, _of_day_s(fields[1]), _cells(fields)))
            elif (
                found[2] != "GGA" and fields[1] and (day_s := _day_s(found[2], fields)) is not None
            ):
                stamps.append((number, day_s + _of_day_s(fields[1]), found[2] == "RMC"))
        except (ValueError, IndexError) as error:
            raise TrajectoryError(
                f"{file}: row {number}: {found[0][:80]!r} cannot be read as {found[2]}"
            ) from error
    return places, stamps


def _since_first_fix(stamps: list[Stamp], places: list[Place]) -> list[Stamp]:
    """Without those of ZDA before there is a fix: it states a date that nobody knows yet."""
    begin = next((line for line, _, cells in places if cells[-1] != KINDS[0]), 0)
    return [stamp for stamp in stamps if stamp[2] or stamp[0] > begin]


def _of_day_s(text: str) -> float:
    """Seconds of the day of hhmmss.ss."""
    return 3600 * int(text[:2]) + 60 * int(text[2:4]) + float(text[4:])


def _day_s(kind: str, fields: list[str]) -> float | None:
    """Where a day begins, in seconds since 1970; None where it is not stated, or not yet known."""
    if kind == "RMC" and fields[2] != "A":
        return None
    if kind == "RMC":
        text = fields[9]
        day, month, year = text[:2], text[2:4], text[4:] and f"20{text[4:]}"
    else:
        day, month, year = fields[2:5]
    if not (day and month and year):
        return None
    return datetime(int(year), int(month), int(day), tzinfo=UTC).timestamp()


def _cells(fields: list[str]) -> tuple[str, ...]:
    """Latitude, longitude [degrees], height [m] and kind of a GGA sentence, empty without."""
    latitude, longitude = (_degrees(fields[of], fields[of + 1]) for of in (2, 4))
    kind = KINDS[int(fields[6] or 0)]
    height = repr(float(fields[9]) + float(fields[11] or 0)) if fields[9] else ""
    return latitude, longitude, height, kind


def _degrees(text: str, side: str) -> str:
    """Degrees of dddmm.mmmm and N, S, E or W."""
    if not text:
        return ""
    point = (text + ".").index(".")
    value = int(text[: point - 2]) + float(text[point - 2 :]) / 60
    return repr(-value if side in {"S", "W"} else value)


def _dated(places: list[Place], stamps: list[Stamp]) -> list[str]:
    """Seconds since 1970 of times of day: nearest to the stamp that is nearest in the file."""
    numbers, of_day_s = np.array([place[:2] for place in places]).T
    lines, known_s = np.array([stamp[:2] for stamp in stamps]).T
    near_s = known_s[np.searchsorted((lines[1:] + lines[:-1]) / 2, numbers)]
    stamps_s = np.floor(near_s / DAY_S) * DAY_S + of_day_s
    return [*map(repr, (stamps_s + DAY_S * np.round((near_s - stamps_s) / DAY_S)).tolist())]
