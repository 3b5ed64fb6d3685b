"""What names leave: structure, or no gap, as the program itself would call it."""

from collections.abc import Sequence

from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitted, Fitter
from odometry.gap.locate.predictors import Predictor, predictors
from odometry.gap.locate.variables import window_variables
from odometry.gap.prepare.end_residuals import ends_of
from odometry.gap.prepare.measures import on_runs, other_measures
from odometry.gap.prepare.statistic import Gap, Measure
from odometry.windows.dense import DenseWindows


def leaves_no_gap(
    fitter: Fitter, fit: Fitted, held_out: Sequence[DenseWindows], config: GapConfig
) -> bool:
    """Whether names that last bring all errors within their noise floors, on all runs.

    Errors of positions, headings and the gyroscope, on measured and on held-out runs; of positions
    nearly all of the excess must be theirs. Chi-squared may be above that of noise all the same: a
    rougher part of a drive is noisier than its calibration, and without a gap is called none.
    """
    if any(one.effect.course for one in fit.effects):
        return False
    known, measured = fitter.calibration, fitter.measured.scenes
    model = (fit.base, fit.effects)
    for measure in (Measure.POSITION, *other_measures(measured, held_out, has_yaw=True)):
        for scenes in (measured, held_out):
            after, floor = on_runs(known, scenes, config, measure, model)
            if after.value > floor.high:
                return False
            before, _ = on_runs(known, scenes, config, measure)
            if measure is Measure.POSITION and not _closes(before, after, floor, config):
                return False
    return True


def _closes(before: Gap, after: Gap, floor: Gap, config: GapConfig) -> bool:
    closed = before.value - after.value
    return closed > 0 and closed >= config.mostly_closed * (before.value - floor.value)


def structure_left(fitter: Fitter, fit: Fitted, config: GapConfig) -> tuple[Predictor, ...]:
    """By the same tests that locate a gap, of the residuals beside the effects of a fit."""
    scenes = fitter.measured.scenes
    ends = ends_of(fit.base, fit.effects, scenes, fitter.calibration, config.part_s)
    return predictors(window_variables(fit.base, fit.effects, scenes), ends)
