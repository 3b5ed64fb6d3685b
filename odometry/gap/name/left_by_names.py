"""What names leave: structure, or no gap, as the program itself would call it."""

from collections.abc import Sequence

from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitted, Fitter
from odometry.gap.locate.predictors import Predictor, predictors
from odometry.gap.locate.variables import window_variables
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.form import names_alone
from odometry.gap.name.search import Search
from odometry.gap.prepare.end_residuals import ends_of
from odometry.gap.prepare.measures import is_shown, on_runs, other_measures
from odometry.gap.prepare.statistic import Measure
from odometry.windows.dense.dense import DenseWindows


def leaves_no_gap(
    fitter: Fitter, fit: Fitted, held_out: Sequence[DenseWindows], config: GapConfig
) -> bool:
    """Whether names that last leave no gap, on measured or on held-out runs.

    Positions not surely above their noise floor, of which they close nearly all of the excess;
    headings and the gyroscope not so far above theirs that they would be called a gap. Chi-squared
    may be above that of noise all the same: a rougher part of a drive is noisier than its
    calibration, and without a change is called none.
    """
    if any(one.effect.course for one in fit.effects):
        return False
    runs = (fitter.measured.scenes, held_out)
    return all(_is_within(fitter, fit, scenes, config) for scenes in runs) and not any(
        is_shown(*on_runs(fitter.calibration, scenes, config, measure, _model(fit)), config)
        for measure in other_measures(*runs, has_yaw=True)
        for scenes in runs
    )


def _is_within(
    fitter: Fitter, fit: Fitted, scenes: Sequence[DenseWindows], config: GapConfig
) -> bool:
    """Whether positions are not surely above their floor, and nearly all of what they were."""
    known = fitter.calibration
    before, _ = on_runs(known, scenes, config, Measure.POSITION)
    after, floor = on_runs(known, scenes, config, Measure.POSITION, _model(fit))
    closed = before.value - after.value
    nearly_all = config.mostly_closed * (before.value - floor.value)
    is_above = after.is_surely_above(floor, config.above_floor)
    return not is_above and closed > 0 and closed >= nearly_all


def _model(fit: Fitted) -> tuple[Base, tuple[Added, ...]]:
    return fit.base, fit.effects


def that_last(search: Search, found: Explanation) -> Explanation | None:
    """Names that last, where these leave no gap; without those that come and go in time beside.

    None where they leave one. Such names take up what is rougher there than the calibration, and
    are refused for the rest of it.
    """
    names = [effect for effect in found.effects if not isinstance(effect, Residual)]
    lasting = [effect for effect in names if not effect.course]
    left = found if len(lasting) == len(names) else search.in_order(found, lasting)
    alone = names_alone(search.fitter, left)
    no_gap = lasting and leaves_no_gap(search.fitter, alone, search.held_out, search.config)
    return left if no_gap else None


def by_themselves(search: Search, found: Explanation) -> Explanation | None:
    """Names that last without the functions beside them, where no gap is left for these.

    None where there is one.
    """
    left = that_last(search, found)
    if left is None:
        return None
    return search.in_order(left, [e for e in left.effects if not isinstance(e, Residual)])


def structure_left(fitter: Fitter, fit: Fitted, config: GapConfig) -> tuple[Predictor, ...]:
    """By the same tests that locate a gap, of the residuals beside the effects of a fit."""
    scenes = fitter.measured.scenes
    ends = ends_of(fit.base, fit.effects, scenes, fitter.calibration, config.part_s)
    return predictors(window_variables(fit.base, fit.effects, scenes), ends)
