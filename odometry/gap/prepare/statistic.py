"""The gap: an error over windows of position, heading or gyroscope, and its interval."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from scipy.stats import t

from odometry.arrays import FloatArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added, corrected_twist
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.end_residuals import mean_variances
from odometry.gap.prepare.pieces import numbered_pieces
from odometry.gap.prepare.simulate import residuals, rows_of_gyroscope
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.dense.dense_noise import added_travel_m

RESAMPLES = 1000
SEED = 0
BY_NOISE = 3.0  # times what noise alone scatters at 95 %: it has heavier tails than intervals say
MANY = 5  # pieces; of fewer even the largest and the least value hold less than 95 %


class Measure(Enum):
    """What an error is of, as sentences name it, and its unit."""

    POSITION = ("gap", "position error", "m")
    HEADING = ("heading error", "heading error", "rad")
    GYROSCOPE = ("error of the gyroscope", "error of the turn that the gyroscope reports", "rad")

    @property
    def noun(self) -> str:
        """As sentences name it."""
        return self.value[0]

    @property
    def error(self) -> str:
        """What its root mean square is of."""
        return self.value[1]

    @property
    def unit(self) -> str:
        """Of its root mean square."""
        return self.value[2]


@dataclass(frozen=True)
class Gap:
    """Root mean square with a 95 % interval.

    Attributes
    ----------
    value : float
        In the unit of `measure`.
    low, high : float
        Both are the value where `pieces` is one: there is no interval then.
    pieces : int
        Stretches of the runs from whose spread the interval comes.
    measure : Measure
    """

    value: float
    low: float
    high: float
    pieces: int = MANY
    measure: Measure = Measure.POSITION

    @property
    def has_interval(self) -> bool:
        """Whether there is more than one stretch."""
        return self.pieces > 1

    def is_above(self, floor: "Gap") -> bool:
        """Whether the floor lies below the whole interval, or noise alone would not reach so far.

        Never without an interval.
        """
        return self.has_interval and (self.low > floor.value or self.is_surely_above(floor, 1.0))

    def doubt_above(self, floor: "Gap") -> float:
        """To what the difference to the floor is known.

        From both intervals to the lower bound of a difference of two values that have intervals of
        their own (Zou and Donner 2008, Statistics in Medicine 27, 1693). That of a gap is wide
        where an effect acts in few stretches, though noise alone, in as many of them, would not
        reach it: so it is no more than some times what the floor scatters there, where that is
        known from many.
        """
        of_floor = floor.high - floor.value
        by_both = float(np.hypot(self.value - self.low, of_floor))
        if floor.pieces < MANY or of_floor <= 0:
            return by_both
        as_many = float(np.sqrt(floor.pieces / self.pieces)) * of_floor
        return min(by_both, float(np.hypot(BY_NOISE * as_many, of_floor)))

    def is_surely_above(self, floor: "Gap", times: float) -> bool:
        """Whether it is above the floor by so many times what the difference is known to."""
        return self.value - floor.value > times * self.doubt_above(floor)


@dataclass(frozen=True)
class Shown:
    """A gap before anything is added, and its noise floor: on held-out data, and as measured.

    Nothing was fitted to either.
    """

    held_out: tuple[Gap, Gap]
    measured: tuple[Gap, Gap]

    def is_sure(self, times: float) -> bool:
        """Whether it is surely above its floor on held-out data.

        Or as measured, and there beyond the interval of the floor: few stretches are held out, and
        what acts in some of them has a wide interval.
        """
        gap, floor = self.held_out
        if gap.is_surely_above(floor, times):
            return True
        measured, by_noise = self.measured
        return gap.value > floor.high and measured.is_surely_above(by_noise, times)


def squared_errors(
    base: Base,
    effects: Sequence[Added],
    scene: DenseWindows,
    measure: Measure = Measure.POSITION,
) -> FloatArray:
    """Squared error (K,) at the end of each window [m^2 or rad^2].

    Of its place, of its heading, or of the turn that the gyroscope reports, less its mean over the
    run: a bias is none.
    """
    if measure is Measure.GYROSCOPE:
        twists = corrected_twist(base, effects, scene.inputs)
        turns = rows_of_gyroscope(twists, base, effects, scene).sum(axis=1)
        return np.asarray((turns - turns.mean()) ** 2)
    ends = residuals(base, effects, scene)[:, -1]
    of = ends[:, :2] if measure is Measure.POSITION else ends[:, 2:]
    return np.asarray((of**2).sum(axis=-1))


def gap_of(
    base: Base,
    effects: Sequence[Added],
    scenes: Sequence[DenseWindows],
    part_s: float,
    measure: Measure = Measure.POSITION,
) -> Gap:
    """The gap over all windows; resampled are pieces of the runs, not windows."""
    errors = [(squared_errors(base, effects, scene, measure), scene) for scene in scenes]
    return _pooled(errors, part_s, measure)


def gap_m(base: Base, effects: Sequence[Added], scenes: Sequence[DenseWindows]) -> float:
    """The gap of positions [m] without its interval, which takes longer."""
    return root_mean_square(base, effects, scenes, Measure.POSITION)


def root_mean_square(
    base: Base, effects: Sequence[Added], scenes: Sequence[DenseWindows], measure: Measure
) -> float:
    """A gap [m or rad] without its interval."""
    squares = [squared_errors(base, effects, scene, measure) for scene in scenes]
    return float(np.sqrt(np.concatenate(squares).mean()))


def floor_of(
    held_back: Sequence[tuple[Base, DenseWindows]],
    part_s: float,
    measure: Measure = Measure.POSITION,
) -> Gap:
    """The noise floor: the same over stretches of calibration runs, each with its own base."""
    errors = [(squared_errors(base, (), scene, measure), scene) for base, scene in held_back]
    return _pooled(errors, part_s, measure)


def floor_there(
    floor: Gap, calibration: Calibration, scenes: Sequence[DenseWindows], config: GapConfig
) -> Gap:
    """The noise floor as it would be on other runs.

    Faster ones wander further in a window, and an uncertain calibration leads further off; the
    noise of a gyroscope is the same on all. Never less than a share of the way: stamps and held
    speeds are rounded even where nothing is noisy.
    """
    columns = {Measure.POSITION: [0, 1], Measure.HEADING: [2]}.get(floor.measure)
    here, there = (
        mean_variances(of, calibration)[columns].sum() if columns else 1.0
        for of in ([scene for _, scene in calibration.held_back], scenes)
    )
    ratio = float(np.sqrt(there / here))
    ways = np.concatenate([_way(scene, floor.measure) for scene in scenes])
    least = config.least_floor * float(np.sqrt(np.mean(ways**2)))
    value, low, high = (max(ratio * of, least) for of in (floor.value, floor.low, floor.high))
    return replace(floor, value=value, low=low, high=high)


def _way(scene: DenseWindows, measure: Measure) -> FloatArray:
    """Travel [m] or turn [rad] (K,) of each window."""
    if measure is Measure.POSITION:
        return np.asarray(added_travel_m(scene).sum(axis=1))
    return np.asarray(scene.measured[:, -1, 2])


def _pooled(
    errors: Sequence[tuple[FloatArray, DenseWindows]], part_s: float, measure: Measure
) -> Gap:
    squares = np.concatenate([of for of, _ in errors])
    scenes, rng = [scene for _, scene in errors], np.random.default_rng(SEED)
    (drawn,) = drawn_gaps((squares,), scenes, part_s, rng)
    low, high = np.quantile(drawn, [0.025, 0.975])
    pieces = len(np.unique(numbered_pieces(scenes, part_s)))
    return Gap(float(np.sqrt(squares.mean())), float(low), float(high), pieces, measure)


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
