"""The words of a report."""

from collections.abc import Mapping

import numpy as np

from odometry.evaluation.score import Score
from odometry.recording.run import UNKNOWN
from terrain.report.lines import (
    GYROSCOPE,
    IDEAL,
    ODOMETER,
    ReportLines,
    other_odometer,
)
from terrain.report.tables import number
from terrain.result.evaluation_notes import evaluated_with, without_gyroscope_row
from terrain.result.run_result import RunResult
from terrain.result.switch_delay import true_stretches


def headline(lines: ReportLines, scores: Mapping[str, Score]) -> str:
    """The result in one plain sentence, or why there is none."""
    result = lines.result
    if not scores:
        return (
            "The run has neither truth.csv nor pose.csv with two poses or more: this page shows "
            "what was estimated, and there are no errors."
        )
    own = scores[ODOMETER].mean_translation_per_m
    horizon_m = result.config.evaluation.horizon_m
    if own is None:
        return (
            f"The run is shorter than the {horizon_m:g} m of wheel travel over which errors per "
            "metre are taken: there are none."
        )
    rivals = {f"an ideal {IDEAL}": scores[IDEAL]}
    if GYROSCOPE in scores:
        rivals["gyroscope with mean wheel speed"] = scores[GYROSCOPE]
    rivals |= {name: scores[other_odometer(name)] for name in lines.compared_with}
    parts = [
        f"{_less(own, of.mean_translation_per_m)} than {name} "
        f"({number(of.mean_translation_per_m, 4)})"
        for name, of in rivals.items()
        if of.mean_translation_per_m is not None
    ]
    compared = (
        f"Over stretches of {horizon_m:g} m the error of the odometer is {number(own, 4)} m per m "
        f"of wheel travel against the {lines.reference_name}: {', '.join(parts)}."
    )
    return " ".join([compared, *result.remarks])


def notes(lines: ReportLines) -> list[str]:
    """What each number is against, and what it cannot say."""
    result = lines.result
    evaluation = result.config.evaluation
    found = [
        "The odometer integrates the model open loop, from the first pose on, with the ICRs that "
        "the filter held at each moment; no measurement corrects its pose.",
        f"The {IDEAL} does the same without slip, with the track width of "
        f"{result.run.robot.track_width:g} m.",
        *_gyroscope_notes(result),
        f"Errors per metre are taken over {evaluation.horizon_m:g} m of wheel travel, the mean of "
        f"both treads, starting again every {evaluation.stride_m:g} m.",
    ]
    if result.run.began_s:
        found.append(
            "Times are run time: seconds since the first stamp of the run, "
            f"{result.run.began_s:.3f} s."
        )
    if result.reference is not None and not np.isfinite(result.reference.poses[:, 2]).all():
        found.append(
            "Where the reference has no yaw, its heading at the start of a stretch is the one that "
            f"best turns the {evaluation.horizon_m:g} m before and after onto its positions. Where "
            "the robot stays on the spot there is no such heading and no stretch."
        )
    if result.reference_name == "pose":
        found.append(
            "Errors are against pose.csv, whose own noise is in them. The filter has used these "
            "poses; the odometer's ICRs were learned from those that came before each moment."
        )
    if result.uncertainty.checks:
        found.append(
            "NEES is the odometer's squared error over its covariance, of motions over a distance "
            "anywhere in the run: 3 is expected of x, y and yaw. "
            + (
                "It is taken against the truth."
                if result.reference_name == "truth"
                else "Each half of the run is evaluated with the noise measured on the other half; "
                "by own poses means that the same poses measured the noise."
            )
        )
    if result.second is not None:
        found.append(
            f"The estimate is evaluated with {evaluated_with(result.second)} The estimate that is "
            "written to estimate.csv has used all poses: off_at_the_end_m of result.json is small "
            "for it because of that, and does not say how well it does without them."
        )
    if result.reference_name == "truth":
        found.append("Errors are against truth.csv, which no estimator has used.")
    if result.source == "none" and result.initial_terrain != UNKNOWN:
        found.append(
            f"There was no source of terrain (no vision, no other): {result.initial_terrain} was "
            "in force throughout."
        )
    elif true_stretches(result):
        found.append(
            "A switch is late by the time and wheel travel since the robot's centre came onto the "
            "terrain; below zero it came early."
        )
    return found


def _gyroscope_notes(result: RunResult) -> list[str]:
    missing = without_gyroscope_row(result.replay)
    if missing:
        return missing
    plain = (
        "The gyroscope row drives the mean of both tread speeds along the heading of the "
        "gyroscope as recorded: nothing is fitted."
    )
    if not result.replay.used_gyroscope:
        return [
            plain,
            "The filter did not use the gyroscope: the odometer is turned by the treads.",
        ]
    return [
        plain,
        "Where the gyroscope measures the yaw rate, the odometer is turned by it, less the bias "
        "that the filter held; the odometer without gyroscope is turned by the treads.",
    ]


def _less(own: float, other: float | None) -> str:
    """How much less or more an error is than another one, in words."""
    if not other:
        return "no less"
    share = 1 - own / other
    return f"{100 * abs(share):.0f} % {'less' if share >= 0 else 'more'}"
