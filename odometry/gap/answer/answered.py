"""The result of a search: what the names close on measured and held-out data, and their rivals."""

from collections.abc import Sequence
from dataclasses import dataclass

from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.reference_outliers import ReferenceOutliers
from odometry.gap.answer.answer import (
    are_explained,
    drives_apart,
    is_first,
    leaves_most,
    named_effects,
    named_outliers,
    rivals_of,
    verdict_of,
)
from odometry.gap.answer.equivalent import equivalents, rivals_of_one_heading
from odometry.gap.answer.named_rounding import named_rounding
from odometry.gap.answer.new_places import terrain_instead
from odometry.gap.answer.result import Closing, GapResult, NamedEffect
from odometry.gap.fit.fitter import Fitter
from odometry.gap.fit.own_moments import with_own_moments
from odometry.gap.locate.locate import locate
from odometry.gap.name.explanation import Explanation
from odometry.gap.prepare.held_out import Apart
from odometry.gap.prepare.outliers import Outliers
from odometry.gap.prepare.prepared import Prepared
from odometry.gap.prepare.statistic import Measure, floor_there, gap_m, gap_of


@dataclass(frozen=True)
class _Closed:
    """The answer's model, and what it closes on measured and on held-out data.

    `shown` is by the measure that shows the gap, `closings` by positions.
    """

    base: Base
    effects: Sequence[Added]
    scenes: Apart
    measure: Measure
    closings: tuple[Closing, Closing]
    shown: tuple[Closing, Closing]


def answered(ready: Prepared, fitter: Fitter, found: Explanation, measure: Measure) -> GapResult:
    """The result where a search by one measure found an explanation."""
    config = ready.config
    closed = _closed(ready, found, measure)
    named = _named(ready, found, closed)
    verdict = _verdict(ready, found, closed, named)
    fitted, held_out = closed.scenes
    more = rivals_of_one_heading(found, fitter, config)
    equivalent = () if verdict == "none" else equivalents(found, more, fitter, config)
    equivalent = (*equivalent, *terrain_instead(found.fitted.effects, equivalent, fitted))
    return GapResult(
        verdict=verdict,
        effects=named,
        equivalent=equivalent,
        location=locate(
            ready.known.base, (), fitted, ready.floor().value, config, calibration=ready.known
        ),
        measured=closed.closings[0],
        holdout=closed.closings[1],
        turns=closed.shown if measure is not Measure.POSITION else None,
        rivals=rivals_of(found),
        calibration=ready.known,
        base=closed.base,
        measured_scenes=tuple(fitted),
        holdout_scenes=tuple(held_out),
        horizon_s=config.horizon_s,
        notes=ready.notes,
        next_drives=drives_apart(found, (*found.first, *more), equivalent, fitter, config),
        refusals=found.refusals,
        holdout_before=() if ready.outliers is None else tuple(ready.raw_scenes[1]),
    )


def _closed(ready: Prepared, found: Explanation, measure: Measure) -> _Closed:
    fit, known, (fitted, held_out) = found.fitted, ready.known, ready.scenes
    base = fit.base if found.steps or found.base_closes else known.base
    effects, held_out = with_own_moments(base, fit.effects, held_out, fitted, known)
    scenes = fitted, held_out
    befores = scenes if ready.outliers is None else ready.raw_scenes

    def by(measure: Measure) -> tuple[Closing, Closing]:
        """Of windows before and after, measured and held out."""
        part_s = ready.config.part_s
        floor = ready.floor(measure)
        of_fitted, of_held_out = (
            Closing(
                gap_of(known.base, (), before, part_s, measure),
                gap_of(base, effects, after, part_s, measure),
                floor_there(floor, known, after, ready.config),
            )
            for before, after in zip(befores, scenes, strict=True)
        )
        return of_fitted, of_held_out

    return _Closed(base, effects, scenes, measure, by(Measure.POSITION), by(measure))


def _named(ready: Prepared, found: Explanation, closed: _Closed) -> tuple[NamedEffect, ...]:
    """Effects, poses that were left out and rounded positions, the main part first."""
    known, (fitted, held_out) = ready.known, closed.scenes
    named = named_effects(found, closed.effects, gap_m(known.base, (), fitted))
    if ready.outliers is not None:
        named = _with_outliers(ready, ready.outliers, closed, named)
    rounding = named_rounding(fitted, held_out, known, ready.floor(), ready.config)
    if rounding is None:
        return named
    return (rounding, *named) if closed.measure is Measure.POSITION else (*named, rounding)


def _with_outliers(
    ready: Prepared, outliers: Outliers, closed: _Closed, named: tuple[NamedEffect, ...]
) -> tuple[NamedEffect, ...]:
    known, (fitted, held_out), config = ready.known, closed.scenes, ready.config
    alone = gap_of(known.base, (), held_out, config.part_s, closed.measure)
    on_measured = closed.closings[0]
    if is_first(closed.shown[1], alone, config):
        believed_m = gap_m(known.base, (), fitted)
        return (named_outliers(outliers, on_measured.before.value, believed_m), *named)
    raw_m, after_m = (
        gap_m(closed.base, closed.effects, ready.raw_scenes[0]),
        on_measured.after.value,
    )
    beside = named_outliers(outliers, raw_m, after_m)
    return named if named and are_explained(beside, config) else (*named, beside)


def _verdict(
    ready: Prepared, found: Explanation, closed: _Closed, named: tuple[NamedEffect, ...]
) -> str:
    """The first name, unless it is of poses that were left out alone and most of the gap stays."""
    if not named:
        return verdict_of(found, closed.shown[1])
    alone = len(named) == 1 and isinstance(named[0].added.effect, ReferenceOutliers)
    if alone and leaves_most(closed.shown[1], ready.config):
        return "unknown"
    return named[0].added.effect.name
