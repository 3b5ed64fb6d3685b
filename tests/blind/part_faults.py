"""Faults of a part of a recording: cells left out, another unit, a sign, or rounding in a span.

`FAULTS` holds the faults by key: how one is drawn, and words of the answer that is right. A part is
a span that begins with the run, ends with it, or lies inside, with its moments drawn at random.
"""

from dataclasses import dataclass

import numpy as np

from tests.blind.faults.fault import UnsuitableError, says

SLOW = (0.2, 0.7)  # quantiles of the speed below which a robot is called slow
TREADS = ("v_left", "v_right")
RPM = 60 / (2 * np.pi)


@dataclass(frozen=True)
class PartFault:
    """A fault of a part.

    Attributes
    ----------
    key : str
    change : callable
        Recording, Generator and span (begin, end) [s] to the faulty recording.
    words : tuple of str
        Of a right cause, as in `tests.blind.faults.fault.says`; empty: any warning is wrong.
    """

    key: str
    change: object
    words: tuple[str, ...] = ()


def draw_span(rng, stamps_s, ways=("first", "last", "inside")):
    """A part of 0.25 to 0.6 of the time, at no round share: begin and end [s]."""
    begin_s, end_s = stamps_s[0], stamps_s[-1]
    lasts_s, of_it = end_s - begin_s, rng.uniform(0.25, 0.6)
    way = rng.choice(ways)
    if way == "first":
        return begin_s - 1.0, begin_s + of_it * lasts_s
    if way == "last":
        return end_s - of_it * lasts_s, end_s + 1.0
    of_it = min(of_it, 0.45)
    start_s = begin_s + lasts_s * rng.uniform(0.15, 0.85 - of_it)
    return start_s, start_s + of_it * lasts_s


def inside(recording, name, span_s):
    stamps_s = recording[name]["t"]
    return (stamps_s >= span_s[0]) & (stamps_s < span_s[1])


def _speed(recording, at_s):
    table = recording["odometry"]
    speeds = np.abs(table["v_left"] + table["v_right"]) / 2
    return np.interp(at_s, table["t"], speeds)


def _slow(recording, rng, span_s, name):  # noqa: ARG001
    speeds = _speed(recording, recording[name]["t"])
    return speeds <= np.quantile(speeds, rng.uniform(*SLOW))


def _fast(recording, rng, span_s, name):
    return ~_slow(recording, rng, span_s, name)


def _part(recording, rng, span_s, name):  # noqa: ARG001
    return inside(recording, name, span_s)


def _every_other(recording, rng, span_s, name):  # noqa: ARG001
    return np.arange(len(recording[name]["t"])) % 2 == 1


def _by_chance(share):
    def rows(recording, rng, span_s, name):  # noqa: ARG001
        return rng.random(len(recording[name]["t"])) < share

    return rows


def left_out(name, columns, rows):
    """Cells left empty."""

    def change(recording, rng, span_s):
        table = recording[name]
        if not set(columns) <= set(table):
            raise UnsuitableError
        empty = rows(recording, rng, span_s, name)
        emptied = {column: np.where(empty, np.nan, table[column]) for column in columns}
        return recording.with_columns(name, **emptied)

    return change


def times(name, columns, factor):
    """Columns times a factor in the span."""

    def change(recording, rng, span_s):  # noqa: ARG001
        table = recording[name]
        if not set(columns) <= set(table):
            raise UnsuitableError
        scale = np.where(inside(recording, name, span_s), factor, 1.0)
        return recording.with_columns(name, **{c: table[c] * scale for c in columns})

    return change


def yaw_in_degrees(recording, rng, span_s):
    """Between -180 and 180, or from 0 to 360."""
    yaw = recording["pose"]["yaw"]
    degrees = np.degrees(np.angle(np.exp(1j * yaw)))
    degrees = degrees % 360 if rng.random() < 0.5 else degrees
    part = inside(recording, "pose", span_s)
    return recording.with_columns("pose", yaw=np.where(part, degrees, yaw))


def one_side(factor):
    def change(recording, rng, span_s):
        return times("odometry", (str(rng.choice(TREADS)),), factor)(recording, rng, span_s)

    return change


def exchanged(recording, rng, span_s):  # noqa: ARG001
    left, right = (recording["odometry"][name] for name in TREADS)
    part = inside(recording, "odometry", span_s)
    new = {"v_left": np.where(part, right, left), "v_right": np.where(part, left, right)}
    return recording.with_columns("odometry", **new)


def rounded(recording, rng, span_s):
    """Positions rounded to 0.05 to 1 m in a third of the run."""
    step_m = float(rng.choice([0.05, 0.1, 0.3, 1.0]))
    part = inside(recording, "pose", span_s)
    pose = recording["pose"]
    new = {c: np.where(part, np.round(pose[c] / step_m) * step_m, pose[c]) for c in ("x", "y")}
    return recording.with_columns("pose", **new)


YAW, PLACE, RATE = ("pose", ("yaw",)), ("pose", ("x", "y", "yaw")), ("odometry", ("gyro_z",))
SCALED = ("times the motion of", "unit", "scale")
TURNED = ("sign", "negat", "revers", "direction", "opposite", "backward")
# fmt: off
FAULTS = {fault.key: fault for fault in (
    PartFault("yaw_empty_slow", left_out(*YAW, _slow)),
    PartFault("yaw_empty_fast", left_out(*YAW, _fast)),
    PartFault("yaw_empty_part", left_out(*YAW, _part)),
    PartFault("yaw_empty_every_other", left_out(*YAW, _every_other)),
    PartFault("yaw_empty_70", left_out(*YAW, _by_chance(0.7))),
    PartFault("yaw_empty_40", left_out(*YAW, _by_chance(0.4))),
    PartFault("place_empty_part", left_out(*PLACE, _part)),
    PartFault("place_empty_slow", left_out(*PLACE, _slow)),
    PartFault("place_empty_50", left_out(*PLACE, _by_chance(0.5))),
    PartFault("rate_empty_part", left_out(*RATE, _part)),
    PartFault("rate_empty_slow", left_out(*RATE, _slow)),
    PartFault("rate_empty_50", left_out(*RATE, _by_chance(0.5))),
    PartFault("yaw_degrees", yaw_in_degrees, ("degree",)),
    PartFault("rate_degrees", times(*RATE, np.degrees(1.0)), ("degree",)),
    PartFault("treads_km_h", times("odometry", TREADS, 3.6), ("km/h", "unit", "scale")),
    PartFault("treads_mm_s", times("odometry", TREADS, 1000.0), ("mm/s", "unit", "scale")),
    PartFault("treads_rpm", times("odometry", TREADS, RPM), ("rpm", "unit", "scale")),
    PartFault("yaw_reversed", times(*YAW, -1.0), TURNED),
    PartFault("rate_reversed", times(*RATE, -1.0), TURNED),
    PartFault("side_reversed", one_side(-1.0), TURNED),
    PartFault("side_half", one_side(0.5), SCALED),
    PartFault("side_less", one_side(0.3), SCALED),
    PartFault("side_double", one_side(2.0), SCALED),
    PartFault("treads_reversed", times("odometry", TREADS, -1.0), TURNED),
    PartFault("treads_exchanged", exchanged, ("exchanged", "swapped")),
    PartFault("place_rounded", rounded, ("rounded",)),
)}
# fmt: on


def is_right(fault, seen, cause):
    """Whether a cause is that of the fault."""
    return says(seen, cause, fault.words)
