"""Late poses, and faults of poses at moments of the run."""

import math

import numpy as np

from tests.blind.faults.fault import Fault, UnsuitableError, about, pick_stretch

GOOD = frozenset({"good pose", "gyro"})
POSES = ("pose", "position", "reference", "localis", "slam", "gnss", "gps")
LATE = ("late", "delay", "latenc", "lag", "behind", "clock", "earl", r"time\b", "stamp")
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


def wheel_travel(recording, mask):
    """Wheel travel [m] while the poses of a mask are measured."""
    t, table = recording["pose"]["t"][mask], recording["odometry"]
    rows = (table["t"] >= t[0]) & (table["t"] <= t[-1])
    steps = np.diff(table["t"], append=table["t"][-1])
    return (np.abs(table["v_left"]) + np.abs(table["v_right"]))[rows] @ steps[rows] / 2


def freeze(recording, rng):
    """All columns hold for 10 to 50 % of the run while the wheels drive at least 3 m."""
    pose = recording["pose"]
    mask = pick_stretch(
        rng, pose["t"], (0.1, 0.5), (0.1, 0.7), lambda mask: wheel_travel(recording, mask) > 3
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


# fmt: off
FAULTS = (
    Fault("pose_late", "warning", "Poses are stamped 0.1 to 0.6 s late.", about(POSES, LATE), late,
          GOOD, named=True),
    Fault("pose_early", "warning", "Poses are stamped early, or all else is late.",
          about((*POSES, "tread", "wheel", "odometry", "gyro"), LATE), early, GOOD),
    Fault("pose_frozen", "warning", "Poses hold while the robot drives.",
          about(POSES, ("frozen", "froze", "stuck", "hold", "held", "stop", "no longer", "lost",
          "repeat")), freeze, GOOD, named=True),
    Fault("pose_jumps_and_stays", "warning", "Positions jump at a moment, and stay.", JUMP, jump,
          GOOD, named=True),
    Fault("pose_restarts", "warning", "The reference starts again at its origin.", JUMP, restart,
          GOOD, ("pose_jumps_and_stays",)),
    Fault("pose_outliers", "warning", "Single positions are far off.",
          about(POSES, ("outlier", "spike", "single", "multipath", "wrong", "glitch", "jump")),
          add_outliers, GOOD, named=True),
    Fault("pose_yaw_jumps", "warning", "Yaw steps at a moment, and stays.",
          (*JUMP, "yaw step", "heading step"), jump_yaw, GOOD),
)
# fmt: on
