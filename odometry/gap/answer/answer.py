"""The answer: the verdict, effects with their intervals, and drives that distinguish rivals."""

from collections.abc import Sequence

import numpy as np

from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.reference_step import ReferenceStep
from odometry.effects.unknown.residual import Residual
from odometry.gap.answer.next_drives import NextDrive, next_drives
from odometry.gap.answer.result import Closing, Equivalent, NamedEffect, Rival
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import Judged
from odometry.gap.fit.fitter import Fitter
from odometry.gap.fit.own_moments import SPACING_S
from odometry.gap.name.explanation import Explanation
from odometry.gap.prepare.outliers import Outliers
from odometry.gap.prepare.statistic import Gap

WITHIN_95 = 1.96  # standard deviations
MOMENT_KNOWN_S = SPACING_S  # the moment of a run held out is known as well as it was searched


def verdict_of(found: Explanation, held_out: Closing) -> str:
    """The first name; else "none" where noise explains what the base leaves, also held out.

    Where an effect had evidence and was refused, the gap itself must be within the floor's
    interval for "none"; else its interval alone must reach into it.
    """
    if found.names:
        return found.names[0]
    before, floor = held_out.before, held_out.noise_floor
    least = before.value if found.refusals else before.low
    return "unknown" if found.unexplained or least > floor.high else "none"


def named_effects(
    found: Explanation, effects: Sequence[Added], before_m: float
) -> tuple[NamedEffect, ...]:
    """Effects with intervals of 95 %, and the gap [m] on the measured runs before and after each.

    `effects` are as on runs held out, which may have moments of their own behind the values.
    """
    fit = found.fitted
    sigmas = np.sqrt(np.maximum(np.diag(fit.covariance), 0.0))
    named, place, gap_m = [], 0, before_m
    for step, own, added in zip(found.steps, fit.effects, effects, strict=True):
        spread = WITHIN_95 * sigmas[place : place + len(own.values)]
        more = len(added.values) - len(own.values)
        likely = spread if isinstance(own.effect, Residual) else [MOMENT_KNOWN_S]
        if isinstance(own.effect, ReferenceStep):
            likely = [spread[0], MOMENT_KNOWN_S]
        spread = np.append(spread, np.resize(likely, more))
        place += len(own.values)
        lows, highs = np.array([(p.low, p.high) for p in added.effect.parameters]).T
        named.append(
            NamedEffect(
                added,
                np.maximum(added.values - spread, lows),
                np.minimum(added.values + spread, highs),
                gap_m,
                step.gap_after,
                step.evidence,
            )
        )
        gap_m = step.gap_after
    return tuple(named)


def named_outliers(outliers: Outliers, before_m: float, after_m: float) -> NamedEffect:
    """Poses that were left out, with the gap [m] on the measured runs before and after."""
    return NamedEffect(
        outliers.named, outliers.low, outliers.high, before_m, after_m, outliers.evidence
    )


def are_explained(outliers: NamedEffect, config: GapConfig) -> bool:
    """Whether poses that were left out are hardly off beside what has a name by now.

    An antenna that sways far is no jump. Where they are, windows that end at them alone make the
    square of the gap larger by their share times the square of their distance.
    """
    share, distance_m = outliers.added.values
    more = outliers.gap_before**2 - outliers.gap_after**2
    return bool(more < config.still_off * share * distance_m**2)


def is_first(held_out: Closing, without: Gap, config: GapConfig) -> bool:
    """Whether poses that were left out are the main part of what an answer closes on held-out data.

    `without` is the gap without these poses, and before anything else is added.
    """
    closed_m = held_out.before.value - held_out.after.value
    return held_out.before.value - without.value >= config.least_of_rest * closed_m


def leaves_most(held_out: Closing, config: GapConfig) -> bool:
    """Whether most of the excess on held-out data stays, surely above the noise floor."""
    surely = held_out.after.low > held_out.noise_floor.high
    return surely and held_out.share_closed < config.least_of_rest


def drives_apart(
    found: Explanation,
    candidates: Sequence[Judged],
    equivalent: Sequence[Equivalent],
    fitter: Fitter,
    config: GapConfig,
) -> tuple[NextDrive, ...]:
    """Drives that distinguish the first effect, in its form, from those that came as near.

    Of each name it is the form of most evidence: on one heading, some have been no candidates.
    What is as near as a later effect is no rival of the first.
    """
    fits = {one.effect.name: one.fitted for one in sorted(candidates, key=_evidence)}
    names = [
        one.name
        for one in equivalent
        if not one.by_equation and one.instead_of not in found.names[1:]
    ]
    rivals = {name: fits[name] for name in names if name in fits}
    if not rivals or not found.names or found.names[0] not in fits:
        return ()
    of_form = {one.effect.key: one.fitted for one in found.first}
    first = {found.names[0]: of_form.get(found.effects[0].key, found.steps[0].fitted)}
    return next_drives({**first, **rivals}, fitter.measured.scenes, fitter.calibration, config)


def _evidence(one: Judged) -> float:
    return one.evidence


def rivals_of(found: Explanation) -> tuple[Rival, ...]:
    """The candidates for the first effect, most evidence first, with the one that was added.

    Of several that read the same (other constants, other numbers of contacts) it is the best one.
    """
    added = [step for step in found.steps[:1] if not isinstance(step.effect, Residual)]
    added_key = added[0].effect.key if added else None
    first = [one for one in found.first if one.effect.key != added_key]
    best: dict[tuple[str, str], Rival] = {}
    for one in sorted([*added, *first], key=_evidence, reverse=True):
        effect = one.effect
        rival = Rival(
            effect.name,
            effect.form,
            one.evidence,
            one.gap_after,
            effect.course,
            added=effect.key == added_key,
        )
        best.setdefault((rival.name, rival.form_in_words), rival)
    return tuple(best.values())
