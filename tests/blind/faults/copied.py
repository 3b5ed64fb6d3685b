"""Columns that a program computed from other columns, and what programs do to them on the way."""

import numpy as np

from tests.blind.faults.fault import Fault, UnsuitableError, integral
from tests.blind.faults.references import posed

GYRO = frozenset({"gyro"})
GOOD = frozenset({"good pose", "gyro"})
LEAST_TURN_RAD = 3.0


def as_it_is(rng, t, values):  # noqa: ARG001
    return values


def some_rows_later(rng, t, values):  # noqa: ARG001
    rows = int(rng.integers(-2, 3))
    return values[np.clip(np.arange(len(values)) - rows, 0, len(values) - 1)]


def delayed(rng, t, values):
    return np.interp(t - rng.uniform(0.02, 0.25), t, values)


def rounded(rng, t, values):  # noqa: ARG001
    return np.round(values, int(rng.integers(3, 5)))


def smoothed(rng, t, values):
    """A low pass of first order, by the time between rows."""
    time_constant, slow = rng.uniform(0.05, 0.3), np.array(values, dtype=float)
    for row in range(1, len(slow)):
        kept = np.exp(-(t[row] - t[row - 1]) / time_constant)
        slow[row] = kept * slow[row - 1] + (1 - kept) * values[row]
    return slow


def averaged(rng, t, values):  # noqa: ARG001
    """The mean of the last rows."""
    count = int(rng.integers(3, 7))
    return np.convolve(np.r_[[values[0]] * (count - 1), values], np.ones(count) / count, "valid")


def scaled(rng, t, values):  # noqa: ARG001
    return values * rng.uniform(0.6, 1.7)


def negated(rng, t, values):  # noqa: ARG001
    return -values


def republished(rng, t, values):
    """By a node of a rate of its own: each row holds the last message."""
    messages = np.arange(t[0], t[-1], rng.uniform(0.06, 0.15))
    return np.interp(messages, t, values)[np.searchsorted(messages, t, side="right") - 1]


TREATMENTS = (
    *(as_it_is, some_rows_later, delayed, rounded, smoothed),
    *(averaged, scaled, negated, republished),
)


def one_of(rng):
    return TREATMENTS[rng.integers(len(TREATMENTS))]


def gyro_by_treads(recording, rng, treatment=None):
    """The twist of an odometry topic saved as a gyroscope, by the track width or a tuned one."""
    table = recording["odometry"]
    turns_enough(table)
    width = recording.robot["track_width"] * rng.choice([1.0, rng.uniform(1.1, 2.2)])
    rate = (table["v_right"] - table["v_left"]) / width
    rate = (treatment or one_of(rng))(rng, table["t"], rate)
    return recording.with_columns("odometry", gyro_z=rate)


def treads_by_gyro(recording, rng, treatment=None):
    """Wheel speeds made of a twist, whose turn is the gyroscope's."""
    table = recording["odometry"]
    turns_enough(table)
    width = recording.robot["track_width"] * rng.choice([1.0, rng.uniform(1.1, 2.2)])
    treatment, seed = treatment or one_of(rng), rng.integers(1 << 32)
    speed = (table["v_left"] + table["v_right"]) / 2
    sides = (speed + side * np.nan_to_num(table["gyro_z"]) * width / 2 for side in (-1, 1))
    left, right = (treatment(np.random.default_rng(seed), table["t"], v) for v in sides)
    return recording.with_columns("odometry", v_left=left, v_right=right)


def gyro_by_yaw(recording, rng, treatment=None):
    """The time derivative of the poses' yaw in place of a gyroscope."""
    table, pose = recording["odometry"], recording["pose"]
    turns_enough(table)
    known = np.isfinite(pose["yaw"])
    t, yaw = pose["t"][known], np.unwrap(pose["yaw"][known])
    rate = (np.gradient(yaw, t), np.append(np.diff(yaw) / np.diff(t), 0.0))[rng.integers(2)]
    rate = (treatment or one_of(rng))(rng, t, rate)
    return recording.with_columns("odometry", gyro_z=np.interp(table["t"], t, rate))


def yaw_by_gyro(recording, rng, treatment=None):
    """A heading that integrates the gyroscope, beside measured positions."""
    table, pose = recording["odometry"], recording["pose"]
    turns_enough(table)
    rate = (treatment or one_of(rng))(rng, table["t"], np.nan_to_num(table["gyro_z"]))
    yaw = np.interp(pose["t"], table["t"], integral(table["t"], rate))
    return posed(recording, yaw=yaw - yaw[0] + pose["yaw"][np.isfinite(pose["yaw"])][0])


def yaw_by_treads(recording, rng):
    """A heading by wheel odometry of a tuned width, beside measured positions."""
    table, pose = recording["odometry"], recording["pose"]
    turns_enough(table)
    width = recording.robot["track_width"] * rng.uniform(1.0, 2.2)
    rate = (table["v_right"] - table["v_left"]) / width
    yaw = np.interp(pose["t"], table["t"], integral(table["t"], rate))
    return posed(recording, yaw=yaw - yaw[0] + pose["yaw"][np.isfinite(pose["yaw"])][0])


def one_side_twice(recording, rng):
    """One encoder read for both sides: some rows later, or of another radius."""
    table = recording["odometry"]
    turns_enough(table)
    sides = ("v_left", "v_right")[:: rng.choice([-1, 1])]
    treatment = (some_rows_later, delayed, rounded, scaled)[rng.integers(4)]
    copy = treatment(rng, table["t"], table[sides[0]])
    return recording.with_columns("odometry", **{sides[1]: copy})


def turns_enough(table):
    """A drive that turns: on a straight one no column shows what it is a copy of."""
    turned = integral(table["t"], np.abs(np.nan_to_num(table["gyro_z"])))[-1]
    if turned < LEAST_TURN_RAD:
        raise UnsuitableError


# fmt: off
FAULTS = (
    Fault("gyro_is_twist_of_treads", "warning", "gyro_z was computed from the treads.",
          ("gyro comput tread", "gyro comput wheel"), gyro_by_treads, GYRO),
    Fault("treads_are_twist_of_gyro", "warning", "Treads were computed from the gyroscope's turn.",
          ("v_left comput gyro",), treads_by_gyro, GYRO),
    Fault("gyro_is_yaw_rate_of_poses", "warning", "gyro_z is the derivative of the poses' yaw.",
          ("gyro deriv", "gyro comput yaw"), gyro_by_yaw, GOOD),
    Fault("pose_yaw_is_gyro", "note", "Yaw integrates the gyroscope.",
          ("yaw integr", "heading integr"), yaw_by_gyro, GOOD),
    Fault("pose_yaw_is_of_treads", "warning", "Yaw was integrated from the treads.",
          ("yaw comput tread", "yaw integr tread", "comput these treads"), yaw_by_treads, GOOD),
    Fault("tread_read_twice", "warning", "One encoder is read for both sides.",
          ("one tread", "one encoder", "one speed", "same encoder"), one_side_twice, GYRO),
)
# fmt: on
