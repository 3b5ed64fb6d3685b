"""Faults of tread speeds all along the run: units, signs, columns."""

import math

import numpy as np

from tests.blind.faults.bases import other_segments
from tests.blind.faults.fault import Fault, UnsuitableError, about
from tests.blind.faults.recordings import read_table

GOOD = frozenset({"good pose", "gyro"})
RADIUS = GOOD | {"radius"}
SIGN = ("sign", "revers", "negat", "backward", "polarity", "invert", "opposite")
SWAP = ("swap", "exchang", "interchang", "mixed up", "left right revers")
UNIT = ("unit", "scale", "factor")
SLOW_UNITS = ("treads_in_rad_s", "treads_in_km_h", "treads_in_feet_s")


def treads(recording, left, right):
    return recording.with_columns("odometry", v_left=left, v_right=right)


def scaled(recording, factor):
    table = recording["odometry"]
    return treads(recording, table["v_left"] * factor, table["v_right"] * factor)


def _times(factor):
    return lambda recording, rng: scaled(recording, factor)  # noqa: ARG005


def in_rad_s(recording, rng):  # noqa: ARG001
    return scaled(recording, 1 / recording.robot["wheel_radius"])


def in_rpm(recording, rng):  # noqa: ARG001
    return scaled(recording, 30 / (math.pi * recording.robot["wheel_radius"]))


def in_motor_rpm(recording, rng):
    gear = rng.uniform(10, 50)
    return scaled(recording, gear * 30 / (math.pi * recording.robot["wheel_radius"]))


def in_ticks(recording, rng):
    """Encoder ticks a second, 100 to 10,000 a turn."""
    ticks = np.rint(10 ** rng.uniform(2, 4)) / (2 * math.pi * recording.robot["wheel_radius"])
    table = recording["odometry"]
    return treads(recording, np.rint(table["v_left"] * ticks), np.rint(table["v_right"] * ticks))


def metres_a_row(recording, rng):  # noqa: ARG001
    table = recording["odometry"]
    steps = np.diff(table["t"], append=2 * table["t"][-1] - table["t"][-2])
    return treads(recording, table["v_left"] * steps, table["v_right"] * steps)


def metres_so_far(recording, rng):
    """Counters: the way of each tread since the start, in metres or in ticks."""
    table = recording["odometry"]
    steps = np.diff(table["t"], append=table["t"][-1])
    factor = rng.choice([1.0, np.rint(10 ** rng.uniform(2, 4))])
    return treads(
        recording,
        np.cumsum(table["v_left"] * steps) * factor,
        np.cumsum(table["v_right"] * steps) * factor,
    )


def swap(recording, rng):  # noqa: ARG001
    table = recording["odometry"]
    return treads(recording, table["v_right"], table["v_left"])


def swap_and_negate(recording, rng):  # noqa: ARG001
    table = recording["odometry"]
    return treads(recording, -table["v_right"], -table["v_left"])


def negate_left(recording, rng):  # noqa: ARG001
    return treads(recording, -recording["odometry"]["v_left"], recording["odometry"]["v_right"])


def negate_right(recording, rng):  # noqa: ARG001
    return treads(recording, recording["odometry"]["v_left"], -recording["odometry"]["v_right"])


def forward_and_turn(recording, rng):  # noqa: ARG001
    """The columns hold forward speed and yaw rate of the drive's own odometry."""
    table, width = recording["odometry"], recording.robot["track_width"]
    forward = (table["v_left"] + table["v_right"]) / 2
    return treads(recording, forward, (table["v_right"] - table["v_left"]) / width)


def scale_one(recording, rng):
    """One side is 20 to 50 % off: another tyre or gear than its driver has set."""
    table = recording["odometry"]
    factor = rng.uniform(1.2, 1.5) ** rng.choice([-1, 1])
    if rng.random() < 0.5:
        return treads(recording, table["v_left"] * factor, table["v_right"])
    return treads(recording, table["v_left"], table["v_right"] * factor)


def shift_one(recording, rng):
    """One side never reads zero: an offset of 0.1 to 0.4 m/s."""
    table = recording["odometry"]
    offset = rng.choice([-1, 1]) * rng.uniform(0.1, 0.4)
    if rng.random() < 0.5:
        return treads(recording, table["v_left"] + offset, table["v_right"])
    return treads(recording, table["v_left"], table["v_right"] + offset)


def never_turn(recording, rng):  # noqa: ARG001
    zero = np.zeros(len(recording["odometry"]["t"]))
    return treads(recording, zero, zero.copy())


def of_another_run(recording, rng):
    """Odometry of another drive: of the same recording's next segments, or this backwards."""
    table = recording["odometry"]
    others = other_segments(recording)
    if others:
        table = read_table(others[rng.integers(len(others))] / "odometry.csv")
        return recording.with_table("odometry", table)
    if len(table["t"]) < 400:
        raise UnsuitableError
    roll = int(len(table["t"]) * rng.uniform(0.3, 0.7))
    return recording.with_table(
        "odometry",
        {name: c if name == "t" else np.roll(c[::-1], roll) for name, c in table.items()},
    )


