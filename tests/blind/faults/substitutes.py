"""Poses that are a poor reference, or none: noise, repeats, another run, wheel odometry."""

import math

import numpy as np

from tests.blind.faults.bases import other_segments
from tests.blind.faults.fault import Fault, gyro_bias, held, integral, pick_stretch
from tests.blind.faults.recordings import read_table
from tests.blind.faults.references import posed, wheel_travel

GOOD = frozenset({"good pose", "gyro"})


def repeat_updates(recording, rng):
    """Each pose is published 5 to 15 times before the next one is measured."""
    pose, times = recording["pose"], rng.integers(5, 16)
    rows = np.arange(len(pose["t"])) // times * times
    return posed(recording, **{name: pose[name][rows] for name in pose if name != "t"})


def smear(recording, rng):
    """Noise of 0.5 to 2 m: GNSS without corrections where centimetres were expected."""
    pose, sigma = recording["pose"], rng.uniform(0.5, 2.0)
    noise = rng.normal(0, sigma, (2, len(pose["t"])))
    return posed(recording, x=pose["x"] + noise[0], y=pose["y"] + noise[1])


def dead_reckoned(recording, rng):  # noqa: ARG001
    """The reference is the robot's own wheel odometry: no reference at all."""
    table, pose, width = recording["odometry"], recording["pose"], recording.robot["track_width"]
    steps = np.diff(table["t"], append=table["t"][-1])
    forward = (table["v_left"] + table["v_right"]) / 2 * steps
    turn = (table["v_right"] - table["v_left"]) / width * steps
    yaw = np.cumsum(turn) - turn
    x = np.cumsum(forward * np.cos(yaw + turn / 2)) - forward * np.cos(yaw + turn / 2)
    y = np.cumsum(forward * np.sin(yaw + turn / 2)) - forward * np.sin(yaw + turn / 2)
    return posed(
        recording,
        **{n: np.interp(pose["t"], table["t"], c) for n, c in {"x": x, "y": y, "yaw": yaw}.items()},
    )


def of_another_run(recording, rng):
    """Poses of another drive: of the same recording's next segments, or these backwards."""
    pose = recording["pose"]
    others = other_segments(recording)
    if others:
        pose = read_table(others[rng.integers(len(others))] / "pose.csv")
        return recording.with_table("pose", pose)
    roll = int(len(pose["t"]) * rng.uniform(0.3, 0.7))
    names = [name for name in pose if name not in ("t", "window")]
    t = pose["t"]
    whole = pose | {"yaw": np.unwrap(pose["yaw"])}
    other = {name: np.interp(t[0] + t[-1] - t, t, whole[name]) for name in names}
    after = np.arange(len(t)) >= roll
    return posed(
        recording,
        **{n: np.where(after, c - c[roll] + c[0], c + c[-1] - c[0]) for n, c in other.items()},
    )


def interpolate(recording, rng):
    """Poses between fixes of 0.5 to 1 Hz are drawn by a straight line."""
    pose = recording["pose"]
    fixes = np.unique(np.r_[0 : len(pose["t"]) : rng.integers(10, 21), len(pose["t"]) - 1])
    names = [name for name in pose if name not in ("t", "window")]
    whole = pose | {"yaw": np.unwrap(pose["yaw"])}
    return posed(
        recording, **{n: np.interp(pose["t"], pose["t"][fixes], whole[n][fixes]) for n in names}
    )


def stick_in_place(recording, rng):
    """The wheels spin for 5 to 20 s and the robot stands: gyroscope and poses say so."""

    def drives(mask):
        return wheel_travel(recording, mask) > 3

    return _stand(recording, rng, rng.uniform(5, 20), drives)


def stick_in_turn(recording, rng):
    """The wheels turn on the spot for 2 to 4 s and the robot stands, as both others say."""
    table, width = recording["odometry"], recording.robot["track_width"]
    ahead = integral(table["t"], (table["v_left"] + table["v_right"]) / 2)
    turned = integral(table["t"], (table["v_right"] - table["v_left"]) / width)

    def pivots(mask):
        ends = recording["pose"]["t"][mask][[0, -1]]
        way, turn = (float(np.diff(np.interp(ends, table["t"], of))[0]) for of in (ahead, turned))
        return abs(turn) > 1.5 and abs(way) < 0.3 * width * abs(turn)

    return _stand(recording, rng, rng.uniform(2, 4), pivots)


def _stand(recording, rng, length_s, suits):
    """The robot stands for so long, and its treads go on."""
    pose, table = recording["pose"], recording["odometry"]
    whole = pose["t"][-1] - pose["t"][0]
    mask = pick_stretch(rng, pose["t"], (length_s / whole, length_s / whole), (0.1, 0.8), suits)
    first, last = np.flatnonzero(mask)[[0, -1]]
    here, there = ({n: pose[n][row] for n in ("x", "y", "yaw")} for row in (first, last))
    turn = here["yaw"] - there["yaw"]
    dx, dy = pose["x"] - there["x"], pose["y"] - there["y"]
    noise = rng.normal(0, 0.003, (3, len(pose["t"])))
    after = np.arange(len(pose["t"])) > last
    moved = {
        "x": here["x"] + math.cos(turn) * dx - math.sin(turn) * dy,
        "y": here["y"] + math.sin(turn) * dx + math.cos(turn) * dy,
        "yaw": pose["yaw"] + turn,
    }
    result = posed(
        recording,
        **{
            name: np.where(mask, here[name] + noise[i], np.where(after, moved[name], pose[name]))
            for i, name in enumerate(moved)
        },
    )
    stands = held(table["t"], pose["t"], mask.astype(float)) > 0
    quiet = rng.normal(gyro_bias(recording), 0.005, len(table["t"]))
    return result.with_columns("odometry", gyro_z=np.where(stands, quiet, table["gyro_z"]))


# fmt: off
FAULTS = (
    Fault("pose_updates_repeated", "note", "Each pose is published several times.",
          ("repeat", "hold", "held", "update", "same pose", "publish", "frozen", "stair"),
          repeat_updates, GOOD),
    Fault("poses_interpolated", "note", "Straight lines join poses of 0.5 to 1 Hz.",
          ("interpol", "straight line", "resampl", "between fixes", "linear"), interpolate, GOOD),
    Fault("pose_noisy", "note", "Positions have a noise of 0.5 to 2 m.",
          ("nois", "scatter", "outlier", "gnss", "gps", "jitter", "uncertain", "correction"),
          smear, GOOD),
    Fault("pose_is_wheel_odometry", "warning", "Poses are the robot's own wheel odometry.",
          ("wheel odometry", "dead reckon", "dead-reckon", "own odometry", "not independent",
           "integrat", "from the wheels", "from the treads"), dead_reckoned, GOOD),
    Fault("pose_of_another_run", "warning", "Poses are of another drive.",
          ("another", "other run", "other record", "different", "do not belong", "mixed",
           "not of the same", "unrelated"), of_another_run, GOOD, ("odometry_of_another_run",)),
    Fault("robot_stuck_while_wheels_spin", "note", "All wheels spin, the robot stands.",
          ("slip", "spin", "stuck", "traction", "stand"), stick_in_place, GOOD),
    Fault("robot_stuck_in_a_turn", "note", "All wheels turn on the spot, the robot stands.",
          ("slip", "spin", "stuck", "traction", "stand", "blocked"), stick_in_turn, GOOD),
)
# fmt: on
