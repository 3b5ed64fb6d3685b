"""The content of result.json, with the covariance of the odometer as a table and as columns."""

from dataclasses import asdict
from importlib.metadata import version
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.evaluation.odometer_uncertainty import OdometerUncertainty
from odometry.evaluation.open_loop_consistency import DEGREES, OpenLoopConsistency
from odometry.evaluation.open_loop_errors import SOURCES
from odometry.evaluation.reference_yaw import counted_reference_yaw
from odometry.evaluation.score import JUDGED_EVERY_S, SILENT_S
from odometry.fixes.origin import stated_origin
from odometry.recording.run import UNKNOWN
from terrain.result.evaluated import is_used_by_filter
from terrain.result.evaluation_notes import advice, filter_table, verdict
from terrain.result.label_confusion import label_confusion_table
from terrain.result.new_terrain import contradiction_lines
from terrain.result.run_notes import run_notes
from terrain.result.run_result import RunResult, TerrainChange
from terrain.result.switch_delay import switch_delays
from terrain.switch.switch import SwitchEvent

NAMES = ("x", "y", "yaw")
PAIRS = ((0, 1), (0, 2), (1, 2))
COVARIANCE_COLUMNS = (
    *(f"sigma_{name}" for name in NAMES),
    *(f"covariance_{NAMES[i]}_{NAMES[j]}" for i, j in PAIRS),
)


def covariance_columns(of: FloatArray) -> dict[str, FloatArray]:
    """Columns of odometer.csv from covariances (k, 3, 3): three sigmas, three covariances."""
    sigmas = np.sqrt(np.maximum(np.diagonal(of, axis1=1, axis2=2), 0.0))
    columns = (*sigmas.T, *(of[:, i, j] for i, j in PAIRS))
    return dict(zip(COVARIANCE_COLUMNS, columns, strict=True))


def uncertainty_table(uncertainty: OdometerUncertainty, reference_name: str) -> dict[str, Any]:
    """What result.json holds of it: plain values, metres and radians."""
    sigmas_by_source = np.sqrt(uncertainty.noise.variances).tolist()
    return {
        "source": uncertainty.source,
        "sigma_by_source": dict(zip(SOURCES, sigmas_by_source, strict=True)),
        "after": [
            {
                "distance_m": distance_m,
                "sigma_x_m": float(sigmas[0]),
                "sigma_y_m": float(sigmas[1]),
                "sigma_yaw_rad": float(sigmas[2]),
            }
            for distance_m, sigmas in uncertainty.sigmas.items()
        ],
        "nees": [_nees(check) for check in uncertainty.checks],
        "nees_by_own_poses": [_nees(check) for check in uncertainty.own_checks],
        "advice": advice(uncertainty, reference_name),
    }


def _nees(check: OpenLoopConsistency) -> dict[str, Any]:
    return {
        "distance_m": check.distance_m,
        "windows": check.windows,
        "independent": check.independent,
        "mean": check.mean,
        "expected": DEGREES,
        "bounds": check.bounds.tolist(),
        "covariance_is": verdict(check),
    }


FORMAT = 1  # of result.json


def result_table(result: RunResult) -> dict[str, Any]:
    """The content of result.json: plain values, units in the names."""
    return {
        "format": FORMAT,
        "program": f"terrain-odometry {version('terrain-odometry')}",
        "run": result.run.name,
        "robot": asdict(result.run.robot),
        "origin": stated_origin(result.run.settings.get("source")),
        "vision": result.watcher is not None,
        "terrain_source": result.source,
        "initial_terrain": result.initial_terrain,
        "effects": result.effects,
        "duration_s": float(result.replay.stamps_s[-1] - result.replay.stamps_s[0]),
        "wheel_travel_m": float(result.run.wheel_travel_m[-1]),
        "reference": result.reference_name or None,
        "reference_place_m": reference_place_m(result),
        "horizon_m": result.config.evaluation.horizon_m,
        "gyroscope": result.replay.has_gyroscope,
        "errors": error_tables(result),
        "off_at_the_end_m": result.off_at_the_end_m,
        "estimate_has_seen_reference": is_used_by_filter(result.reference_name),
        "remarks": result.remarks,
        "notes": run_notes(result),
        "withheld": _withheld(result),
        "odometer_uncertainty": uncertainty_table(result.uncertainty, result.reference_name),
        "switches": _switches(result),
        "missed_changes": _missed_changes(result),
        "unknown_in_force": [
            {"from_s": of.start_s, "to_s": of.end_s}
            for of in result.in_force
            if of.terrain == UNKNOWN
        ],
        "contradictions": contradiction_lines(result),
        "sightings": image_label_counts(result),
        "other_odometry": sorted(of.stem for of in result.run.folder.glob("other_odometry/*.csv")),
        "label_confusion": label_confusion_table(result),
        "like_training": _like_training(result),
        "filter": filter_table(result.replay),
        "learned": {name: dict(of.values) for name, of in result.learned.terrains.items()},
        "config": result.config.to_table(),
    }


