"""Faults that bend a measurement along the run: reflections, magnetism, projections, ticks.

Of most of them no repair is known beforehand: that the sensors differ, and that the cause cannot
be determined, is a right answer as well. Another cause is not.
"""

import math

import numpy as np

from tests.blind.faults.bases import turns_show
from tests.blind.faults.fault import Fault, UnsuitableError, about, pick_stretch
from tests.blind.faults.poses import posed

GOOD = frozenset({"good pose", "gyro"})
UNKNOWN = "cannot be determined"


def multipath(recording, rng):
    """Signals reflected by a building: positions wander 2 to 5 m aside within 10 to 40 s."""
    pose = recording["pose"]
    t, size, way = pose["t"], rng.uniform(2, 5), rng.uniform(-math.pi, math.pi)
    width_s = rng.uniform(10, 40) / 4
    middle = rng.uniform(t[0] + 2 * width_s, t[-1] - 2 * width_s)
    if t[-1] - t[0] < 10 * width_s:
        raise UnsuitableError
    aside = size * np.exp(-0.5 * ((t - middle) / width_s) ** 2)
    return posed(
        recording, x=pose["x"] + aside * math.cos(way), y=pose["y"] + aside * math.sin(way)
    )


def magnetic_yaw(recording, rng):
    """Iron of the robot: the compass is off by 10 to 25 degrees, by the sine of its heading."""
    yaw = recording["pose"]["yaw"]
    if np.ptp(np.unwrap(yaw)) < math.pi:
        raise UnsuitableError
    size, at = np.deg2rad(rng.uniform(10, 25)), rng.uniform(-math.pi, math.pi)
    return posed(recording, yaw=yaw + size * np.sin(yaw - at))


def stretched(recording, rng):
    """Longitude taken for as long as latitude at 35 to 50 degrees north: x is too long."""
    pose = recording["pose"]
    wide = (
        np.ptp(np.quantile(pose["x"], [0.05, 0.95])),
        np.ptp(np.quantile(pose["y"], [0.05, 0.95])),
    )
    if min(wide) < 0.2 * max(wide):
        raise UnsuitableError
    factor = 1 / math.cos(np.deg2rad(rng.uniform(35, 50)))
    return posed(recording, x=pose["x"] * factor)


def miss_ticks(recording, rng):
    """Above half its speed one encoder, or both, miss 3 to 20 % of their ticks."""
    table, missed = recording["odometry"], rng.uniform(0.03, 0.2)
    limit = 0.5 * np.quantile(np.abs([table["v_left"], table["v_right"]]), 0.99)
    sides = [("v_left",), ("v_right",), ("v_left", "v_right")][rng.integers(3)]
    return recording.with_columns(
        "odometry",
        **{n: np.where(np.abs(table[n]) > limit, (1 - missed) * table[n], table[n]) for n in sides},
    )


def far_ahead(recording, rng):
    """Poses are stamped 1 to 3 s before they were measured."""
    ahead = rng.uniform(1, 3)
    kept = recording.with_rows("pose", recording["pose"]["t"] > ahead)
    return kept.restamped(lambda t: t - ahead, ["pose"])


def commands(recording, rng):
    """What was commanded stands for what the wheels did: these follow with a time constant.

    The command is what a lag of first order (0.2 to 0.6 s) would make the measured speed of, sent
    at 10 Hz in steps of 0.01 m/s.
    """
    table, constant = recording["odometry"], rng.uniform(0.2, 0.6)
    t = table["t"]
    grid = np.arange(t[0], t[-1], 0.1)
    sent = {}
    for name in ("v_left", "v_right"):
        speed = np.interp(grid, t, table[name])
        speed = np.convolve(np.pad(speed, 2, "edge"), np.ones(5) / 5, "valid")
        command = np.rint((speed + constant * np.gradient(speed, 0.1)) / 0.01) * 0.01
        sent[name] = command[np.clip(((t - t[0]) / 0.1).astype(int), 0, len(grid) - 1)]
    return recording.with_columns("odometry", **sent)


