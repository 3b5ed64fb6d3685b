"""The model believed so far: its values, how sure they are, and what noise explains."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base_model import Base
from odometry.gap.config import GapConfig
from odometry.gap.errors import GapError
from odometry.gap.pieces import numbered_pieces, pieces
from odometry.gap.simulate import residuals, whitened_residuals
from odometry.gap.solve import Solved, least_squares, with_jacobian
from odometry.gap.uncertain import Uncertain
from odometry.models.base import KinematicModel
from odometry.run import Robot, Run
from odometry.windows.dense import DenseWindows, dense_windows_of, thinned
from odometry.windows.dense_noise import Noise, estimated_noise, whitening

LEAST_WINDOWS = 20
TOGETHER_S = 10.0  # within which errors are taken as alike
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
    """

    uncertain: Uncertain
    information: FloatArray
    noise: Noise
    held_back: tuple[tuple[Base, DenseWindows], ...]

    @property
    def base(self) -> Base:
        """The model believed so far."""
        return self.uncertain.base


def calibrated(
    runs: Sequence[Run],
    model: KinematicModel,
    robot: Robot,
    config: GapConfig,
    given: Mapping[str, float] | None = None,
) -> Calibration:
    """Identify the base on calibration runs, and the noise; or take the given values as they are.

    Raises
    ------
    GapError
        If there are too few windows.
    """
    scenes = [thinned(dense_windows_of(run, config.horizon_s), config.most_windows) for run in runs]
    if sum(map(len, scenes)) < LEAST_WINDOWS:
        raise GapError(
            f"{sum(map(len, scenes))} windows of {config.horizon_s:g} s in the calibration runs: "
            f"too few for a model and a noise floor; expected {LEAST_WINDOWS} or more"
        )
    free = np.array([not parameter.known for parameter in model.parameters])
    uncertain = Uncertain(Base(model, model.pack(model.guess(robot)), robot), free, True)
    noise = STARTS_WITH
    for _ in range(ROUNDS):
        uncertain, _ = _fit(uncertain, scenes, noise)
        noise = estimated_noise(scenes, [residuals(uncertain.base, (), s) for s in scenes])
    uncertain, information = _fit(uncertain, scenes, noise)
    held_back = _held_back(uncertain, scenes, noise, config)
    if given is None:
        return Calibration(uncertain, information, noise, held_back)
    believed = Uncertain(
        Base(model, model.pack(given), robot), np.zeros_like(free), latency_is_free=False
    )
    return Calibration(believed, np.empty((0, 0)), noise, held_back)


def _held_back(
    uncertain: Uncertain, scenes: Sequence[DenseWindows], noise: Noise, config: GapConfig
) -> tuple[tuple[Base, DenseWindows], ...]:
    """Every part of the runs with a base identified on the others."""
    numbers = [pieces(scene, config.part_s) % config.held_back for scene in scenes]
    held_back = []
    for part in range(config.held_back):
        others = [s.where(n != part) for s, n in zip(scenes, numbers, strict=True)]
        kept = [s.where(n == part) for s, n in zip(scenes, numbers, strict=True)]
        without, _ = _fit(uncertain, [s for s in others if len(s)], noise)
        held_back += [(without.base, s) for s in kept if len(s)]
    return tuple(held_back)


def _fit(
    uncertain: Uncertain, scenes: Sequence[DenseWindows], noise: Noise
) -> tuple[Uncertain, FloatArray]:
    """The free numbers that fit best, and their information (F, F)."""
    whiteners = [whitening(scene, noise) for scene in scenes]

    def rows_at(values: FloatArray) -> FloatArray:
        return whitened_residuals(uncertain.at(values), (), scenes, whiteners)

    bounds, scales = uncertain.bounds, uncertain.scales
    ended = least_squares(rows_at, uncertain.values, scales, bounds, ITERATIONS)
    solved = with_jacobian(rows_at, ended, scales, bounds)
    found = replace(uncertain, base=uncertain.at(solved.values))
    return found, _information(solved, scenes)


def _information(solved: Solved, scenes: Sequence[DenseWindows]) -> FloatArray:
    """Inverse covariance (F, F), divided by the design effect of pieces of the runs.

    Errors that last for longer than a window say less than as many independent ones: the scores
    of pieces scatter by more than the normal matrix says (Liang and Zeger 1986, eq. 9, here one
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
