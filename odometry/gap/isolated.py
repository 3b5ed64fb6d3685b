"""Single poses of the reference that are far off their neighbours.

What the poses drift away from the treads is a slow curve, whatever effect is missing: a pose that
lies far from the median of its neighbours on that curve has jumped there and back. Treads that
act late leave such spikes, too, wherever commands are short: no pose is off that a delay explains.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.base_model import Base
from odometry.gap.calibration import Calibration
from odometry.gap.config import GapConfig
from odometry.gap.simulate import simulated_poses
from odometry.windows.dense import DenseWindows
from odometry.windows.robust import NORMAL

NEIGHBOURS = 7  # poses of a median: up to three off in a row do not move it
LEAST_SIGMA_M = 1e-3  # of a reference
NINE_IN_TEN = 2.146  # standard deviations within which nine in ten of normal places lie
DELAYS_S = np.arange(-10, 11) * 0.05  # of the treads against the poses, either way


@dataclass(frozen=True)
class Isolated:
    """Poses of one run that are no measurement of its place.

    Attributes
    ----------
    off : (M,) of bool
    distances_m : (M,)
        By which each is off.
    stamps_s : (M,)
        Run time.
    sigmas : (M,)
        The same in standard deviations of the ordinary ones.
    """

    off: BoolArray
    distances_m: FloatArray
    stamps_s: FloatArray
    sigmas: FloatArray


def isolated(scene: DenseWindows, calibration: Calibration, config: GapConfig) -> Isolated:
    """Poses that are far off their neighbours, of a run as the calibration drives it."""
    base = calibration.base
    distances_m, sigma_m = off_neighbours(drift_of(scene, base))
    if (distances_m > config.outlier_sigmas * sigma_m).any():
        for delay_s in DELAYS_S:
            late = replace(base, latency_s=base.latency_s + float(delay_s))
            distances_m = np.minimum(distances_m, off_neighbours(drift_of(scene, late))[0])
    sigmas = distances_m / sigma_m
    return Isolated(sigmas > config.outlier_sigmas, distances_m, scene.pose_s, sigmas)


def drift_of(scene: DenseWindows, base: Base) -> FloatArray:
    """How far the measured places (M, 2) have gone from those of the treads, step by step."""
    reckoned = simulated_poses(base, (), scene)
    steps = np.diff(reckoned[:, 0] + 1j * reckoned[:, 1])
    steps *= np.exp(1j * (scene.poses[:-1, 2] - reckoned[:-1, 2]))
    measured = np.diff(scene.poses[:, 0] + 1j * scene.poses[:, 1])
    drift = np.concatenate([[0.0], np.cumsum(measured - steps)])
    return np.stack([drift.real, drift.imag], axis=-1)


def off_neighbours(drift: FloatArray) -> tuple[FloatArray, float]:
    """Distances (M,) from the median of the neighbours [m], and their standard deviation."""
    near = [median_filter(part, NEIGHBOURS, mode="nearest") for part in drift.T]
    off = drift - np.stack(near, axis=-1)
    distances_m = np.hypot(*off.T)
    sigma_m = max(
        NORMAL * float(np.median(np.abs(off))),
        float(np.quantile(distances_m, 0.9)) / NINE_IN_TEN,
        LEAST_SIGMA_M,
    )
    return distances_m, sigma_m
