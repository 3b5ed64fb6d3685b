"""gap.json and the extended model as files."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from odometry.effects.catalogue import effect_table
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import lasting
from odometry.effects.interface.time_course import InBursts
from odometry.effects.measurement.map_fault import OfEachRun
from odometry.effects.measurement.reference_outliers import ReferenceOutliers
from odometry.effects.measurement.reference_rounding import RoundedPositions
from odometry.effects.measurement.reference_step import ReferenceStep
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.motion.terrain import SHIFTED, Terrain
from odometry.effects.unknown.residual_of_each_run import ResidualOfEachRun
from odometry.gap.answer.result import Closing, GapResult, NamedEffect
from odometry.gap.locate.locate import Region
from odometry.gap.prepare.statistic import Gap
from odometry.gap.show.words import moves_of
from odometry.io.files import atomic_write
from odometry.parameters import ParameterSet, TerrainParameters, write_parameters
from odometry.recording.run import UNKNOWN, UNNAMED_TERRAIN

FORMAT = 1  # of gap.json
# No part of the model of another run.
OF_ONE_RUN = (
    *(Terrain, ResidualOfEachRun, OfEachRun, ReferenceStep, ReferenceOutliers),
    RoundedPositions,
)
LEAST_LATENCY_S = 5e-3  # less is nothing that a model must know


def write_gap(result: GapResult, out: Path, about: Mapping[str, Any] | None = None) -> list[Path]:
    """Write gap.json and model.toml into a folder, which is made if it is missing.

    `about` says what made the result; its keys are added to gap.json.
    """
    content = {"format": FORMAT, **content_of(result), **(about or {})}
    with atomic_write(out / "gap.json") as part:
        part.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
    write_parameters(out / "model.toml", extended_model(result))
    return [out / "gap.json", out / "model.toml"]


def content_of(result: GapResult) -> dict[str, Any]:
    """What gap.json holds; a number that is not finite is null."""
    return {
        "verdict": result.verdict,
        "effects": [_effect(effect) for effect in result.effects],
        "equivalent": [
            {
                "name": one.name,
                "instead_of": one.instead_of,
                "told_apart_by": one.told_apart_by,
                "by_equation": one.by_equation,
            }
            for one in result.equivalent
        ],
        "where": [_region(region) for region in result.location.regions],
        "gap": _closing(result.measured, result.horizon_s),
        "holdout": _closing(result.holdout, result.horizon_s),
        "candidates": [
            {
                "name": rival.name,
                "form": rival.form,
                "course": rival.course,
                "evidence": _finite(rival.evidence),
                "gap_after": _finite(rival.gap_after),
            }
            for rival in result.rivals
        ],
        "notes": list(result.notes),
        "faults": [{"run": run, **finding.to_table()} for run, finding in result.faults],
        "depends_on": list(result.depends_on),
        "remedy": result.effects[0].added.effect.remedy if result.effects else "",
        "reference": any(one.added.effect.of_reference for one in result.effects),
        "reasons": [
            {"name": one.name, "form": one.form, "reason": one.reason} for one in result.refusals
        ],
        "base": [
            {
                "name": one.name,
                "calibrated": one.before,
                "value": one.after,
                "sigma": one.sigma,
                "sigmas": one.sigmas,
                "unit": one.unit,
            }
            for one in moves_of(result.calibration, result.base)
        ],
        "next_drives": [
            {"words": one.words, "between": list(one.between), "odds": one.odds}
            for one in result.next_drives
        ],
        "turns": None
        if result.turns is None
        else {
            name: _closing(closing, result.horizon_s)
            for name, closing in zip(("gap", "holdout"), result.turns, strict=True)
        },
    }


def extended_model(result: GapResult) -> ParameterSet:
    """The base and its effects as a parameter set, one table a terrain that any run names.

    Terrains whose ICRs and slip differ are tables of their own; all other effects stand in each,
    as they were at the end of their course: a moment of one run does not apply to the next, nor do
    coefficients or events that are each run's own.
    """
    effects = tuple(
        effect_table(lasting(added))
        for added in with_latency(result)
        if not isinstance(added.effect, OF_ONE_RUN) and added.effect.course != InBursts.name
    )
    words = " and ".join(added.effect.name for added in result.added) or "no effect"
    terrains = {}
    for label in _labels(result):
        base = result.base.on(label)
        model, values = base.model, base.values.copy()
        names = [parameter.name for parameter in model.parameters]
        for added in result.added:
            if isinstance(added.effect, Terrain) and label in added.effect.labels:
                shifts = added.values.reshape(-1, len(SHIFTED))
                values += shifts[added.effect.labels.index(label)]
        terrains[label] = TerrainParameters(
            model.name,
            dict(zip(names, values.tolist(), strict=True)),
            source=f"gap workflow of terrain-odometry: {words} added to {model.name}",
            effects=effects,
        )
    robot = result.base.robot
    named = {"name": robot.name} if robot.name else {}
    return ParameterSet(terrains, named | {"track_width": robot.track_width})


def with_latency(result: GapResult) -> tuple[Added, ...]:
    """All effects, the latency of the base among them: as, or in, an offset of time."""
    latency_s = result.base.latency_s
    if abs(latency_s) < LEAST_LATENCY_S:
        return result.added
    others = [one for one in result.added if not isinstance(one.effect, TimeOffset)]
    offsets_s = [one.values[0] for one in result.added if isinstance(one.effect, TimeOffset)]
    return (*others, Added(TimeOffset(), np.array([latency_s + sum(offsets_s)])))


def _labels(result: GapResult) -> list[str]:
    scenes = [scene for _, scene in result.calibration.held_back]
    scenes += [*result.measured_scenes, *result.holdout_scenes]
    seen: dict[str, None] = {}
    for scene in scenes:
        if scene.inputs.terrain is not None:
            seen.update(dict.fromkeys(np.unique(scene.inputs.terrain.astype(str)).tolist()))
    named = [label for label in seen if label not in (UNKNOWN, "")]
    return named or [UNNAMED_TERRAIN]


def _effect(effect: NamedEffect) -> dict[str, Any]:
    added = effect.added
    parameters = {
        parameter.name: {
            "value": float(value),
            "low": float(low),
            "high": float(high),
            "unit": parameter.unit,
        }
        for parameter, value, low, high in zip(
            added.effect.parameters, added.values, effect.low, effect.high, strict=True
        )
    }
    return {
        "name": added.effect.name,
        "form": " ".join(filter(None, (added.effect.form, added.effect.course))),
        **added.effect.settings(),
        "parameters": parameters,
        "gap_before": effect.gap_before,
        "gap_after": effect.gap_after,
        "evidence": effect.evidence,
    }


def _region(region: Region) -> dict[str, Any]:
    return {
        "words": region.words,
        "bounds": {name: list(ends) for name, ends in region.bounds.items()},
        "excess": region.excess_m,
        "share": region.share,
    }


def _closing(closing: Closing, horizon_s: float) -> dict[str, Any]:
    measure = closing.before.measure
    return {
        "before": closing.before.value,
        "after": closing.after.value,
        "noise_floor": closing.noise_floor.value,
        "before_interval": _ends(closing.before),
        "after_interval": _ends(closing.after),
        "stretches": closing.before.pieces,
        "share_closed": _finite(closing.share_closed),
        "unit": f"{measure.unit}, RMS {measure.error} over {horizon_s:g} s windows",
    }


def _ends(gap: Gap) -> list[float] | None:
    """A 95 % interval, None where there is one stretch."""
    return [gap.low, gap.high] if gap.has_interval else None


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
