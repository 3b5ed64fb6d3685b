"""The tables of a report."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from odometry.evaluation.open_loop_consistency import OpenLoopConsistency
from odometry.evaluation.score import Score
from odometry.recording.run import UNKNOWN
from odometry.report.drawing.html import Grid
from terrain.report.lines import ICR_COORDINATES, ReportLines
from terrain.result.evaluation_notes import not_checked, verdict
from terrain.result.run_result import RunResult, TerrainChange
from terrain.result.switch_delay import SwitchDelay, switch_delays, true_stretches
from terrain.switch.switch import SwitchEvent

NOTHING = "\N{EN DASH}"


def error_table(lines: ReportLines, scores: Mapping[str, Score]) -> Grid:
    """Errors by trajectory."""
    return Grid(
        (
            "trajectory",
            "position, mean [m per m]",
            "position, median [m per m]",
            "heading, mean [degrees per m]",
            "heading, median [degrees per m]",
            "off course, mean [m]",
            "off course, median [m]",
            "off course, at the end [m]",
            "stretches",
        ),
        [
            (
                name,
                number(of.mean_translation_per_m, 4),
                number(None if of.translation_per_m is None else of.translation_per_m[1], 4),
                number(of.mean_rotation_deg_per_m, 4),
                number(None if of.rotation_deg_per_m is None else of.rotation_deg_per_m[1], 4),
                number(of.mean_position_m, 3),
                number(of.median_position_m, 3),
                number(of.final_position_m, 3),
                str(of.windows),
            )
            for name, of in scores.items()
        ],
        f"Errors against the {lines.reference_name}.",
    )


def event_grid(result: RunResult) -> Grid | None:
    """What the filter noticed of its sensors."""
    events = result.replay.events
    if not events:
        return None
    began_s = result.run.began_s
    rows = [
        (
            e.kind.replace("_", " "),
            *(f"{stamp_s - began_s:.2f}" for stamp_s in (e.begin_s, e.end_s)),
            e.text,
        )
        for e in events
    ]
    return Grid(("event", "from [s]", "to [s]", "what was noticed"), rows)


def contradiction_grid(result: RunResult) -> Grid:
    """Where camera, feel and motion differ for long."""
    began_s = result.run.began_s
    rows = [
        (
            *(f"{stamp_s - began_s:.1f}" for stamp_s in (one.begin_s, one.end_s)),
            one.camera or NOTHING,
            _share(one.camera_probability),
            one.feel or NOTHING,
            _share(one.feel_probability),
            one.motion or NOTHING,
        )
        for one in result.contradictions
    ]
    header = ("from [s]", "to [s]", "camera", "probability", "feel", "probability", "motion")
    return Grid(header, rows)


def _share(probability: float) -> str:
    return number(None if np.isnan(probability) else probability, 2)


def uncertainty_grid(result: RunResult) -> Grid | None:
    """Standard deviations of the odometer by distance, and whether they are right."""
    of = result.uncertainty
    checks = {check.distance_m: check for check in of.checks}
    own = {check.distance_m: check for check in of.own_checks}
    rows = [
        (
            f"{distance_m:g}",
            *(f"{sigma:.3f}" for sigma in (x, y)),
            f"{np.degrees(yaw):.2f}",
            *([_mean(own.get(distance_m))] if own else []),
            _mean(checks.get(distance_m)),
            *(
                _verdict(checks.get(distance_m), own.get(distance_m))
                or (NOTHING, not_checked(of, distance_m, result.reference_name))
            ),
        )
        for distance_m, (x, y, yaw) in of.sigmas.items()
    ]
    if not rows:
        return None
    header = ("after [m]", "sigma x [m]", "sigma y [m]", "sigma yaw [°]")
    by_own = ("NEES by own poses",) if own else ()
    checked = ("NEES", "95 % bounds", "covariance is")
    return Grid((*header, *by_own, *checked), rows, f"The odometer's covariance: {of.source}.")


def switch_table(result: RunResult) -> Grid | None:
    """Changes of the terrain in force, `unknown` as well, then true changes that were missed."""
    delays, changes = switch_delays(result), result.changes_and_unknown
    if not delays and not changes:
        return None
    known, began_s = bool(true_stretches(result)), result.run.began_s
    late = {
        (of.stamp_s, of.terrain): delay for of, delay in zip(result.changes, delays, strict=False)
    }
    header = ("terrain", "first label [s]", "then ahead [m]", "in force [s]")
    rows = [
        (
            change.terrain,
            *_sight(change, began_s),
            f"{change.stamp_s - began_s:.2f}",
            *(_against_truth(late.get((change.stamp_s, change.terrain)), began_s) if known else ()),
        )
        for change in changes
    ]
    rows += [
        (d.terrain, "missed", *[NOTHING] * 2, *_against_truth(d, began_s))
        for d in delays[len(result.changes) :]
    ]
    truth = ("truly from [s]", "late by [s]", "late by [m]")
    return Grid((*header, *truth) if known else header, rows)


def icr_table(result: RunResult) -> Grid:
    """ICRs by terrain: known before, learned, and the mean of the truth where that is known."""
    rows: list[tuple[str, ...]] = []
    visited = set(result.replay.terrains) - {UNKNOWN}
    for name in dict.fromkeys([*result.learned.terrains, *sorted(visited)]):
        before = result.parameters.terrains.get(name)
        learned = result.learned.terrains.get(name)
        if before is not None:
            rows.append((name, "known before", *_icrs(before)))
        if learned is None:
            rows.append((name, "too few turns or poses to learn", *[NOTHING] * 3))
        elif learned is not before:
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


def _sight(change: SwitchEvent | TerrainChange, began_s: float) -> tuple[str, str]:
    """Stamp of the first label of a terrain and how far ahead, where there is a camera."""
    if isinstance(change, TerrainChange):
        return NOTHING, NOTHING
    return (
        f"{change.first_label.stamp_s - began_s:.2f}",
        f"{change.first_label.distance_ahead_m:.2f}",
    )


def _mean(check: OpenLoopConsistency | None) -> str:
    return NOTHING if check is None else f"{check.mean:.1f}"


def _verdict(check: OpenLoopConsistency | None, own: OpenLoopConsistency | None) -> list[str]:
    """Bounds and what follows, by own poses where there is nothing else; none without either."""
    judging = check or own
    if judging is None:
        return []
    low, high = judging.bounds
    by = "" if check else " by own poses"
    return [f"{low:.1f} to {high:.1f}", verdict(judging) + by]


def _icrs(parameters: Any) -> list[str]:
    sigmas = dict(
        zip(parameters.covariance_order, np.sqrt(np.diag(parameters.covariance)), strict=True)
    )
    return [
        (number(parameters.values.get(icr), 3) + (f" ± {sigmas[icr]:.3f}" if icr in sigmas else ""))
        for icr in ICR_COORDINATES
    ]


def _true_icrs(result: RunResult, terrain: str) -> list[str]:
    truth = result.run.truth
    if truth is None or "terrain" not in truth or not all(icr in truth for icr in ICR_COORDINATES):
        return []
    there = truth["terrain"] == terrain
    return (
        [number(float(truth[icr][there].mean()), 3) for icr in ICR_COORDINATES]
        if any(there)
        else []
    )


def _against_truth(delay: SwitchDelay | None, began_s: float) -> tuple[str, str, str]:
    if delay is None:  # the terrain became unknown, or was known again: no truth is about that
        return NOTHING, NOTHING, NOTHING
    true_s = None if delay.true_s is None else delay.true_s - began_s
    return number(true_s, 2), number(delay.late_s, 2), number(delay.late_m, 2)


def number(value: float | None, digits: int) -> str:
    """A number with so many digits, or a dash for none."""
    return NOTHING if value is None else f"{value:.{digits}f}"
