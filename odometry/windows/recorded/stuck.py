"""Stretches in which poses stay where they are while treads drive: the robot is stuck.

Its wheels spin, or the poses are held: such motion says nothing of a model.
"""

from dataclasses import replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.windows.recorded.record import STUCK, Record

NEAR_M, NEAR_RAD = 0.1, 0.1  # within which poses stay
TIMES = 4.0  # as far treads must lead
LEAST_S = 0.8  # that poses stay, once treads have led away: they may be late
WIDTHS = 2.0  # track widths, as which treads turn a robot that skids


def without_stuck(record: Record) -> Record:
    """The record with a break at every pose of a robot that is stuck."""
    stuck = stuck_poses(record)
    broken = (stuck[1:] | stuck[:-1]) & (record.breaks == "")
    return replace(record, breaks=np.where(broken, STUCK, record.breaks))


def stuck_poses(record: Record) -> BoolArray:
    """Which poses (M,) are measured while the robot is stuck.

    From pose to pose: those that stay near one, in position and yaw, are compared with how far
    treads have led ahead and turned since. A yaw that is not measured says nothing.
    """
    found = np.zeros(len(record.poses), dtype=np.bool_)
    led_times, pose_s = _led(record), record.pose_s
    ends = np.append(np.flatnonzero(record.breaks != ""), len(found) - 1) + 1
    begin, poses = 0, record.poses.tolist()
    for end in ends.tolist():
        while begin < end:
            after = _first_away(poses, begin, end)
            if pose_s[after - 1] - pose_s[begin] >= LEAST_S:
                stay = slice(begin, after)
                found[stay] = _is_led_away(led_times[stay], pose_s[stay])
            begin = after
    return found


def _led(record: Record) -> FloatArray:
    """How far treads have led up to each pose (M, 3): x and y, and in turn, in times of near.

    Poses that stay have one heading, and x is ahead; where yaw is not measured it is that of the
    gyroscope or of the treads, as a robot that drives round in a small circle stays near a place.
    """
    steps_s = np.append(np.diff(record.stamps_s), 0.0)
    left, right = record.inputs.tread_speeds_m_s.T * steps_s
    turned_rad = (right - left) / (WIDTHS * record.run.robot.track_width)
    ahead_m = (left + right) / 2
    if np.isnan(record.poses[:, 2]).any():
        heading_rad = _heading_rad(record, turned_rad)
        steps = np.stack([ahead_m * np.cos(heading_rad), ahead_m * np.sin(heading_rad)])
        turned_rad = np.zeros_like(turned_rad)
    else:
        steps = np.stack([ahead_m, np.zeros_like(ahead_m)])
    led = np.cumsum(np.vstack([steps / NEAR_M, turned_rad / NEAR_RAD]).T, axis=0)
    return np.asarray(np.vstack([np.zeros(3), led[:-1]])[record.pose_samples])


def _heading_rad(record: Record, by_treads_rad: FloatArray) -> FloatArray:
    """Heading (N,) from the first sample on: of the gyroscope where there is one."""
    measured = record.run.yaw_rate
    if measured is None:
        return np.append(0.0, np.cumsum(by_treads_rad[:-1]))
    steps_rad = measured.yaw_rate_rad_s[:-1] * np.diff(measured.stamps_s)
    heading_rad = np.append(0.0, np.cumsum(steps_rad))
    return np.asarray(np.interp(record.stamps_s, measured.stamps_s, heading_rad))


def _first_away(poses: list[list[float]], begin: int, end: int) -> int:
    """The first of poses up to `end` that is not near the one at `begin`; else `end`."""
    x, y, yaw = poses[begin]
    for place in range(begin + 1, end):
        of_x, of_y, of_yaw = poses[place]
        if abs(of_yaw - yaw) > NEAR_RAD or np.hypot(of_x - x, of_y - y) > NEAR_M:
            return place
    return end


def _is_led_away(led_times: FloatArray, pose_s: FloatArray) -> bool:
    """Whether treads lead far (K, 3) from the first of poses (K,) that stay, and for long."""
    x, y, turned = (led_times - led_times[0]).T
    led = np.maximum(np.hypot(x, y), np.abs(turned))
    away = np.flatnonzero(led > 1)
    return bool(len(away)) and bool(led.max() >= TIMES and pose_s[-1] - pose_s[away[0]] >= LEAST_S)
