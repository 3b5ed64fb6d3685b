"""The gap: an error of position over windows, and its interval."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import t

from odometry.arrays import FloatArray
from odometry.effects.base_model import Base
from odometry.effects.corrected import Added
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.end_residuals import mean_variance_m2
from odometry.gap.prepare.pieces import numbered_pieces
from odometry.gap.prepare.simulate import residuals
from odometry.windows.dense import DenseWindows
from odometry.windows.dense_noise import added_travel_m

RESAMPLES = 1000
SEED = 0
MANY = 5  # pieces; of fewer even the largest and the least value hold less than 95 %


@dataclass(frozen=True)
class Gap:
    """Root mean square [m] with a 95 % interval.

    Attributes
    ----------
    value : float
    low, high : float
        Both are the value where `pieces` is one: there is no interval then.
    pieces : int
        Stretches of the runs from whose spread the interval comes.
    """

    value: float
    low: float
    high: float
    pieces: int = MANY

    @property
    def has_interval(self) -> bool:
        """Whether there is more than one stretch."""
        return self.pieces > 1

    def is_above(self, floor: "Gap") -> bool:
        """Whether the floor lies below the whole interval; never without one."""
        return self.has_interval and self.low > floor.value


def squared_errors(base: Base, effects: Sequence[Added], scene: DenseWindows) -> FloatArray:
    """Squared error (K,) of the position at the end of each window [m^2]."""
    ends = residuals(base, effects, scene)[:, -1, :2]
    return np.asarray((ends**2).sum(axis=-1))


def gap_of(
    base: Base, effects: Sequence[Added], scenes: Sequence[DenseWindows], part_s: float
) -> Gap:
    """The gap over all windows; resampled are pieces of the runs, not windows."""
    return _pooled([(squared_errors(base, effects, scene), scene) for scene in scenes], part_s)


def gap_m(base: Base, effects: Sequence[Added], scenes: Sequence[DenseWindows]) -> float:
    """The gap [m] without its interval, which takes longer."""
    squares = [squared_errors(base, effects, scene) for scene in scenes]
    return float(np.sqrt(np.concatenate(squares).mean()))


def floor_of(held_back: Sequence[tuple[Base, DenseWindows]], part_s: float) -> Gap:
    """The noise floor: the same over stretches of calibration runs, each with its own base."""
    return _pooled([(squared_errors(base, (), scene), scene) for base, scene in held_back], part_s)


def floor_there(
    floor: Gap, calibration: Calibration, scenes: Sequence[DenseWindows], config: GapConfig
) -> Gap:
    """The noise floor as it would be on other runs.

    Faster ones wander further in a window, and an uncertain calibration leads further off. Never
    less than a share of the way: stamps and held speeds are rounded even where nothing is noisy.
    """
    here = mean_variance_m2([scene for _, scene in calibration.held_back], calibration)
    ratio = float(np.sqrt(mean_variance_m2(scenes, calibration) / here))
    travels_m = np.concatenate([added_travel_m(scene).sum(axis=1) for scene in scenes])
    least_m = config.least_floor * float(np.sqrt(np.mean(travels_m**2)))
    value, low, high = (max(ratio * of, least_m) for of in (floor.value, floor.low, floor.high))
    return Gap(value, low, high, floor.pieces)


def _pooled(errors: Sequence[tuple[FloatArray, DenseWindows]], part_s: float) -> Gap:
    squares = np.concatenate([of for of, _ in errors])
    scenes, rng = [scene for _, scene in errors], np.random.default_rng(SEED)
    (drawn,) = drawn_gaps((squares,), scenes, part_s, rng)
    low, high = np.quantile(drawn, [0.025, 0.975])
    pieces = len(np.unique(numbered_pieces(scenes, part_s)))
    return Gap(float(np.sqrt(squares.mean())), float(low), float(high), pieces)


def drawn_gaps(
    squares_m2: Sequence[FloatArray],
    scenes: Sequence[DenseWindows],
    part_s: float,
    rng: np.random.Generator,
) -> FloatArray:
    """Gaps (E, R) of each kind of squared errors (K of all scenes), by the same draws of pieces."""
    _, piece = np.unique(numbered_pieces(scenes, part_s), return_inverse=True)
    counts = np.bincount(piece)
    sums = np.stack([np.bincount(piece, weights=of) for of in squares_m2])
    drawn = rng.integers(len(counts), size=(RESAMPLES, len(counts)))
    return np.asarray(np.sqrt(sums[:, drawn].sum(axis=-1) / counts[drawn].sum(axis=-1)))


def sure_sum(of_pieces: FloatArray, trimmed: int) -> float:
    """A sum that is sure at 95 %: pieces of the runs are a sample, and a gain of one is none.

    The larger of two bounds: that of Student's t over the pieces, and the sum without so many of
    the best pieces. An effect that acts in few pieces scatters too much for the first, and keeps
    a gain in the second only if it acts in more pieces than are left out.
    """
    count = len(of_pieces)
    if count < 2:
        return -float("inf")
    reach = float(t.ppf(0.95, count - 1) * np.sqrt(count) * of_pieces.std(ddof=1))
    return max(float(of_pieces.sum()) - reach, float(np.sort(of_pieces)[:-trimmed].sum()))