# fmt: off
FAULTS = (
    Fault("treads_in_rad_s", "warning", "Wheel rates in rad/s.", ("rad", "radius"), in_rad_s,
          RADIUS, SLOW_UNITS, named=True),
    Fault("treads_in_rpm", "warning", "Wheel rates in RPM.", ("rpm", "revolution", "turns"), in_rpm,
          RADIUS, named=True),
    Fault("treads_in_mm_s", "warning", "Tread speeds in mm/s.", ("mm", "millimet"), _times(1000.0),
          GOOD, ("treads_in_motor_rpm", "treads_in_ticks"), named=True),
    Fault("treads_in_cm_s", "warning", "Tread speeds in cm/s.", ("cm", "centimet"), _times(100.0),
          GOOD, ("treads_in_ticks",)),
    Fault("treads_in_km_h", "warning", "Tread speeds in km/h.", ("km",), _times(3.6), GOOD,
          SLOW_UNITS),
    Fault("treads_in_feet_s", "warning", "Tread speeds in feet a second.", ("feet", "ft", "foot"),
          _times(1 / 0.3048), GOOD, SLOW_UNITS),
    Fault("treads_in_mph", "warning", "Tread speeds in miles an hour.", ("mph", "mile"),
          _times(2.23694), GOOD, ("treads_twice",)),
    Fault("treads_twice", "warning", "The wheel's diameter was taken for its radius.",
          ("radius", "diameter", *UNIT), _times(2.0), GOOD, ("treads_in_mph",)),
    Fault("treads_half", "warning", "The wheel's radius was halved.",
          ("radius", "diameter", *UNIT), _times(0.5), GOOD),
    Fault("treads_in_motor_rpm", "warning", "RPM of the motors, before the gearbox.",
          ("gear", "motor", "rpm", "tick"), in_motor_rpm, RADIUS, ("treads_in_mm_s",)),
    Fault("treads_in_ticks", "warning", "Encoder ticks a second.", ("tick", "count", "puls", "rpm"),
          in_ticks, RADIUS, ("treads_in_mm_s", "treads_in_rpm", "treads_in_cm_s")),
    Fault("treads_in_metres_a_row", "warning", "Metres driven since the row before.",
          ("per row", "per sample", "per period", "increment", "distance", "displacement", "step",
           "metres a row", "way"), metres_a_row, GOOD),
    Fault("treads_are_counters", "warning", "Positions or counters of the wheels, not speeds.",
          ("cumul", "position", "counter", "distance", "tick", "count", "sum", "travelled", "way"),
          metres_so_far, GOOD),
    Fault("treads_swapped", "warning", "Left and right are exchanged.", SWAP, swap, GOOD,
          named=True),
    Fault("turn_reversed_without_pose", "warning", "Treads exchanged; no pose to check the gyro.",
          (*SWAP, *SIGN), swap, frozenset({"turns by gyro only"})),
    Fault("treads_both_negative", "warning", "Both treads have the wrong sign.",
          about(("tread", "wheel", "encoder", "both", "motor"), SIGN), _times(-1.0), GOOD,
          named=True),
    Fault("tread_left_negative", "warning", "The left tread has the wrong sign.",
          about(["left"], SIGN), negate_left, GOOD, named=True),
    Fault("tread_right_negative", "warning", "The right tread has the wrong sign.",
          about(["right"], SIGN), negate_right, GOOD, named=True),
    Fault("front_is_rear", "warning", "The drive takes the rear for the front.",
          ("front", "rear", "180", *SIGN), swap_and_negate, GOOD, ("pose_yaw_off_180",)),
    Fault("treads_are_twist", "warning", "The columns hold forward speed and yaw rate.",
          ("twist", "omega", "yaw rate", "angular", "turn rate"), forward_and_turn, GOOD),
    Fault("tread_scale_of_one_side", "warning", "One side's scale is 20 to 50 % off.",
          ("scale", "radius", "radii", "asymmet", "gain", "unequal", "calibrat", "larger",
           "smaller", "factor", "tyre", "one side"), scale_one, GOOD),
    Fault("tread_offset", "warning", "One side has an offset.",
          ("offset", "bias", "zero", "creep"), shift_one, GOOD),
    Fault("treads_always_zero", "warning", "The wheels were never recorded.",
          ("zero", "never", "not connect", "not record", "encoder", "no odometry"), never_turn,
          GOOD, ("treads_zero_while_moving",)),
    Fault("odometry_of_another_run", "warning", "Odometry and poses are of different drives.",
          ("another", "other run", "other record", "different", "do not belong", "mixed",
           "not of the same", "unrelated"), of_another_run, GOOD, ("pose_of_another_run",)),
)
# fmt: on
