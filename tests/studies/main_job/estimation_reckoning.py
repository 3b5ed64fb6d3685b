"""Baselines and errors of the estimation studies, as plain loops that share nothing with the code.

Ideal drive and gyroscope with mean wheel speed: a speed holds until the next stamp, the gyroscope
too; each step is a chord along the mean heading.
"""

import math
from bisect import bisect_right
from typing import NamedTuple

import numpy as np

HORIZON_M = 5.0


class Path(NamedTuple):
    """Stamps (N,) and poses x, y, yaw (N, 3)."""

    stamps_s: np.ndarray
    poses: np.ndarray


def reference_path(run):
    """Complete rows of truth.csv, else of pose.csv, within the time of odometry.csv."""
    table = run.truth if run.truth is not None else run.pose
    stamps_s, poses = table.stamps_s, table.stack("x", "y", "yaw")
    first_s, last_s = run.odometry.stamps_s[[0, -1]]
    chosen = np.isfinite(poses).all(axis=1) & (first_s <= stamps_s) & (stamps_s <= last_s)
    return Path(stamps_s[chosen], poses[chosen])


def ideal_drive(run, start_s, start):
    """What an ideal differential drive of the stated track width would do."""
    half = run.robot.track_width / 2
    return icr_drive(run, {"y_left": half, "y_right": -half, "x_icr": 0.0}, start_s, start)


def icr_drive(run, values, start_s, start):
    """The treads alone, with ICRs and slip factors that do not change."""
    left = values.get("alpha_left", 1.0) * run.odometry["v_left"]
    right = values.get("alpha_right", 1.0) * run.odometry["v_right"]
    y_left, y_right = values["y_left"], values["y_right"]
    ahead = (right * y_left - left * y_right) / (y_left - y_right)
    turning = (right - left) / (y_left - y_right)
    return _reckoned(run, (ahead, -values["x_icr"] * turning, turning), start_s, start)


def gyroscope_drive(run, start_s, start):
    """Mean wheel speed along the heading of the gyroscope as recorded; None without one."""
    if "gyro_z" not in run.odometry or not np.isfinite(run.odometry["gyro_z"]).all():
        return None
    ahead = (run.odometry["v_left"] + run.odometry["v_right"]) / 2
    return _reckoned(run, (ahead, 0.0 * ahead, run.odometry["gyro_z"]), start_s, start)


def _reckoned(run, twists, start_s, start):
    """From speeds ahead, to the left and of yaw at each row of odometry.csv."""
    stamps_s, (ahead, aside, turning) = run.odometry.stamps_s, twists
    x, y, yaw = start
    stamps, poses = [start_s], [(x, y, yaw)]
    first = bisect_right(stamps_s, start_s)
    for row in range(first - 1, len(stamps_s) - 1):
        step_s = stamps_s[row + 1] - stamps[-1]
        middle = yaw + turning[row] * step_s / 2
        cosine, sine = math.cos(middle), math.sin(middle)
        x += (cosine * ahead[row] - sine * aside[row]) * step_s
        y += (sine * ahead[row] + cosine * aside[row]) * step_s
        yaw += turning[row] * step_s
        stamps.append(stamps_s[row + 1])
        poses.append((x, y, yaw))
    return Path(np.array(stamps), np.array(poses))


def wheel_travel_m(run, stamps_s):
    """Integral of (|v_left| + |v_right|) / 2 up to each stamp."""
    table, travelled, sums = run.odometry, 0.0, [0.0]
    for row in range(len(table.stamps_s) - 1):
        speed = (abs(table["v_left"][row]) + abs(table["v_right"][row])) / 2
        travelled += speed * (table.stamps_s[row + 1] - table.stamps_s[row])
        sums.append(travelled)
    return np.interp(stamps_s, table.stamps_s, sums)


def error_per_metre(path, reference, travel_m, horizon_m=HORIZON_M):
    """Mean over a window from every reference pose; travel (N,) is that at the reference's stamps.

    A window ends at the first pose at which its wheel travel is reached. Its error is the
    distance of the two end positions, each in the frame of its own start pose, by the horizon.
    """
    seen = at(path, reference.stamps_s)
    errors, end = [], 0
    for begin in range(len(travel_m)):
        while end < len(travel_m) and travel_m[end] < travel_m[begin] + horizon_m:
            end += 1
        if end == len(travel_m):
            break
        difference = _end_seen(seen, begin, end) - _end_seen(reference.poses, begin, end)
        errors.append(math.hypot(*difference) / horizon_m)
    return float(np.mean(errors)) if errors else math.nan


def _end_seen(poses, begin, end):
    dx, dy = poses[end, :2] - poses[begin, :2]
    cosine, sine = math.cos(poses[begin, 2]), math.sin(poses[begin, 2])
    return np.array([cosine * dx + sine * dy, cosine * dy - sine * dx])


def at(path, stamps_s):
    """Poses (M, 3) at other stamps, linear in between, held beyond the ends."""
    yaw = np.unwrap(path.poses[:, 2])
    columns = [path.poses[:, 0], path.poses[:, 1], yaw]
    return np.stack([np.interp(stamps_s, path.stamps_s, column) for column in columns], axis=-1)


def position_errors_m(path, reference):
    """Distance (M,) from each pose of the reference."""
    difference = at(path, reference.stamps_s) - reference.poses
    return np.hypot(difference[:, 0], difference[:, 1])
