"""Which variables predict what a fit leaves on the runs that it was fitted to."""

from odometry.gap.config import GapConfig
from odometry.gap.end_residuals import ends_of
from odometry.gap.fit import Fitted, Fitter
from odometry.gap.predictors import Predictor, predictors
from odometry.gap.variables import window_variables


def structure_left(fitter: Fitter, fit: Fitted, config: GapConfig) -> tuple[Predictor, ...]:
    """By the same tests that locate a gap, of the residuals beside the effects of a fit."""
    scenes = fitter.measured.scenes
    ends = ends_of(fit.base, fit.effects, scenes, fitter.calibration, config.part_s)
    return predictors(window_variables(fit.base, fit.effects, scenes), ends)
