"""Which columns of a CSV file are latitude, longitude, altitude, stamps and state of a receiver.

Names are those of ROS tools (rostopic echo, bagpy, PlotJuggler), of flight logs and of logging
apps: `latitude`, `field.latitude`, `/gps/fix/latitude`, `Latitude (deg)`, `lat`, `gps_lat`.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from odometry.errors import TrajectoryError
from odometry.io.files import opened_lines

SEPARATORS = (",", ";", "\t")
MOST_LINES = 30  # above the header
OF = r"(?:(?:gps|gnss|fix|nav|ros|rosbag|unix|utc|header|epoch)_)*"
ANGLE = r"(?:_(?P<unit>deg|degrees|rad|radians|e7|1e7))?"
LATITUDE = re.compile(rf"{OF}(?:lat|latitude){ANGLE}")
LONGITUDE = re.compile(rf"{OF}(?:lon|lng|long|longitude){ANGLE}")
ALTITUDE = re.compile(rf"{OF}(?:alt|altitude|height|elevation|ele)(?:_msl)?(?:_(?P<unit>m|mm))?")
STAMP = re.compile(
    rf"{OF}(?:t|time|timestamp|stamp|utc|date_?time|epoch|unix|i?tow|secs?|seconds(?:_elapsed)?)"
    r"(?:_utc)?"
    r"_?(?P<unit>s|sec|secs|seconds|ms|msec|us|usec|ns|nsec)?"
)
WHOLE = re.compile(r"(?P<of>.*?)secs?")  # seconds of a stamp whose nanoseconds are another column
REST = re.compile(r"(?P<of>.*?)(?:nsecs?|nanosecs?)")
# What `ros2 topic echo --csv` prints of a NavSatFix, which has no header
ECHOED = (
    *("header.stamp.sec", "header.stamp.nanosec", "header.frame_id", "status.status"),
    *("status.service", "latitude", "longitude", "altitude"),
    *(f"position_covariance.{k}" for k in range(9)),
    "position_covariance_type",
)
STATE = re.compile(
    rf"{OF}(?:(?P<navsat>status)|(?P<kind>fix_?type)|(?P<quality>fix_?quality|quality|qual)|"
    r"(?P<flag>fix|has_fix|fix_valid))"
)


@dataclass(frozen=True)
class Named:
    """A column: its name in the file, and the unit or the kind that the name states."""

    column: str
    says: str = ""


@dataclass(frozen=True)
class FixColumns:
    """What the columns of a file are.

    Attributes
    ----------
    latitude, longitude : Named
    altitude : Named or None
    stamps : tuple of Named or (Named, Named)
        The likeliest first: of a pair seconds, and nanoseconds behind them.
    states : tuple of Named
        Say whether there was a fix: navsat, kind, quality or flag.
    """

    latitude: Named
    longitude: Named
    altitude: Named | None
    stamps: tuple[Named | tuple[Named, Named], ...]
    states: tuple[Named, ...]


def solution_columns(
    latitude: str, longitude: str, height: str, stamp: str, kind: str
) -> FixColumns:
    """Those of a receiver's log: degrees, metres, seconds, and the kind of each solution."""
    return FixColumns(
        Named(latitude, "deg"),
        Named(longitude, "deg"),
        Named(height, "m"),
        (Named(stamp, "s"),),
        (Named(kind, "solution"),),
    )


@dataclass(frozen=True)
class Header:
    """Lines above the header, the separator, and the names of the columns of a file without one."""

    before: int = 0
    separator: str = ","
    names: tuple[str, ...] = ()


def header_of(file: Path) -> Header | None:
    """Where a file names latitude and longitude; None of other files.

    Raises
    ------
    TrajectoryError
        If the file cannot be read as text.
    """
    with opened_lines(file, TrajectoryError) as lines:
        for before, line in enumerate(islice(lines, MOST_LINES)):
            if before == 0 and _is_echoed(line.split(",")):
                return Header(names=ECHOED)
            for separator in SEPARATORS:
                names = [plain(cell)[0] for cell in line.split(separator)]
                if all(any(map(kind.fullmatch, names)) for kind in (LATITUDE, LONGITUDE)):
                    return Header(before, separator)
    return None


def _is_echoed(cells: Sequence[str]) -> bool:
    """Whether a row is a NavSatFix: whole seconds and nanoseconds, a frame, 15 numbers."""
    if len(cells) != len(ECHOED) or not (cells[0] + cells[1]).isdigit():
        return False
    try:
        list(map(float, cells[3:]))
    except ValueError:
        return False
    return True


def plain(cell: str) -> tuple[str, str]:
    """The last part of a name in small letters, and its unit in brackets."""
    text = cell.strip().strip('"').lstrip("#%").lower()
    unit = re.search(r"[(\[]([^)\]]*)[)\]]", text)
    name = re.split(r"[/.]", re.sub(r"[(\[].*", "", text).strip())[-1]
    return re.sub(r"[\s_-]+", "_", name).strip("_"), unit.group(1).strip() if unit else ""


def columns_of(header: Sequence[str], file: Path) -> FixColumns:
    """What the columns of a header are.

    Raises
    ------
    TrajectoryError
        If latitude or longitude are there more than once, or nothing is a stamp.
    """
    stamps: tuple[Named | tuple[Named, Named], ...] = (*_pairs(header), *_all(header, STAMP))
    if not stamps:
        raise TrajectoryError(
            f"{file}: no column is named as a stamp (t, time, timestamp, stamp, ...); the header "
            f"has {', '.join(header)}"
        )
    altitudes = _all(header, ALTITUDE)
    return FixColumns(
        _one(header, LATITUDE, file),
        _one(header, LONGITUDE, file),
        altitudes[0] if altitudes else None,
        stamps,
        _all(header, STATE),
    )


def _all(header: Sequence[str], kind: re.Pattern[str]) -> tuple[Named, ...]:
    found = []
    for column in header:
        name, in_brackets = plain(column)
        match = kind.fullmatch(name)
        if match:
            said = match.groupdict()
            unit = said.get("unit") or next((key for key in said if said[key]), "")
            found.append(Named(column, in_brackets or unit))
    return tuple(found)


def _one(header: Sequence[str], kind: re.Pattern[str], file: Path) -> Named:
    found = _all(header, kind)
    if len(found) > 1:
        names = ", ".join(repr(each.column) for each in found)
        raise TrajectoryError(
            f"{file}: row 1: {len(found)} columns may be the same angle: {names}. Keep those of "
            "one receiver"
        )
    return found[0]


def _pairs(header: Sequence[str]) -> tuple[tuple[Named, Named], ...]:
    rests = {match["of"]: name for name in header if (match := REST.fullmatch(name.lower()))}
    wholes = {match["of"]: name for name in header if (match := WHOLE.fullmatch(name.lower()))}
    return tuple(
        (Named(wholes[of], "s"), Named(rest, "ns")) for of, rest in rests.items() if of in wholes
    )
