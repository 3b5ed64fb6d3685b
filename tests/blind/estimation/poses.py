"""Faults of the measured poses; where the robot was stays what it was."""

import numpy as np

from tests.blind.estimation.case import DriveFault, acts, during, posed, span
from tests.blind.faults.fault import UnsuitableError


def outage(length_s):
    def draw(recording, rng):
        begin, end = span(recording, rng, length_s, least_m=3.0)
        pose = recording["pose"]
        faulty = recording.with_rows("pose", ~during(pose, begin, end))
        return _acts(recording, faulty, begin, end, reckons=True)

    return draw


def stop_for_good(recording, rng):
    pose = recording["pose"]
    begin = pose["t"][0] + np.ptp(pose["t"]) * rng.uniform(0.4, 0.7)
    faulty = recording.with_rows("pose", pose["t"] < begin)
    return _acts(recording, faulty, begin, pose["t"][-1], reckons=True)


def jump(recording, rng):
    begin, _ = span(recording, rng, 10.0)
    pose, way = recording["pose"], rng.uniform(-np.pi, np.pi)
    after = pose["t"] >= begin
    faulty = posed(
        recording,
        x=pose["x"] + 2.0 * np.cos(way) * after,
        y=pose["y"] + 2.0 * np.sin(way) * after,
    )
    return _acts(recording, faulty, begin, pose["t"][-1], size_m=2.0)


def jump_of_yaw(recording, rng):
    begin, _ = span(recording, rng, 10.0)
    pose, step = recording["pose"], rng.choice([-1, 1]) * np.deg2rad(rng.uniform(30, 90))
    faulty = posed(recording, yaw=pose["yaw"] + step * (pose["t"] >= begin))
    return _acts(recording, faulty, begin, pose["t"][-1])


def restart(recording, rng):
    """The localisation begins again at the origin of a frame of its own."""
    begin, _ = span(recording, rng, 10.0)
    pose = recording["pose"]
    after = pose["t"] >= begin
    row = int(np.flatnonzero(after)[0])
    dx, dy = pose["x"] - pose["x"][row], pose["y"] - pose["y"][row]
    cosine, sine = np.cos(pose["yaw"][row]), np.sin(pose["yaw"][row])
    x, y = cosine * dx + sine * dy, cosine * dy - sine * dx
    faulty = posed(
        recording,
        x=np.where(after, x, pose["x"]),
        y=np.where(after, y, pose["y"]),
        yaw=np.where(after, pose["yaw"] - pose["yaw"][row], pose["yaw"]),
    )
    size = float(np.hypot(x - pose["x"], y - pose["y"])[after].max())
    if size < 2.0:
        raise UnsuitableError
    return _acts(recording, faulty, begin, pose["t"][-1], size_m=size)


def freeze(recording, rng):
    begin, end = span(recording, rng, rng.uniform(8, 20), least_m=3.0)
    pose = recording["pose"]
    held = during(pose, begin, end)
    row = np.flatnonzero(held)[0]
    columns = {name: np.where(held, pose[name][row], pose[name]) for name in ("x", "y", "yaw")}
    return _acts(recording, posed(recording, **columns), begin, end, reckons=True)


def repeat_old(recording, rng):
    """A buffer is played again: for 5 s come the poses of 5 s before."""
    begin, end = span(recording, rng, 5.0, least_m=2.0)
    pose = recording["pose"]
    again = during(pose, begin, end)
    old = np.searchsorted(pose["t"], pose["t"][again] - 5.0)
    columns = {name: pose[name].copy() for name in ("x", "y", "yaw")}
    for values in columns.values():
        values[again] = values[old]
    return _acts(recording, posed(recording, **columns), begin, end, reckons=True)


def late(delay_s):
    def draw(recording, rng):  # noqa: ARG001
        faulty = recording.restamped(lambda t: t + delay_s, ["pose"])
        t = recording["pose"]["t"]
        return _acts(recording, faulty, t[0], t[-1])

    return draw


def clock_jump(recording, rng):
    """From a moment on all poses are stamped 0.5 s late."""
    begin, _ = span(recording, rng, 10.0)
    faulty = recording.restamped(lambda t: np.where(t >= begin, t + 0.5, t), ["pose"])
    return _acts(recording, faulty, begin, recording["pose"]["t"][-1], size_m=0.5)


def jitter(recording, rng):
    """Each stamp is off by 0.1 s on its own; the order stays."""
    t = recording["pose"]["t"]
    off = np.maximum.accumulate(t + rng.normal(0, 0.1, len(t)))
    off += np.arange(len(t)) * 1e-6
    return _acts(recording, recording.restamped(lambda _: off, ["pose"]), t[0], t[-1])


def outliers(share):
    def draw(recording, rng):
        pose = recording["pose"]
        rows = _chosen(len(pose["t"]), share, rng)
        size, way = np.exp(rng.uniform(*np.log([1, 30]), len(rows))), rng.uniform(0, 7, len(rows))
        columns = {name: pose[name].copy() for name in ("x", "y", "yaw")}
        columns["x"][rows] += size * np.cos(way)
        columns["y"][rows] += size * np.sin(way)
        columns["yaw"][rows] += rng.uniform(-np.pi, np.pi, len(rows))
        return _acts(recording, posed(recording, **columns), pose["t"][0], pose["t"][-1])

    return draw


def yaw_outliers(recording, rng):
    pose = recording["pose"]
    rows = _chosen(len(pose["t"]), 0.1, rng)
    yaw = pose["yaw"].copy()
    yaw[rows] += rng.choice([-1, 1], len(rows)) * rng.uniform(0.5, np.pi, len(rows))
    return _acts(recording, posed(recording, yaw=yaw), pose["t"][0], pose["t"][-1])


