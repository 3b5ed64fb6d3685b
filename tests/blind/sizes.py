"""How large an effect shows: position errors of the base model over 2 s, without noise."""

import numpy as np

from tests.blind.commands import RATE_HZ
from tests.blind.formula import icr_twist
from tests.blind.sensors import POSE_PERIOD_S, pose_measured

WINDOW_S = 2.0
# RMS distance between two positions that differ by their noise alone: two ends, two axes.
NOISE_FLOOR_M = 0.01 * 2


def size_m(motion, icrs, effects):
    """RMS position error over 2 s windows of the base twist on the recorded tread speeds."""
    times_s = np.arange(0.0, (len(motion.commands_m_s) - 1) / RATE_HZ + 1e-9, POSE_PERIOD_S)
    delay_s = effects.get("time_offset", {}).get("delay_s", 0.0)
    within = (times_s - delay_s >= 0) & (times_s - delay_s <= times_s[-1])
    seen = pose_measured(motion, times_s[within] - delay_s, effects)
    reckoned = base_poses(motion, icrs, times_s[within])
    error = moves(seen) - moves(reckoned)
    return float(np.sqrt(np.mean(np.abs(error) ** 2)))


def moves(poses):
    """Displacements (K - w,) over the window, complex in the frame of the window's start."""
    width = round(WINDOW_S / POSE_PERIOD_S)
    place = poses[:, 0] + 1j * poses[:, 1]
    return (place[width:] - place[:-width]) * np.exp(-1j * poses[:-width, 2])


def base_poses(motion, icrs, times_s):
    """Poses (K, 3) that the base ICRs make of the commands and the true attitude."""
    stride = round(1 / (RATE_HZ * motion.step_s))
    roll, pitch = motion.poses[::stride, 2:4].T
    treads = motion.commands_m_s * [icrs.alpha_left, icrs.alpha_right]
    v_x, v_y, omega = icr_twist(*treads.T, icrs.y_left, icrs.y_right, icrs.x_icr)
    along = np.cos(pitch) * v_x + np.sin(pitch) * np.sin(roll) * v_y
    turns = np.cos(roll) / np.cos(pitch) * omega / RATE_HZ
    yaw = np.concatenate([[0.0], np.cumsum(turns[:-1])])
    steps = (along + 1j * np.cos(roll) * v_y) * np.exp(1j * (yaw + turns / 2)) / RATE_HZ
    place = np.concatenate([[0.0], np.cumsum(steps[:-1])])
    stamps_s = np.arange(len(treads)) / RATE_HZ
    return np.column_stack(
        [np.interp(times_s, stamps_s, column) for column in (place.real, place.imag, yaw)]
    )
