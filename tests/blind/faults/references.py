"""Faults of poses at moments of the run, late poses, and poses that are no reference."""

import math

import numpy as np

from tests.blind.faults.fault import Fault, UnsuitableError, held, pick_stretch

GOOD = frozenset({"good pose", "gyro"})
JUMP = ("jump", "reset", "relocal", "loop closure", "step", "restart", "teleport", "re-initial")


def posed(recording, **columns):
    return recording.with_columns("pose", **columns)


def late(recording, rng):
    delay = rng.uniform(0.1, 0.6)
    return recording.restamped(lambda t: t + delay, ["pose"])


def early(recording, rng):
    ahead = rng.uniform(0.2, 0.6)
    kept = recording.with_rows("pose", recording["pose"]["t"] > ahead)
    return kept.restamped(lambda t: t - ahead, ["pose"])


def _wheel_travel(recording, mask):
    """Wheel travel [m] while the poses of a mask are measured."""
    t, table = recording["pose"]["t"][mask], recording["odometry"]
    rows = (table["t"] >= t[0]) & (table["t"] <= t[-1])
    steps = np.diff(table["t"], append=table["t"][-1])
    return (np.abs(table["v_left"]) + np.abs(table["v_right"]))[rows] @ steps[rows] / 2


def freeze(recording, rng):
    """All columns hold for 10 to 50 % of the run while the wheels drive at least 3 m."""
    pose = recording["pose"]
    mask = pick_stretch(
        rng, pose["t"], (0.1, 0.5), (0.1, 0.7), lambda mask: _wheel_travel(recording, mask) > 3
    )
    first = np.flatnonzero(mask)[0]
    names = [name for name in pose if name not in ("t", "window")]
    return posed(
        recording, **{name: np.where(mask, pose[name][first], pose[name]) for name in names}
    )


def jump(recording, rng):
    """Positions jump by 0.5 to 20 m at a moment, and stay there."""
    pose = recording["pose"]
    t, size = pose["t"], math.exp(rng.uniform(*np.log([0.5, 20.0])))
    after = t > np.quantile(t, rng.uniform(0.1, 0.9))
    way = rng.uniform(-math.pi, math.pi)
    return posed(
        recording,
        x=pose["x"] + after * size * math.cos(way),
        y=pose["y"] + after * size * math.sin(way),
    )


def restart(recording, rng):
    """The reference starts again at the origin, heading 0, in the midst of the run."""
    pose = recording["pose"]
    row = int(len(pose["t"]) * rng.uniform(0.2, 0.8))
    x, y, yaw = (pose[name][row] for name in ("x", "y", "yaw"))
    if math.hypot(x, y) < 1 or not math.isfinite(yaw):
        raise UnsuitableError
    after = np.arange(len(pose["t"])) >= row
    dx, dy, cos, sin = pose["x"] - x, pose["y"] - y, math.cos(yaw), math.sin(yaw)
    return posed(
        recording,
        x=np.where(after, cos * dx + sin * dy, pose["x"]),
        y=np.where(after, cos * dy - sin * dx, pose["y"]),
        yaw=np.where(after, pose["yaw"] - yaw, pose["yaw"]),
    )


def add_outliers(recording, rng):
    """1 to 5 % of the positions are off by 1 to 30 m, each by itself."""
    pose = recording["pose"]
    count = len(pose["t"])
    rows = rng.choice(count, max(2, int(count * rng.uniform(0.01, 0.05))), replace=False)
    x, y = pose["x"].copy(), pose["y"].copy()
    size, way = np.exp(rng.uniform(*np.log([1, 30]), len(rows))), rng.uniform(0, 6.28, len(rows))
    x[rows] += size * np.cos(way)
    y[rows] += size * np.sin(way)
    return posed(recording, x=x, y=y)


def jump_yaw(recording, rng):
    """Yaw steps by 20 to 160 degrees at a moment, and stays."""
    pose = recording["pose"]
    after = pose["t"] > np.quantile(pose["t"], rng.uniform(0.15, 0.85))
    step = rng.choice([-1, 1]) * np.deg2rad(rng.uniform(20, 160))
    return posed(recording, yaw=pose["yaw"] + after * step)


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
    """Poses of another drive: these, from another moment on and backwards in time."""
    pose = recording["pose"]
    roll = int(len(pose["t"]) * rng.uniform(0.3, 0.7))
    names = [name for name in pose if name not in ("t", "window")]
    t = pose["t"]
    other = {name: np.interp(t[0] + t[-1] - t, t, pose[name]) for name in names}
    after = np.arange(len(t)) >= roll
    return posed(
        recording,
        **{n: np.where(after, c - c[roll] + c[0], c + c[-1] - c[0]) for n, c in other.items()},
    )


def stick_in_place(recording, rng):
    """The wheels spin for 5 to 20 s and the robot stands: gyroscope and poses say so."""
    pose, table = recording["pose"], recording["odometry"]
    length_s = rng.uniform(5, 20)

    def drives(mask):
        return _wheel_travel(recording, mask) > 3

    whole = pose["t"][-1] - pose["t"][0]
    mask = pick_stretch(rng, pose["t"], (length_s / whole, length_s / whole), (0.1, 0.8), drives)
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
    quiet = rng.normal(0, 0.005, len(table["t"]))
    return result.with_columns("odometry", gyro_z=np.where(stands, quiet, table["gyro_z"]))


# fmt: off
FAULTS = (
    Fault("pose_late", "warning", "Poses are stamped 0.1 to 0.6 s late.",
          ("late", "delay", "latency", "lag", "behind", "offset", "ahead"), late, GOOD,
          named=True),
    Fault("pose_early", "warning", "Poses are stamped early, or all else is late.",
          ("early", "late", "delay", "latency", "ahead", "offset", "lag", "behind"), early, GOOD),
    Fault("pose_frozen", "warning", "Poses hold while the robot drives.",
          ("frozen", "froze", "stuck", "hold", "held", "stop", "no longer", "lost", "repeat"),
          freeze, GOOD, named=True),
    Fault("pose_jumps_and_stays", "warning", "Positions jump at a moment, and stay.", JUMP, jump,
          GOOD, named=True),
    Fault("pose_restarts", "warning", "The reference starts again at its origin.", JUMP, restart,
          GOOD, ("pose_jumps_and_stays",)),
    Fault("pose_outliers", "warning", "Single positions are far off.",
          ("outlier", "spike", "single", "multipath", "wrong match", "glitch", "jump"),
          add_outliers, GOOD, named=True),
    Fault("pose_yaw_jumps", "warning", "Yaw steps at a moment, and stays.",
          (*JUMP, "yaw step", "heading step"), jump_yaw, GOOD),
    Fault("pose_updates_repeated", "note", "Each pose is published several times.",
          ("repeat", "hold", "held", "update", "same pose", "publish", "frozen", "stair"),
          repeat_updates, GOOD),
    Fault("pose_noisy", "warning", "Positions have a noise of 0.5 to 2 m.",
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
)
# fmt: on