def zeros(recording, rng):
    """A lost fix is written as the pose 0, 0, 0."""
    pose = recording["pose"]
    rows = _chosen(len(pose["t"]), 0.1, rng)
    columns = {name: pose[name].copy() for name in ("x", "y", "yaw")}
    for values in columns.values():
        values[rows] = 0.0
    return _acts(recording, posed(recording, **columns), pose["t"][0], pose["t"][-1])


def growing_noise(recording, rng):
    """White noise of the positions that grows over the run from 0 to 0.5 m."""
    pose = recording["pose"]
    sigma = 0.5 * (pose["t"] - pose["t"][0]) / np.ptp(pose["t"])
    dx, dy = rng.normal(0, 1, (2, len(sigma))) * sigma
    faulty = posed(recording, x=pose["x"] + dx, y=pose["y"] + dy)
    return _acts(recording, faulty, pose["t"][0], pose["t"][-1], size_m=0.5)


def multipath(recording, rng):
    """Positions are 3 m off for 20 s, and come back."""
    begin, end = span(recording, rng, 20.0)
    pose, way = recording["pose"], rng.uniform(-np.pi, np.pi)
    off = 3.0 * np.interp(pose["t"], [begin, begin + 1, end - 1, end], [0, 1, 1, 0])
    faulty = posed(recording, x=pose["x"] + off * np.cos(way), y=pose["y"] + off * np.sin(way))
    return _acts(recording, faulty, begin, end, size_m=3.0)


def wander(recording, rng):
    """Positions walk away by 0.05 m/s for 40 s, then come back at once."""
    begin, end = span(recording, rng, 40.0)
    pose, way = recording["pose"], rng.uniform(-np.pi, np.pi)
    off = 0.05 * np.where(during(pose, begin, end), pose["t"] - begin, 0.0)
    faulty = posed(recording, x=pose["x"] + off * np.cos(way), y=pose["y"] + off * np.sin(way))
    return _acts(recording, faulty, begin, end, size_m=2.0)


def _chosen(count, share, rng):
    """Rows at random; the first second of a recording is never among them."""
    return rng.choice(np.arange(10, count), int(share * count), replace=False)


def _acts(clean, faulty, begin_s, end_s, **more):
    table = clean["truth" if "truth" in clean else "pose"]
    reference = {name: table[name] for name in ("t", "x", "y", "yaw")}
    return acts(faulty, begin_s, end_s, reference=reference, **more)


JUMP = "jump|re-?init|lock|reset"
FAULTS = (
    DriveFault(
        "outage_30", "No poses for 30 s.", "outage|no.?pose|silen", outage(30.0), named=True
    ),
    DriveFault(
        "outage_60", "No poses for 60 s.", "outage|no.?pose|silen", outage(60.0), named=True
    ),
    DriveFault("jump_2m", "Positions jump by 2 m and stay.", JUMP, jump, named=True),
    DriveFault(
        "frozen", "Poses hold for 8 to 20 s.", "frozen|repeat|stuck|stale", freeze, named=True
    ),
    DriveFault("late_0.1", "Poses are 0.1 s late.", "late|delay|lag", late(0.1), named=True),
    DriveFault("late_0.3", "Poses are 0.3 s late.", "late|delay|lag", late(0.3), named=True),
    DriveFault(
        "outliers_5",
        "5 % of the poses are 1 to 30 m off.",
        "outlier|refus|reject",
        outliers(0.05),
        named=True,
        flag=False,
    ),
    DriveFault(
        "outliers_20",
        "20 % of the poses are 1 to 30 m off.",
        "outlier|refus|reject",
        outliers(0.2),
        named=True,
        flag=False,
    ),
    DriveFault(
        "outliers_50",
        "50 % of the poses are 1 to 30 m off.",
        "outlier|refus|reject",
        outliers(0.5),
        named=True,
        flag=False,
    ),
    DriveFault("poses_stop", "Poses stop for good.", "outage|no.?pose|silen|end", stop_for_good),
    DriveFault("yaw_jump", "Yaw jumps by 30 to 90 degrees and stays.", JUMP, jump_of_yaw),
    DriveFault("restart", "The localisation starts again at its origin.", JUMP, restart),
    DriveFault(
        "repeat_old",
        "Poses of 5 s before come again.",
        f"frozen|repeat|stale|late|{JUMP}",
        repeat_old,
    ),
    DriveFault(
        "clock_jump",
        "Poses are 0.5 s late from a moment on.",
        f"late|delay|clock|{JUMP}",
        clock_jump,
    ),
    DriveFault(
        "jitter", "Stamps of poses are off by 0.1 s.", "late|jitter|noise", jitter, flag=False
    ),
    DriveFault(
        "yaw_outliers",
        "10 % of the yaws are far off.",
        "outlier|refus|reject",
        yaw_outliers,
        flag=False,
    ),
    DriveFault(
        "zeros",
        "10 % of the poses are 0, 0, 0.",
        "outlier|refus|reject|frozen|repeat",
        zeros,
        flag=False,
    ),
    DriveFault(
        "growing_noise",
        "Noise of positions grows to 0.5 m.",
        "noise|outlier",
        growing_noise,
        flag=False,
    ),
    DriveFault("multipath", "Positions are 3 m off for 20 s.", f"outlier|{JUMP}", multipath),
    DriveFault("wander", "Positions walk away by 2 m in 40 s, and come back.", JUMP, wander),
)
