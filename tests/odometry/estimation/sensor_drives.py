"""Drives with a gyroscope, poses or positions, their truth by midpoint steps of its own."""

import math
from dataclasses import dataclass

import numpy as np

from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.recording.frames import Frame

WIDTH = 0.6
ICRS = (0.52, -0.46, -0.08)
ALPHAS = (0.93, 0.9)
STEP_S, FINE = 0.1, 10


@dataclass(frozen=True)
class Drive:
    """Truth at N stamps, and the speeds and yaw rates that led there."""

    stamps_s: np.ndarray
    poses: np.ndarray
    speeds_m_s: np.ndarray
    yaw_rates_rad_s: np.ndarray


def weaving(t):
    """Both treads forward, turning to either side."""
    return 0.7 + 0.3 * math.sin(0.9 * t), 0.7 - 0.3 * math.sin(0.7 * t + 1)


def standing(_):
    """Treads at rest."""
    return 0.0, 0.0


def drive(duration_s=40.0, speeds_of=weaving, start=(0.0, 0.0, 0.0), direction=1.0):
    """Poses that follow from the ICRs and slip factors, without noise."""
    stamps_s = np.arange(0, duration_s + STEP_S / 2, STEP_S)
    speeds = direction * np.array([speeds_of(t) for t in stamps_s])
    x, y, yaw = start
    poses, rates = [start], [math.nan]
    for left, right in (speeds * ALPHAS)[:-1]:
        omega = (right - left) / (ICRS[0] - ICRS[1])
        ahead, aside = left + omega * ICRS[0], -omega * ICRS[2]
        for _ in range(FINE):
            middle = yaw + omega * STEP_S / FINE / 2
            x += (ahead * math.cos(middle) - aside * math.sin(middle)) * STEP_S / FINE
            y += (ahead * math.sin(middle) + aside * math.cos(middle)) * STEP_S / FINE
            yaw += omega * STEP_S / FINE
        poses.append((x, y, yaw))
        rates.append(omega)
    return Drive(stamps_s, np.array(poses), speeds, np.array(rates))


def frames_of(driven, *, poses=None, yaw_rates=None, speeds=None, velocities=None):
    """Frames of a drive; what is None is not measured."""
    speeds = driven.speeds_m_s if speeds is None else speeds
    rates = np.full(len(driven.stamps_s), math.nan) if yaw_rates is None else yaw_rates
    return [
        Frame(
            float(stamp_s),
            speeds[k],
            k,
            None if poses is None else poses[k],
            None,
            yaw_rate_rad_s=float(rates[k]),
            velocity=None if velocities is None else velocities[k],
        )
        for k, stamp_s in enumerate(driven.stamps_s)
    ]


def estimates_of(frames, config=None, **settings):
    ekf = IcrEkf(WIDTH, None, config or IcrEkfConfig(), **settings)
    estimates = [ekf.start(frames[0], "a")]
    for frame in frames[1:]:
        estimates.append(ekf.step(estimates[-1], frame, "a"))
    return estimates


def noisy_poses(driven, rng, position_m=0.02, yaw_rad=0.01):
    noise = rng.normal(size=driven.poses.shape) * [position_m, position_m, yaw_rad]
    poses = driven.poses + noise
    poses[:, 2] = np.angle(np.exp(1j * poses[:, 2]))
    return poses


def distance(estimate, driven):
    """Of the last estimate from the truth [m]."""
    return float(np.hypot(*(estimate.mean[:2] - driven.poses[-1, :2])))


def turned(estimate, driven):
    """Yaw of the last estimate less the truth."""
    return float(np.angle(np.exp(1j * (estimate.mean[2] - driven.poses[-1, 2]))))


def events_of(estimates):
    """All events, in the order of time."""
    return [event for estimate in estimates for event in estimate.events]
