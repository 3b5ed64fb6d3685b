"""The content of result.json."""

from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import version
from math import isfinite
from typing import Any

from odometry.evaluation.withheld import JUDGED_EVERY_S, SILENT_S
from terrain.filter_summary import filter_table
from terrain.label_confusion import label_confusion_table
from terrain.reference_table import reference_place_m
from terrain.run_result import RunResult
from terrain.switch import SwitchEvent
from terrain.switch_delay import switch_delays
from terrain.terrain_change import TerrainChange
from terrain.uncertainty_table import uncertainty_table
from terrain.verdicts import remarks

FORMAT = 1  # of result.json


def result_table(result: RunResult) -> dict[str, Any]:
    """The content of result.json: plain values, units in the names."""
    return {
        "format": FORMAT,
        "program": f"terrain-odometry {version('terrain-odometry')}",
        "run": result.run.name,
        "robot": asdict(result.run.robot),
        "origin": _origin(result),
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
        "estimate_has_seen_reference": result.reference_name == "pose",
        "remarks": remarks(result.scores, result.off_at_the_end_m, result.replay.events),
        "withheld": _withheld(result),
        "odometer_uncertainty": uncertainty_table(result.uncertainty, result.reference_name),
        "switches": _switches(result),
        "missed_changes": _missed_changes(result),
        "sightings": sighting_counts(result),
        "other_odometry": sorted(of.stem for of in result.run.folder.glob("other_odometry/*.csv")),
        "label_confusion": label_confusion_table(result),
        "like_training": _like_training(result),
        "filter": filter_table(result.replay),
        "learned": {name: dict(of.values) for name, of in result.learned.terrains.items()},
        "config": result.config.to_table(),
    }


def _origin(result: RunResult) -> list[float] | None:
    """Latitude, longitude [deg] and height [m] of x = y = z = 0, where run.toml says them."""
    source = result.run.settings.get("source")
    origin = source.get("origin") if isinstance(source, Mapping) else None
    if isinstance(origin, Mapping):  # as `import` writes it
        origin = [origin.get(name) for name in ("latitude", "longitude", "altitude")]
    if not isinstance(origin, list) or len(origin) not in {2, 3}:
        return None
    if not all(type(number) in {int, float} and isfinite(number) for number in origin):
        return None
    return [float(number) for number in origin]


def error_tables(result: RunResult) -> dict[str, dict[str, Any]]:
    """Errors by trajectory, and what each is against."""
    against = {name: judged.against for name, judged in result.judged.items()}
    return {
        name: {"against": against[name]} | score.to_table() for name, score in result.scores.items()
    }


def sighting_counts(result: RunResult) -> dict[str, int]:
    """How often each label, or each reason for none, was given."""
    counts: dict[str, int] = {}
    for sighting in result.watcher.sightings if result.watcher else ():
        word = sighting.label or f"no label: {sighting.reason}"
        counts[word] = counts.get(word, 0) + 1
    return dict(sorted(counts.items()))


def _like_training(result: RunResult) -> dict[str, Any] | None:
    """Whether the images look like the training photographs; None where nothing can tell."""
    likeness = None if result.watcher is None else result.watcher.seen.likeness
    if likeness is None or not likeness.images:
        return None
    return asdict(likeness) | {"unlike": likeness.is_unlike}


def _withheld(result: RunResult) -> dict[str, Any] | None:
    """By which poses the estimate was judged, where it saw the others."""
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
    """What the camera saw of a switch; None where no camera told the terrain."""
    if isinstance(change, TerrainChange):
        return dict.fromkeys(("seen_s", "distance_ahead_m", "waited_s", "waited_m"))
    return {
        "seen_s": change.sight.stamp_s,
        "distance_ahead_m": change.sight.distance_ahead_m,
        "waited_s": change.waited_s,
        "waited_m": change.waited_m,
    }


def _missed_changes(result: RunResult) -> list[dict[str, Any]]:
    """True changes of terrain that no switch answered."""
    missed = switch_delays(result)[len(result.changes) :]
    return [{"terrain": delay.terrain, "stamp_s": delay.true_s} for delay in missed]