def error_tables(result: RunResult) -> dict[str, dict[str, Any]]:
    """Errors by trajectory, and what each is against."""
    against = {name: of.against for name, of in result.evaluated.items()}
    return {
        name: {"against": against[name]} | score.to_table() for name, score in result.scores.items()
    }


def image_label_counts(result: RunResult) -> dict[str, int]:
    """How often each label, or each reason for none, was given."""
    counts: dict[str, int] = {}
    for image_label in result.watcher.image_labels if result.watcher else ():
        word = image_label.label or f"no label: {image_label.reason}"
        counts[word] = counts.get(word, 0) + 1
    return dict(sorted(counts.items()))


def _like_training(result: RunResult) -> dict[str, Any] | None:
    """Whether the images are similar to the training photographs; None where not known."""
    likeness = None if result.watcher is None else result.watcher.seen.likeness
    if likeness is None or not likeness.images:
        return None
    return asdict(likeness) | {"unlike": likeness.is_unlike}


def _withheld(result: RunResult) -> dict[str, Any] | None:
    """The poses of the evaluation of the estimate, where it used the others."""
    if result.second is None:
        return None
    withheld = result.second.withheld
    return {
        "poses": withheld.poses,
        "judged": len(withheld.judged),
        "every_s": JUDGED_EVERY_S,
        "silent_s": SILENT_S,
    }


def _switches(result: RunResult) -> list[dict[str, Any]]:
    return [
        {"terrain": change.terrain, "stamp_s": change.stamp_s}
        | _sight(change)
        | {"late_s": delay.late_s, "late_m": delay.late_m}
        for change, delay in zip(result.changes, switch_delays(result), strict=False)
    ]


def _sight(change: SwitchEvent | TerrainChange) -> dict[str, float | None]:
    """Stamp and distance of the first label of a switch; None without a camera."""
    if isinstance(change, TerrainChange):
        return dict.fromkeys(("seen_s", "distance_ahead_m", "waited_s", "waited_m"))
    return {
        "seen_s": change.first_label.stamp_s,
        "distance_ahead_m": change.first_label.distance_ahead_m,
        "waited_s": change.waited_s,
        "waited_m": change.waited_m,
    }


def _missed_changes(result: RunResult) -> list[dict[str, Any]]:
    """True changes of terrain that no switch answered."""
    missed = switch_delays(result)[len(result.changes) :]
    return [{"terrain": delay.terrain, "stamp_s": delay.true_s} for delay in missed]


def reference_columns(result: RunResult) -> dict[str, Any]:
    """Columns by name: t, x, y, yaw (whole turns counted) and wheel_travel; none without poses."""
    reference, run = result.reference, result.run
    if reference is None:
        return {}
    travel_m = np.interp(reference.stamps_s, run.odometry.stamps_s, run.wheel_travel_m)
    x, y, _ = reference.poses.T
    yaw = counted_reference_yaw(run, reference).yaw_rad
    return {"t": reference.stamps_s, "x": x, "y": y, "yaw": yaw, "wheel_travel": travel_m}


def reference_place_m(result: RunResult) -> list[float]:
    """Where the reference's poses are taken, x and y in the robot frame [m]."""
    lever_m = result.run.sensors.pose_m
    return list(lever_m[:2]) if result.reference_name == "pose" and lever_m else [0.0, 0.0]
