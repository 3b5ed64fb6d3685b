"""The words and tables of a report."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from odometry.evaluation.open_loop_consistency import OpenLoopConsistency
from odometry.evaluation.score import Score
from odometry.report.html import Grid
from terrain.odometer_uncertainty import verdict
from terrain.report.lines import (
    GYROSCOPE,
    ICR_COORDINATES,
    IDEAL,
    LABELS,
    ODOMETER,
    ReportLines,
    other_odometer,
)
from terrain.run_odometry import RunResult
from terrain.switch_delay import SwitchDelay, switch_delays, true_stretches
from terrain.verdicts import NO_GYROSCOPE, judged_by, remarks

NOTHING = "\N{EN DASH}"


def headline(lines: ReportLines, scores: Mapping[str, Score]) -> str:
    """The result in one plain sentence, or why there is none."""
    result = lines.result
    if not scores:
        return (
            "The run has neither truth.csv nor pose.csv with two poses or more: this page shows "
            "what was estimated, and nothing is judged."
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
        f"{_less(own, of.mean_translation_per_m)} than {name} ({_cm(of.mean_translation_per_m)})"
        for name, of in rivals.items()
        if of.mean_translation_per_m is not None
    ]
    compared = (
        f"Over stretches of {horizon_m:g} m the odometer errs by {_cm(own)} per metre of wheel "
        f"travel against the {lines.reference_name}: {', '.join(parts)}."
    )
    by_name = {name: scores[label] for name, label in LABELS.items() if label in scores}
    return " ".join([compared, *remarks(by_name, result.off_at_the_end_m)])


def error_table(lines: ReportLines, scores: Mapping[str, Score]) -> Grid:
    """Errors by trajectory."""
    return Grid(
        (
            "trajectory",
            "position, mean [cm/m]",
            "position, median [cm/m]",
            "heading, mean [°/m]",
            "heading, median [°/m]",
            "off course, mean [m]",
            "off course, median [m]",
            "off course, at the end [m]",
            "stretches",
        ),
        [
            (
                name,
                _number(of.mean_translation_per_m, 2, 100),
                _number(None if of.translation_per_m is None else of.translation_per_m[1], 2, 100),
                _number(of.mean_rotation_deg_per_m, 2),
                _number(None if of.rotation_deg_per_m is None else of.rotation_deg_per_m[1], 2),
                _number(of.mean_position_m, 3),
                _number(of.median_position_m, 3),
                _number(of.final_position_m, 3),
                str(of.windows),
            )
            for name, of in scores.items()
        ],
        f"Errors against the {lines.reference_name}.",
    )


def uncertainty_grid(result: RunResult) -> Grid | None:
    """Standard deviations of the odometer by distance, and whether they are right."""
    of = result.uncertainty
    checks = {check.distance_m: check for check in of.checks}
    rows = [
        (
            f"{distance_m:g}",
            *(f"{sigma:.3f}" for sigma in (x, y)),
            f"{np.degrees(yaw):.2f}",
            *(_checked(checks[distance_m]) if distance_m in checks else [NOTHING] * 3),
        )
        for distance_m, (x, y, yaw) in of.sigmas.items()
    ]
    if not rows:
        return None
    header = ("after [m]", "sigma x [m]", "sigma y [m]", "sigma yaw [°]", "NEES", "95% bounds")
    return Grid((*header, "covariance is"), rows, f"The odometer's covariance: {of.source}.")


def switch_table(result: RunResult) -> Grid | None:
    """Every change of the terrain in force, then the true changes that were missed."""
    delays = switch_delays(result)
    if result.watcher is None or not delays:
        return None
    known = bool(true_stretches(result))
    events = result.watcher.events
    header = ("terrain", "first seen [s]", "then ahead [m]", "in force [s]")
    rows = [
        (
            event.terrain,
            f"{event.sight.stamp_s:.2f}",
            f"{event.sight.distance_ahead_m:.2f}",
            f"{event.stamp_s:.2f}",
            *(_against_truth(delay) if known else ()),
        )
        for event, delay in zip(events, delays, strict=False)
    ]
    rows += [
        (d.terrain, "missed", *[NOTHING] * 2, *_against_truth(d)) for d in delays[len(events) :]
    ]
    truth = ("truly from [s]", "late by [s]", "late by [m]")
    return Grid((*header, *truth) if known else header, rows)


def icr_table(result: RunResult) -> Grid:
    """ICRs by terrain: known before, learned, and the mean of the truth where that is known."""
    rows = []
    for name, learned in result.learned.terrains.items():
        before = result.parameters.terrains.get(name)
        if before is not None:
            rows.append((name, "known before", *_icrs(before)))
        if before is not learned:
            rows.append((name, "learned", *_icrs(learned)))
        true = _true_icrs(result, name)
        if true:
            rows.append((name, "truth, mean", *true))
    return Grid(("terrain", "", *(f"{icr} [m]" for icr in ICR_COORDINATES)), rows,
                "Instantaneous centres of rotation, ± one standard deviation.")  # fmt: skip


def settings_table(result: RunResult) -> Grid:
    """Every setting that was used."""
    rows = [("run", result.run.name), ("terrain at the start", result.initial_terrain)]
    rows += [
        (f"{block}.{key}", str(value))
        for block, table in result.config.to_table().items()
        for key, value in table.items()
    ]
    return Grid(("setting", "value"), rows)


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
        f"both treads, starting anew every {evaluation.stride_m:g} m.",
    ]
    if result.reference is not None and not np.isfinite(result.reference.poses[:, 2]).all():
        found.append(
            "Where the reference has no yaw, its heading at the start of a stretch is the one that "
            f"best turns the {evaluation.horizon_m:g} m before and after onto its positions."
        )
    if result.reference_name == "pose":
        found.append(
            "Errors are against pose.csv, whose own noise is in them. The filter has seen these "
            "poses; the odometer's ICRs were learned from those that came before each moment."
        )
    if result.uncertainty.checks:
        found.append(
            "NEES is the odometer's squared error over its covariance, of motions over a distance "
            "anywhere in the run: 3 is expected of x, y and yaw. "
            + (
                "It is taken against the truth."
                if result.reference_name == "truth"
                else "Each half of the run is judged by the noise measured on the other half."
            )
        )
    if result.second is not None:
        found.append(f"The estimate is judged by {judged_by(result.second)}")
    if result.reference_name == "truth":
        found.append("Errors are against truth.csv, which no estimator has seen.")
    if result.watcher is None:
        found.append(f"There was no vision: {result.initial_terrain} was in force throughout.")
    elif true_stretches(result):
        found.append(
            "A switch is late by the time and wheel travel since the robot's centre came onto the "
            "terrain; below zero it came early."
        )
    return found


def _gyroscope_notes(result: RunResult) -> list[str]:
    if not result.replay.has_gyroscope:
        return [NO_GYROSCOPE]
    return [
        "Where the gyroscope tells the yaw rate, the odometer is turned by it, less the bias that "
        "the filter held; the odometer without gyroscope is turned by the treads.",
        "The gyroscope row drives the mean of both tread speeds along the heading of the "
        "gyroscope as recorded: nothing is fitted.",
    ]


def _checked(check: OpenLoopConsistency) -> tuple[str, str, str]:
    low, high = check.bounds
    return f"{check.mean:.1f}", f"{low:.1f} to {high:.1f}", verdict(check)


def _icrs(parameters: Any) -> list[str]:
    sigmas = dict(
        zip(parameters.covariance_order, np.sqrt(np.diag(parameters.covariance)), strict=True)
    )
    return [
        (
            _number(parameters.values.get(icr), 3)
            + (f" ± {sigmas[icr]:.3f}" if icr in sigmas else "")
        )
        for icr in ICR_COORDINATES
    ]


def _true_icrs(result: RunResult, terrain: str) -> list[str]:
    truth = result.run.truth
    if truth is None or "terrain" not in truth or not all(icr in truth for icr in ICR_COORDINATES):
        return []
    there = truth["terrain"] == terrain
    return (
        [_number(float(truth[icr][there].mean()), 3) for icr in ICR_COORDINATES]
        if any(there)
        else []
    )


def _against_truth(delay: SwitchDelay) -> tuple[str, str, str]:
    return _number(delay.true_s, 2), _number(delay.late_s, 2), _number(delay.late_m, 2)


def _number(value: float | None, digits: int, factor: float = 1.0) -> str:
    return NOTHING if value is None else f"{factor * value:.{digits}f}"


def _cm(metres: float | None) -> str:
    return f"{_number(metres, 1, 100)} cm"


def _less(own: float, other: float | None) -> str:
    """How much less or more an error is than another one, in words."""
    if not other:
        return "no less"
    share = 1 - own / other
    return f"{abs(share):.0%} {'less' if share >= 0 else 'more'}"
