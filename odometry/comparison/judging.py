"""Every prepared model on every window of its split."""

from collections.abc import Sequence

from odometry.comparison.config import ComparisonConfig
from odometry.comparison.judged import judged_windows
from odometry.comparison.judgement import Judgement, Shortfall
from odometry.comparison.parts import Part
from odometry.comparison.predicted import predicted_motion
from odometry.comparison.prepare import Prepared
from odometry.errors import OdometryError
from odometry.windows.window_errors import WindowErrors, errors_of_motion


def judge_all(
    prepared: Sequence[Prepared], config: ComparisonConfig
) -> tuple[list[Judgement], list[Shortfall]]:
    """Judgements over all horizons, and what fell short of one."""
    judgements: list[Judgement] = []
    shortfalls: list[Shortfall] = []
    for each in prepared:
        for part in each.split.judged:
            found, missing = _judge_part(part, each, config)
            judgements += found
            shortfalls += missing
    return judgements, shortfalls


def _judge_part(
    part: Part, prepared: Prepared, config: ComparisonConfig
) -> tuple[list[Judgement], list[Shortfall]]:
    split, found = prepared.split, []
    reasons = dict(prepared.reasons)
    for horizon_m in config.evaluated_m:
        try:
            judged = judged_windows(part, horizon_m, config.training)
        except OdometryError as error:
            if horizon_m in config.horizons_m:
                reasons[""] = str(error)
            continue
        errors: dict[str, WindowErrors] = {}
        for model, predictor in prepared.predictors.items():
            try:
                motion = predicted_motion(predictor, part.run, judged.windows)
                errors[model] = errors_of_motion(motion, judged.windows)
            except OdometryError as error:
                reasons[model] = str(error)
        found.append(
            Judgement(split.robot, split.ground, part.name, split.words, horizon_m, judged, errors)
        )
    shortfalls = [
        Shortfall(split.robot, split.ground, part.name, model, reason)
        for model, reason in reasons.items()
    ]
    return found, shortfalls
