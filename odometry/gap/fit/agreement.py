"""Whether positions, the yaw and the gyroscope show one strength of an effect.

An effect that is what its name says has one strength in all that measures it. One that stands for
something else has not: a yaw that a motor's current bends is like poses that are smoothed over
time, of which positions show half.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.gap.fit.fitter import Fitted, Fitter
from odometry.gap.prepare.simulate import all_residuals
from odometry.windows.dense.dense import DenseWindows

POSITIONS, YAW, GYROSCOPE = "positions", "the yaw", "the gyroscope"
LEAST_PIECES = 4  # of the runs: fewer do not say how uncertain a strength is
LEAST_CHANGE = 9.0  # of chi-squared: what an effect changes less than its noise says nothing of it


@dataclass(frozen=True)
class Strength:
    """Factor of what an effect does that fits best by one measure; one where it fits as well.

    Attributes
    ----------
    factor : float
    sigma : float
        Standard deviation, by leaving out one piece of the runs at a time.
    """

    factor: float
    sigma: float


@dataclass(frozen=True)
class Disagreement:
    """Two measures that show the most different strengths.

    Attributes
    ----------
    stronger, weaker : str
        One of `POSITIONS`, `YAW`, `GYROSCOPE`.
    factors : (float, float)
        Of the stronger and of the weaker.
    sigmas : float
        In how many standard deviations they differ.
    """

    stronger: str
    weaker: str
    factors: tuple[float, float]
    sigmas: float

    @property
    def difference(self) -> float:
        """Of both factors, at least 0."""
        return self.factors[0] - self.factors[1]


def disagreement(fitter: Fitter, fit: Fitted, place: int) -> Disagreement | None:
    """Of one effect of a fit; None where fewer than two measures, or pieces, say anything."""
    of = strengths(fitter, fit, place)
    pairs = [
        Disagreement(
            one,
            other,
            (of[one].factor, of[other].factor),
            (of[one].factor - of[other].factor) / float(np.hypot(of[one].sigma, of[other].sigma)),
        )
        for one in of
        for other in of
        if of[one].factor > of[other].factor
    ]
    return max(pairs, key=lambda pair: pair.sigmas, default=None)


def strengths(fitter: Fitter, fit: Fitted, place: int) -> Mapping[str, Strength]:
    """Strength of one effect by each measure that it changes, each whitened by its own noise."""
    measured = fitter.measured
    others = (*fit.effects[:place], *fit.effects[place + 1 :])
    sums: dict[str, list[FloatArray]] = defaultdict(list)
    for white, scene in zip(measured.whiteners, measured.scenes, strict=True):
        left = all_residuals(fit.base, fit.effects, scene)
        does = all_residuals(fit.base, others, scene) - left
        lower = np.linalg.inv(white)
        for name, rows in _measures(scene, left.shape[1]):
            own = lower[:, rows]
            covariance = own @ own.swapaxes(1, 2)
            weighted = np.linalg.solve(covariance, does[:, rows, None])[..., 0]
            by_window = [(weighted * of[:, rows]).sum(axis=1) for of in (left, does)]
            sums[name].append(np.array(by_window))
    found = {name: _of_pieces(np.hstack(of), fitter) for name, of in sums.items()}
    return {name: one for name, one in found.items() if one is not None}


def _measures(scene: DenseWindows, count: int) -> Iterator[tuple[str, IntArray]]:
    """Names of the measures, and their rows among `count` of a window."""
    of_poses = 3 * (scene.windows.shape[1] - 1)
    rows = np.arange(count)
    yield POSITIONS, rows[(rows < of_poses) & (rows % 3 < 2)]
    yield YAW, rows[(rows < of_poses) & (rows % 3 == 2)]
    if count > of_poses:
        yield GYROSCOPE, rows[of_poses:]


def _of_pieces(sums: FloatArray, fitter: Fitter) -> Strength | None:
    """Of score and weight (2, K) of all windows; None where the measure says nothing."""
    score, weight = (fitter.by_piece(of) for of in sums)
    count, left = len(weight), weight.sum() - weight
    if count < LEAST_PIECES or weight.sum() < LEAST_CHANGE or not (left > 0).all():
        return None
    factors = 1 + (score.sum() - score) / left
    variance = (count - 1) * float(np.var(factors))
    return Strength(1 + float(score.sum() / weight.sum()), float(np.sqrt(variance)))
