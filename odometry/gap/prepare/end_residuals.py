"""Residuals at the ends of windows, beside what noise and calibration explain of them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.pieces import numbered_pieces
from odometry.gap.prepare.simulate import residuals
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.dense.dense_noise import end_variance

STEP = 1e-4  # of a base parameter, for a derivative
RIDGE = 1e-6  # of the information of the calibration: it may leave a direction open


@dataclass(frozen=True)
class Ends:
    """Residuals at the ends of all windows.

    Attributes
    ----------
    motion : (K, 3)
        Measured less simulated: along, across [m], turn [rad], in the frame of the start.
    variance : (K, 3)
        Of noise alone.
    leeway : (K, 3, F)
        What one standard deviation of each of F independent errors of the calibration does.
    pieces : (K,)
        Number of the piece of the runs in which each lies; pieces are taken as independent.
    """

    motion: FloatArray
    variance: FloatArray
    leeway: FloatArray
    pieces: IntArray

    @property
    def squares_m2(self) -> FloatArray:
        """Squared position errors (K,)."""
        return np.asarray((self.motion[:, :2] ** 2).sum(axis=1))

    @property
    def excess_m2(self) -> FloatArray:
        """Squared position errors (K,) beyond noise and calibration: zero on average without gap.

        What is taken off grows with travel and with the distance from the first pose: a constant
        floor would take every fast window for a gap.
        """
        return np.asarray(self.squares_m2 - self._explained_m2.sum(axis=1))

    @property
    def deviation_m2(self) -> FloatArray:
        """Standard deviation (K,) of that, without gap: normal errors, squared."""
        return np.asarray(np.sqrt(2 * (self._explained_m2**2).sum(axis=1)))

    @property
    def _explained_m2(self) -> FloatArray:
        return np.asarray((self.variance + (self.leeway**2).sum(axis=-1))[:, :2])


def ends_of(
    base: Base,
    effects: Sequence[Added],
    scenes: Sequence[DenseWindows],
    calibration: Calibration,
    part_s: float,
) -> Ends:
    """Of all windows of all scenes, in order."""
    motion, leeway = _with_leeway(base, effects, scenes, calibration)
    variance = np.concatenate([end_variance(scene, calibration.noise) for scene in scenes])
    return Ends(motion, variance, leeway, numbered_pieces(scenes, part_s))


def mean_variances(scenes: Sequence[DenseWindows], calibration: Calibration) -> FloatArray:
    """Of x, y and yaw (3,) at the end of a window: what noise and an uncertain calibration make."""
    noise = np.concatenate([end_variance(scene, calibration.noise) for scene in scenes])
    _, leeway = _with_leeway(calibration.base, (), scenes, calibration)
    return np.asarray((noise + (leeway**2).sum(axis=-1)).mean(axis=0))


def _with_leeway(
    base: Base, effects: Sequence[Added], scenes: Sequence[DenseWindows], calibration: Calibration
) -> tuple[FloatArray, FloatArray]:
    """Residuals (K, 3) at the ends, and how errors of the calibration move them (K, 3, F)."""
    motion = _ends(base, effects, scenes)
    uncertain = replace(calibration.uncertain, base=base)
    values = uncertain.values
    slopes = np.zeros((*motion.shape, len(values)))
    for place in range(len(values)):
        stepped = values.copy()
        stepped[place] += STEP
        slopes[..., place] = (_ends(uncertain.at(stepped), effects, scenes) - motion) / STEP
    information = calibration.information + RIDGE * np.eye(slopes.shape[-1])
    return motion, slopes @ np.linalg.inv(np.linalg.cholesky(information)).T


def _ends(base: Base, effects: Sequence[Added], scenes: Sequence[DenseWindows]) -> FloatArray:
    return np.concatenate([residuals(base, effects, scene)[:, -1] for scene in scenes])