def duty_cycle(recording, rng):
    """The columns hold what drives the motors: a power of 1.5 to 2.2 of the speed, same limit."""
    table, power = recording["odometry"], rng.uniform(1.5, 2.2)
    most = np.quantile(np.abs([table["v_left"], table["v_right"]]), 0.99)
    return recording.with_columns(
        "odometry",
        **{
            n: np.sign(table[n]) * most * (np.abs(table[n]) / most) ** power
            for n in ("v_left", "v_right")
        },
    )


def mean_for_one(recording, rng):
    """One column holds the mean of both treads."""
    table = recording["odometry"]
    if not turns_show(recording):
        raise UnsuitableError
    mean = (table["v_left"] + table["v_right"]) / 2
    return recording.with_columns("odometry", **{rng.choice(["v_left", "v_right"]): mean})


def lose_poses(recording, rng):
    """No poses for 15 to 40 s while the robot drives, nor a word of it."""
    t, table = recording["pose"]["t"], recording["odometry"]
    length_s, whole_s = rng.uniform(15, 40), t[-1] - t[0]
    if length_s > 0.6 * whole_s:
        raise UnsuitableError

    def drives(mask):
        inside = (table["t"] >= t[mask][0]) & (table["t"] <= t[mask][-1])
        return np.mean(np.abs(table["v_left"][inside]) > 0.1) > 0.5

    share = length_s / whole_s
    lost = pick_stretch(rng, t, (share, share), (0.1, 0.9 - share), drives)
    return recording.with_rows("pose", ~lost)


def other_gyro_name(recording, rng):
    """The gyroscope's column has another program's name: nobody reads it."""
    table = recording["odometry"]
    name = ["wz", "gyroz", "gyro", "yaw_rate", "angular_velocity_z"][rng.integers(5)]
    return recording.with_table(
        "odometry", {name if n == "gyro_z" else n: c for n, c in table.items()}
    )


POSES = ("pose", "position", "reference", "gnss", "gps")
# fmt: off
FAULTS = (
    Fault("pose_multipath", "warning", "Positions wander aside, by a reflected signal.",
          (UNKNOWN, *about(POSES, ("multipath", "wander", "reflect", "drift"))), multipath, GOOD),
    Fault("pose_yaw_magnetic", "warning", "The compass is bent by iron.",
          ("magnet", "compass", "iron", "deviat", UNKNOWN), magnetic_yaw, GOOD),
    Fault("pose_stretched", "warning", "x is longer than it was driven, y is not.",
          ("stretch", "longitude", "latitude", "cosine", "one axis", UNKNOWN), stretched, GOOD),
    Fault("treads_miss_ticks", "warning", "Encoders miss ticks at speed.",
          ("tick", "encoder", "nonlinear", "not proportional", UNKNOWN), miss_ticks, GOOD),
    Fault("pose_far_ahead", "warning", "Poses are stamped 1 to 3 s early.",
          (*about((*POSES, "tread", "odometry", "gyro"), ("early", "earl", "late", "stamp",
          "delay")), UNKNOWN), far_ahead, GOOD, ("pose_early",)),
    Fault("treads_are_commands", "warning", "Commands stand for measured speeds.",
          ("command", "setpoint", UNKNOWN), commands, GOOD),
    Fault("treads_are_duty_cycles", "warning", "Speeds are not proportional to the treads'.",
          ("nonlinear", "not proportional", "duty", "throttle", "motor", UNKNOWN), duty_cycle,
          GOOD),
    Fault("tread_is_the_mean", "warning", "One column holds the mean of both.",
          ("mean", "average", UNKNOWN), mean_for_one, GOOD),
    Fault("poses_lost_for_a_while", "note", "No poses for 15 to 40 s.",
          ("lost", "outage", "gap", "no pose", "missing", "interrupt"), lose_poses, GOOD),
    Fault("gyro_of_another_name", "note", "The gyroscope's column has another name.",
          ("name", "column", "renam"), other_gyro_name, GOOD),
)
# fmt: on
