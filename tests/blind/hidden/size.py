"""How large an effect shows: errors of the base model over 2 s, without noise, by the floor."""

import numpy as np

from tests.blind.formula import icr_twist
from tests.blind.hidden.motion import base_values
from tests.blind.hidden.recorded import seen
from tests.blind.hidden.scene import STEP_S

WINDOW_S = 2.0


def size_of_floor(motion, scene):
    """The larger of the errors of position and of the gyroscope's turn, as factors of the noise."""
    return max(_by_position(motion, scene), _by_gyroscope(motion, scene))


def _by_position(motion, scene):
    stamps_s, poses = seen(motion, scene)
    within = (stamps_s >= 0) & (stamps_s <= motion.drive.clock.duration_s)
    measured = _moves(stamps_s[within], poses[within])
    reckoned = _moves(stamps_s[within], _base_poses(motion, scene, stamps_s[within]))
    return _rms(measured - reckoned) / floor_m(scene, _rms(measured))


def size_between(one, other, scene):
    """RMS distance of the displacements that two motions show, as a factor of the noise."""
    (stamps_s, poses), (others_s, others) = (seen(motion, scene) for motion in (one, other))
    within = (stamps_s >= others_s[0]) & (stamps_s <= others_s[-1])
    times_s = stamps_s[within]
    at = np.column_stack([np.interp(times_s, others_s, column) for column in others.T])
    first, second = _moves(times_s, poses[within]), _moves(times_s, at)
    return _rms(first - second) / floor_m(scene, _rms(first))


def floor_m(scene, distance_m):
    """RMS distance of two displacements that differ by noise alone: two ends, two axes, a yaw."""
    return float(
        np.hypot(2 * scene.sensors.sigma_position_m, scene.sensors.sigma_yaw_rad * distance_m)
    )


def _by_gyroscope(motion, scene):
    """RMS of the turn that the gyroscope reports in excess, by the noise of two yaws."""
    if not scene.sensors.gyroscope:
        return 0.0
    rates = motion.yaw_rates_rad_s
    turned = np.cumsum(motion.hidden.gyroscope(rates) - rates) * STEP_S
    width = round(WINDOW_S / STEP_S)
    return _rms(turned[width:] - turned[:-width]) / (np.sqrt(2) * scene.sensors.sigma_yaw_rad)


def _moves(stamps_s, poses):
    """Displacements over the window, complex in the frame of the window's start."""
    ends = np.searchsorted(stamps_s, stamps_s + WINDOW_S - 1e-9)
    starts = np.flatnonzero(ends < len(stamps_s))
    place = poses[:, 0] + 1j * poses[:, 1]
    return (place[ends[starts]] - place[starts]) * np.exp(-1j * poses[starts, 2])


def _base_poses(motion, scene, times_s):
    """Poses (K, 3) that the calibrated ICRs make of the recorded speeds and the true attitude."""
    values = base_values(scene, motion.drive)
    left, right = motion.reported_m_s.T
    v_x, v_y, omega = icr_twist(
        *(values["alpha_left"] * left, values["alpha_right"] * right),
        *(values[key] for key in ("y_left", "y_right", "x_icr")),
    )
    roll, pitch = motion.poses[:, 2:4].T
    turns = np.cos(roll) / np.cos(pitch) * omega * STEP_S
    yaw = np.concatenate([[0.0], np.cumsum(turns[:-1])])
    along = np.cos(pitch) * v_x + np.sin(pitch) * np.sin(roll) * v_y
    steps = (along + 1j * np.cos(roll) * v_y) * np.exp(1j * (yaw + turns / 2)) * STEP_S
    place = np.concatenate([[0.0], np.cumsum(steps[:-1])])
    columns = (place.real, place.imag, yaw)
    return np.column_stack([np.interp(times_s, motion.drive.clock.times_s, c) for c in columns])


def _rms(errors):
    return float(np.sqrt(np.mean(np.abs(errors) ** 2)))
