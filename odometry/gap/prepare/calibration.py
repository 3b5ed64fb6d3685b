"""The base model: its values, their covariance, and the errors that noise explains."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base_model import Base
from odometry.errors import GapError
from odometry.gap.config import GapConfig
from odometry.gap.prepare.derivative import whitened_derivative
from odometry.gap.prepare.pieces import numbered_pieces, pieces
from odometry.gap.prepare.simulate import all_residuals, whitened_residuals
from odometry.gap.prepare.uncertain_base import Uncertain
from odometry.gap.solve import (
    Bounds,
    RowsAt,
    Solved,
    least_squares,
    steps_within,
    with_jacobian,
)
from odometry.models.base import KinematicModel
from odometry.recording.run import Robot
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.dense.dense_noise import Noise, estimated_noise, whitening

LEAST_WINDOWS = 20
TOGETHER_S = 10.0  # within which errors are taken as correlated
ROUNDS = 3  # of values and noise in turn
ITERATIONS = 8
STARTS_WITH = Noise(0.02, 0.01, 0.02, 0.02)


@dataclass(frozen=True)
class Calibration:
    """A base model and the noise that measured motion has beside it.

    Attributes
    ----------
    uncertain : Uncertain
        The base, and which of its numbers are known only as well as `information` says.
    information : (F, F)
        Inverse covariance of these.
    noise : Noise
    held_back : tuple of (Base, DenseWindows)
        Stretches of the calibration runs, each with a base identified on all others: the noise
        floor is the gap of these.
    gyro_expected : float
        Chi-squared that each residual of the gyroscope has by its own noise.
    """

    uncertain: Uncertain
    information: FloatArray
    noise: Noise
    held_back: tuple[tuple[Base, DenseWindows], ...]
    gyro_expected: float = 1.0

    @property
    def base(self) -> Base:
        """The base model."""
        return self.uncertain.base


def calibrated(
    scenes: Sequence[DenseWindows],
    model: KinematicModel,
    robot: Robot,
    config: GapConfig,
    given: Mapping[str, float] | None = None,
) -> Calibration:
    """Identify the base on calibration runs, and the noise; or take the given values as they are.

    The noise is that of the model as identified here, with what is given of the robot itself. What
    a parameter set does not hold (the latency, the gyroscope's own numbers) is always identified.

    Raises
    ------
    GapError
        If there are too few windows.
    """
    if sum(map(len, scenes)) < LEAST_WINDOWS:
        raise GapError(
            f"{sum(map(len, scenes))} windows of {config.horizon_s:g} s in the calibration runs: "
            f"too few for a model and a noise floor; expected {LEAST_WINDOWS} or more"
        )
    free = np.array([not parameter.known for parameter in model.parameters])
    gyroscope = all(scene.reported_turns is not None for scene in scenes)
    known = {each.name for each in model.parameters if each.known}
    stated = {name: value for name, value in (given or {}).items() if name in known}
    start = model.pack({**model.guess(robot), **stated})
    uncertain = Uncertain(Base(model, start, robot), free, True, gyroscope)
    noise, before = STARTS_WITH, None
    for _ in range(ROUNDS):
        uncertain, _ = _fit(uncertain, scenes, [whitening(scene, noise) for scene in scenes])
        left = [all_residuals(uncertain.base, (), s) for s in scenes]
        noise = before = estimated_noise(scenes, left, before)
    noise, gyro_expected = _doubted(noise, config)
    whiteners = [whitening(scene, noise) for scene in scenes]
    uncertain, information = _fit(uncertain, scenes, whiteners)
    held_back = _held_back(uncertain, scenes, whiteners, config)
    if given is None:
        return Calibration(uncertain, information, noise, held_back, gyro_expected)
    base = replace(uncertain.base, values=model.pack(given))
    believed, information = _fit(
        Uncertain(base, np.zeros_like(free), True, gyroscope), scenes, whiteners
    )
    return Calibration(believed, information, noise, held_back, gyro_expected)


def _doubted(noise: Noise, config: GapConfig) -> tuple[Noise, float]:
    """Noise with which a second of the gyroscope counts no more than a measured yaw.

    And the chi-squared that is then expected of its residuals. A gyroscope is so much more exact
    than any model that it alone would decide, and what it says of time and of itself it still
    says.
    """
    least = config.gyro_least_of_yaw * noise.yaw_rad
    doubted = replace(noise, gyro_rad=max(noise.gyro_rad, least))
    return doubted, (noise.gyro_rad / doubted.gyro_rad) ** 2


def _held_back(
    uncertain: Uncertain,
    scenes: Sequence[DenseWindows],
    whiteners: Sequence[FloatArray],
    config: GapConfig,
) -> tuple[tuple[Base, DenseWindows], ...]:
    """Every part of the runs with a base identified on the others."""
    numbers = [pieces(scene, config.part_s) % config.held_back for scene in scenes]
    held_back = []
    for part in range(config.held_back):
        left = [s.where(n != part) for s, n in zip(scenes, numbers, strict=True)]
        white = [w[n != part] for w, n in zip(whiteners, numbers, strict=True)]
        kept = [s.where(n == part) for s, n in zip(scenes, numbers, strict=True)]
        without, _ = _fit(uncertain, [s for s in left if len(s)], [w for w in white if len(w)])
        held_back += [(without.base, s) for s in kept if len(s)]
    return tuple(held_back)


def _fit(
    uncertain: Uncertain, scenes: Sequence[DenseWindows], whiteners: Sequence[FloatArray]
) -> tuple[Uncertain, FloatArray]:
    """The free numbers that fit best, and their information (F, F)."""

    def rows_at(values: FloatArray) -> FloatArray:
        return whitened_residuals(uncertain.at(values), (), scenes, whiteners)

    def derivative(
        _: RowsAt, values: FloatArray, __: FloatArray, scales: FloatArray, bounds: Bounds
    ) -> FloatArray:
        steps = steps_within(values, scales, bounds)
        return whitened_derivative(
            lambda of: (uncertain.at(of), ()), values, steps, scenes, whiteners
        )

    bounds, scales = uncertain.bounds, uncertain.scales
    ended = least_squares(
        rows_at, uncertain.values, scales, bounds, ITERATIONS, derivative=derivative
    )
    solved = with_jacobian(rows_at, ended, scales, bounds, derivative=derivative)
    found = replace(uncertain, base=uncertain.at(solved.values))
    return found, _information(solved, scenes)


def _information(solved: Solved, scenes: Sequence[DenseWindows]) -> FloatArray:
    """Inverse covariance (F, F), divided by the design effect of pieces of the runs.

    Errors that last for longer than a window count less than as many independent ones: the scores
    of pieces scatter by more than the normal matrix states (Liang and Zeger 1986, eq. 9, here one
    factor for all numbers), or the residuals by more than noise.
    """
    normal = solved.jacobian.T @ solved.jacobian
    freedom = max(1, len(solved.rows) - len(normal))
    pieces_of = numbered_pieces(scenes, TOGETHER_S)
    rows = np.concatenate([np.full(len(scene), scene.rows_per_window) for scene in scenes])
    number = np.unique(np.repeat(pieces_of, rows), return_inverse=True)[1]
    gradients = solved.jacobian * solved.rows[:, None]
    scores = np.stack([np.bincount(number, weights=column) for column in gradients.T], axis=-1)
    scatter = scores.T @ scores * len(scores) / max(1, len(scores) - 1)
    moving = max(1, np.count_nonzero(np.diag(normal)))  # not held at a bound
    design_effect = np.trace(np.linalg.pinv(normal) @ scatter) / moving
    return np.asarray(normal / max(1.0, solved.cost / freedom, design_effect))
