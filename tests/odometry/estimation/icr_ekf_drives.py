"""Filters of the ICRs, frames and drives to try them on."""

import numpy as np

from odometry.estimation.config import PAPER, IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.frames import Frame

WIDTH = 0.5
NAMES = ("y_left", "y_right", "x_icr")


def frame(stamp_s, pose=None, speeds=(0.4, 0.8)):
    pose = None if pose is None else np.array(pose, dtype=float)
    return Frame(stamp_s, np.array(speeds, dtype=float), 0, pose, None)


def table(y_left, y_right, x_icr, sigma_m=None, **alphas):
    values = {"y_left": y_left, "y_right": y_right, "x_icr": x_icr, **alphas}
    if sigma_m is None:
        return TerrainParameters("icr", values)
    return TerrainParameters("icr", values, NAMES, sigma_m**2 * np.eye(3))


FIXED_NOISE = PAPER | {"position_sigma_m": 0.02, "yaw_sigma_rad": 0.01}


def filter_of(*, terrains=None, **settings):
    """Chen's own filter but for the settings."""
    return IcrEkf(WIDTH, ParameterSet(terrains or {}), IcrEkfConfig(**FIXED_NOISE | settings))


def driven(ekf, terrain="a", steps=30, estimate=None):
    """A drive without poses, so that cross terms grow."""
    estimate = estimate or ekf.start(frame(0, (0, 0, 0)), terrain)
    start_s = estimate.stamp_s
    for i in range(1, steps + 1):
        estimate = ekf.step(estimate, frame(start_s + 0.1 * i), terrain)
    return estimate


def drawn_pose(ekf, estimate, rng):
    """A pose as likely as the filter thinks: from the Gaussian of its own innovation."""
    sigma = np.array([ekf.config.position_sigma_m] * 2 + [ekf.config.yaw_sigma_rad])
    expected = estimate.covariance[:3, :3] + np.diag(sigma**2)
    return rng.multivariate_normal(estimate.mean[:3], expected)


def switched(ekf, estimate, terrain):
    """The estimates just before and just after a switch with no time between."""
    before = ekf.step(estimate, frame(estimate.stamp_s), estimate.terrain)
    return before, ekf.step(estimate, frame(estimate.stamp_s), terrain)
