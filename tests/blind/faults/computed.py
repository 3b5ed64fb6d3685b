"""Poses computed from treads that they check, magnitudes for speeds, maps and sides too large."""

import math

import numpy as np

from tests.blind.faults.fault import Fault, UnsuitableError, gyro_bias, integral
from tests.blind.faults.references import posed

GOOD = frozenset({"good pose", "gyro"})
CIRCULAR = ("wheel odometry", "dead reckon", "dead-reckon", "own odometry", "not independent",
            "integrat", "from these treads", "from the wheels", "filter")  # fmt: skip


def reckoned(recording, turn_rad, rng):
    """Poses by the mean tread speed along a heading (N,), published at the stamps of the poses.

    As a driver or a filter publishes them: where its base is, with the digits of a log.
    """
    table, pose = recording["odometry"], recording["pose"]
    steps = np.diff(table["t"], append=table["t"][-1])
    way = (table["v_left"] + table["v_right"]) / 2 * steps
    middle = turn_rad + np.diff(turn_rad, append=turn_rad[-1]) / 2
    x, y = (np.r_[0.0, np.cumsum(way * of(middle))[:-1]] for of in (np.cos, np.sin))
    base = rng.uniform(-0.2, 0.2)
    at = {"x": x + base * np.cos(turn_rad), "y": y + base * np.sin(turn_rad), "yaw": turn_rad}
    start = pose["yaw"][0]
    c, s = math.cos(start), math.sin(start)
    moved = {"x": c * at["x"] - s * at["y"], "y": s * at["x"] + c * at["y"],
             "yaw": at["yaw"] + start}  # fmt: skip
    return posed(
        recording,
        **{n: np.round(np.interp(pose["t"], table["t"], v), 4) for n, v in moved.items()},
    )


def of_a_filter(recording, rng):
    """The output of a filter that mixes wheel speeds and gyroscope, without any fix."""
    table = recording["odometry"]
    rate = table["gyro_z"] - gyro_bias(recording)
    return reckoned(recording, integral(table["t"], np.nan_to_num(rate)), rng)


def of_another_width(recording, rng):
    """Wheel odometry of a driver with the width that somebody tuned."""
    table = recording["odometry"]
    width = recording.robot["track_width"] * rng.uniform(1.1, 2.2)
    rate = (table["v_right"] - table["v_left"]) / width
    return reckoned(recording, integral(table["t"], rate), rng)


def magnitudes(recording, rng):  # noqa: ARG001
    """Encoders of one channel count up in both directions."""
    table = recording["odometry"]
    steps = np.diff(table["t"], append=table["t"][-1])
    sides = [table[name] for name in ("v_left", "v_right")]
    back_m = sum(float(np.sum(-v[v < 0] * steps[v < 0])) for v in sides)
    all_m = sum(float(np.sum(np.abs(v) * steps)) for v in sides)
    if back_m < 0.1 * all_m or all_m - back_m < 0.1 * all_m:
        raise UnsuitableError
    return recording.with_columns("odometry", v_left=np.abs(sides[0]), v_right=np.abs(sides[1]))


def large_map(recording, rng):
    """A map (or the wheel radius of a setting) that is off by 20 to 50 %."""
    pose, factor = recording["pose"], rng.uniform(1.2, 1.5)
    return posed(recording, x=pose["x"] * factor, y=pose["y"] * factor)


def unit_of_one_side(recording, rng):
    """One side of another unit or gear: 2 to 5 times as much."""
    side = rng.choice(["v_left", "v_right"])
    factor = rng.uniform(2, 5)
    return recording.with_columns("odometry", **{str(side): recording["odometry"][side] * factor})


# fmt: off
FAULTS = (
    Fault("pose_is_filter_of_wheels", "warning", "Poses come from wheel speeds and gyroscope.",
          CIRCULAR, of_a_filter, GOOD, ("pose_is_wheel_odometry",)),
    Fault("pose_is_odometry_of_a_width", "warning", "Poses are wheel odometry of a tuned width.",
          CIRCULAR, of_another_width, GOOD, ("pose_is_wheel_odometry",)),
    Fault("tread_signs_lost", "warning", "Speeds are magnitudes.",
          ("sign", "magnitude", "direction", "unsigned"), magnitudes, GOOD),
    Fault("pose_map_too_large", "warning", "The map is 20 to 50 % too large.",
          ("scale", "map", "radius", "gear", "factor"), large_map, GOOD),
    Fault("tread_unit_of_one_side", "warning", "One side is 2 to 5 times too large.",
          ("one side", "left", "right", "unequal"), unit_of_one_side, GOOD),
)
# fmt: on
