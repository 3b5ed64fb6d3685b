"""Windows of measured runs, whitened by the noise of the calibration."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.pieces import numbered_pieces
from odometry.gap.prepare.responses import whitened
from odometry.gap.prepare.simulate import all_residuals_of_each, whitened_residuals
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.dense.dense_noise import whitening

TOGETHER = 10  # models


@dataclass(frozen=True)
class Measured:
    """Windows of measured runs, whitened by the noise of the calibration.

    Attributes
    ----------
    scenes : tuple of DenseWindows
    whiteners : tuple of (K, 3n, 3n)
    folds : (K of all,)
        Which part each window belongs to.
    pieces : (K of all,)
        Number of the piece of all runs in which it lies.
    gyro_expected : float
        Chi-squared that noise makes of each residual of the gyroscope; one of all others.
    """

    scenes: tuple[DenseWindows, ...]
    whiteners: tuple[FloatArray, ...]
    folds: IntArray
    pieces: IntArray
    gyro_expected: float = 1.0

    @cached_property
    def expected(self) -> float:
        """Chi-squared that noise alone makes of all windows."""
        of_scenes = 0.0
        for scene in self.scenes:
            of_poses = 3 * (scene.windows.shape[1] - 1)
            of_gyroscope = scene.rows_per_window - of_poses
            of_scenes += len(scene) * (of_poses + self.gyro_expected * of_gyroscope)
        return of_scenes

    def rows(self, base: Base, effects: Sequence[Added]) -> FloatArray:
        """Whitened residuals (R,) of all windows, scene by scene."""
        return whitened_residuals(base, effects, self.scenes, self.whiteners)

    def rows_of_each(self, models: Sequence[tuple[Base, Sequence[Added]]]) -> FloatArray:
        """The same (C, R) of several models at once."""
        made = np.empty((len(models), len(self.window_of_row)))
        for begin in range(0, len(models), TOGETHER):
            some = models[begin : begin + TOGETHER]
            of_scenes = [
                whitened(white, all_residuals_of_each(some, scene))
                for white, scene in zip(self.whiteners, self.scenes, strict=True)
            ]
            made[begin : begin + TOGETHER] = np.concatenate(of_scenes).T
        return made

    @cached_property
    def window_of_row(self) -> IntArray:
        """Number (R,) of the window of each row."""
        sizes = [np.full(len(scene), scene.rows_per_window) for scene in self.scenes]
        return np.repeat(np.arange(len(self.folds)), np.concatenate(sizes))

    def by_window(self, rows: FloatArray) -> FloatArray:
        """Chi-squared (K,) of each window."""
        summed = np.bincount(self.window_of_row, weights=rows**2, minlength=len(self.folds))
        return np.asarray(summed, dtype=np.float64)


def measured_of(
    scenes: Sequence[DenseWindows], calibration: Calibration, config: GapConfig
) -> Measured:
    """Whiten windows by the noise of a calibration; pieces of the runs are dealt to the folds."""
    joined = numbered_pieces(scenes, config.part_s)
    return Measured(
        tuple(scenes),
        tuple(whitening(scene, calibration.noise) for scene in scenes),
        joined % config.folds,
        joined,
        calibration.gyro_expected,
    )


def at_fewer_poses(measured: Measured, calibration: Calibration, most: int) -> Measured:
    """The same windows of at most so many poses after the first: as good, and faster, to choose."""
    scenes = tuple(with_fewer_poses(scene, most) for scene in measured.scenes)
    whiteners = tuple(whitening(scene, calibration.noise) for scene in scenes)
    return replace(measured, scenes=scenes, whiteners=whiteners)


def with_fewer_poses(scene: DenseWindows, most: int) -> DenseWindows:
    """The same windows, of their poses the first, the last and others evenly between."""
    count = scene.windows.shape[1]
    chosen = np.unique(np.rint(np.linspace(0, count - 1, min(count, most + 1))).astype(np.int64))
    return replace(scene, windows=scene.windows[:, chosen])
