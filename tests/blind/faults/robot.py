"""Faults of run.toml: the robot's width, its sensors, terrain names."""

import re

import numpy as np

from tests.blind.faults.fault import Fault, about, integral

GOOD = frozenset({"good pose", "gyro"})
TRACK = ("track_width", "track width", "width")


def with_width(recording, width_m):
    settings, count = re.subn(
        r"(?m)^track_width *=.*$", f"track_width = {float(width_m)!r}", recording.settings
    )
    assert count == 1
    return recording.with_settings(settings)


def ten_times(recording, rng):
    return with_width(recording, recording.robot["track_width"] * rng.choice([0.1, 10.0]))


def in_mm(recording, rng):  # noqa: ARG001
    return with_width(recording, recording.robot["track_width"] * 1000)


def far(recording, rng):
    """So that the turns imply 3.5 to 7, or 0.2 to 0.6, of it: skid steering widens by 1 to 2.6."""
    table = recording["odometry"]
    grid = np.arange(table["t"][0], table["t"][-1], 1.0)
    difference, turned = (
        np.diff(np.interp(grid, table["t"], integral(table["t"], values)))
        for values in (table["v_right"] - table["v_left"], table["gyro_z"])
    )
    implied_m = difference @ difference / (difference @ turned)
    ratio = rng.uniform(3.5, 7.0) if rng.random() < 0.5 else rng.uniform(0.2, 0.6)
    return with_width(recording, round(implied_m / ratio, 4))


def negative(recording, rng):
    return with_width(recording, rng.choice([0.0, -1.0]) * recording.robot["track_width"])


def sensors(recording, line):
    return recording.with_settings(f"{recording.settings}\n[sensors]\n{line}\n")


def imu_mount_in_degrees(recording, rng):
    angles = np.zeros(3)
    angles[rng.integers(3)] = rng.choice([-90.0, 90.0, 180.0])
    return sensors(recording, f"imu = {angles.tolist()}")


def pose_mount_in_mm(recording, rng):
    place = np.rint(rng.uniform([100, -300, 300], [600, 300, 900]))
    return sensors(recording, f"pose = {place.tolist()}")


def misspell(recording, rng):
    """A terrain column of two names, one of them written in another way on a stretch."""
    count = len(recording["odometry"]["t"])
    names = np.array(["gravel", "grass"], object)[(np.arange(count) > count // 2).astype(int)]
    start = rng.integers(0, count * 3 // 4)
    rows = slice(start, start + max(5, int(count * rng.uniform(0.02, 0.2))))
    change = [str.upper, str.capitalize, lambda name: name + " ", lambda name: name[:-2] + name[-1]]
    names[rows] = [change[rng.integers(4)](name) for name in names[rows][:1]] * len(names[rows])
    return recording.with_columns("odometry", terrain=names)


# fmt: off
FAULTS = (
    Fault("track_width_ten_times", "warning", "track_width is ten times too large or too small.",
          about(TRACK, ["ten", "10", "decimal", "point", "cm", "unit", "times"]), ten_times, GOOD,
          named=True),
    Fault("track_width_in_mm", "warning", "track_width is in millimetres.", ("mm", "millimet"),
          in_mm, named=True),
    Fault("track_width_far", "warning", "track_width is not of this robot.", TRACK, far, GOOD,
          named=True),
    Fault("track_width_not_positive", "refused", "track_width is zero or negative.", TRACK,
          negative),
    Fault("imu_mount_in_degrees", "warning", "[sensors] imu is in degrees.", ("degree", "deg"),
          imu_mount_in_degrees, frozenset({"imu"})),
    Fault("pose_mount_in_mm", "warning", "[sensors] pose is in millimetres.", ("mm", "millimet"),
          pose_mount_in_mm, frozenset({"good pose"})),
    Fault("terrain_misspelt", "note", "A terrain has two spellings.",
          ("spell", "spelt", "spelled", "misspel", "similar", "same terrain", "name", "capital",
           "blank", "space", "typo"), misspell),
)
# fmt: on
