"""Positions that RTKLIB wrote (rnx2rtkp, RTKPOST, RTKNAVI, receivers of Emlid): `.pos` files.

Lines that begin with % stand above; the last of them names the system of time and the columns. A
row begins with its time in two words: a date and a time of day, or a GPS week and its seconds.
"""

import re
from pathlib import Path

import numpy as np

from odometry.errors import TrajectoryError
from odometry.fixes.fix_columns import solution_columns
from odometry.fixes.fix_file import FixFile, is_number
from odometry.fixes.fix_stamps import date_s
from odometry.io.files import opened_lines

HEADER = re.compile(r"%\s*(GPST|UTC|JST)\b")
BETWEEN = re.compile(r"[\s,;]+")
LATITUDE, LONGITUDE, HEIGHT, QUALITY = "latitude(deg)", "longitude(deg)", "height(m)", "Q"
KINDS = ("no fix", "fix", "float", "sbas", "dgps", "single", "ppp")  # by Q
DIGITS = frozenset(map(str, range(len(KINDS))))
GPS_BEGAN_S, WEEK_S = 315_964_800.0, 604_800.0  # 6 January 1980
# Seconds by which GPS time is ahead of UTC from a moment on (IERS Bulletin C), the last one first
LEAPS = (
    *((1_483_228_800.0, 18.0), (1_435_708_800.0, 17.0), (1_341_100_800.0, 16.0)),
    *((1_230_768_000.0, 15.0), (1_136_073_600.0, 14.0), (915_148_800.0, 13.0)),
)
JAPAN_S = 9 * 3600.0


def read_rtklib(file: Path) -> FixFile | None:
    """The columns of a file of RTKLIB, stamps in seconds since 1970 (UTC); None of other files.

    Raises
    ------
    TrajectoryError
        If the positions are no latitude and longitude in degrees, or naming the row that has no
        time, or other columns than the header.
    """
    header, rows = _rows(file)
    if not HEADER.match(header):
        return None
    system, *names = BETWEEN.split(header.lstrip("% ").strip())
    if not {LATITUDE, LONGITUDE, HEIGHT, QUALITY} <= set(names):
        raise TrajectoryError(
            f"{file}: its columns are {', '.join(names[:5])} ...; expected {LATITUDE}, "
            f"{LONGITUDE}, {HEIGHT} and {QUALITY}: let RTKLIB write these (out-solformat = llh, "
            "out-degform = deg)"
        )
    if not rows:
        raise TrajectoryError(f"{file}: there are no rows below the header")
    stamps = []
    for number, row in rows.items():
        stamp_s = _stamp_s(row[:2], system)
        if stamp_s is None or len(row) != len(names) + 2:
            raise TrajectoryError(
                f"{file}: row {number}: {' '.join(row)[:60]!r} is not as the header says: a time "
                f"in two words ({system}), and {len(names)} numbers"
            )
        stamps.append(repr(stamp_s))
    columns = dict(zip(names, zip(*(row[2:] for row in rows.values()), strict=True), strict=True))
    cells = {name: list(columns[name]) for name in (LATITUDE, LONGITUDE, HEIGHT)}
    kinds = [KINDS[int(q)] if q in DIGITS else q for q in columns[QUALITY]]
    time = system if system == "UTC" else f"{system}, made UTC"
    named = solution_columns(LATITUDE, LONGITUDE, HEIGHT, time, QUALITY)
    return FixFile(file, named, np.array([*rows]), cells | {time: stamps, QUALITY: kinds})


def _rows(file: Path) -> tuple[str, dict[int, list[str]]]:
    """The last line above, and the words of each row by its line; no rows of other files."""
    header, rows = "", {}
    with opened_lines(file, TrajectoryError) as lines:
        for number, line in enumerate(lines, 1):
            if line.startswith("%"):
                header = line
            elif not HEADER.match(header):
                return "", {}
            elif line.strip():
                rows[number] = BETWEEN.split(line.strip())
    return header, rows


def _stamp_s(words: list[str], system: str) -> float | None:
    """Seconds since 1970 of a time in two words; None of other words."""
    if len(words) == 2 and all(map(is_number, words)):
        stamp_s: float | None = GPS_BEGAN_S + WEEK_S * float(words[0]) + float(words[1])
    else:
        stamp_s = date_s(" ".join(words))
    if stamp_s is None or not np.isfinite(stamp_s):
        return None
    return stamp_s - {"GPST": gps_ahead_s(stamp_s), "JST": JAPAN_S}.get(system, 0.0)


def gps_ahead_s(stamp_s: float) -> float:
    """Seconds by which GPS time is ahead of UTC; `stamp_s` is GPS time since 1970."""
    return next((ahead for since_s, ahead in LEAPS if stamp_s - ahead >= since_s), LEAPS[-1][1])
