"""Rivals of a name that came as near in the same contest."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.commands.late_treads import ActuatorLag, CommandDelay
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import Judged, margin_of, penalty
from odometry.gap.fit.fitter import Fitter
from odometry.gap.fit.input_noise import noise_of_windows, scatter_of_noise
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.form_gates import farthest_off_s
from odometry.gap.prepare.statistic import sure_sum
from odometry.recording.sensors import gyroscope_of

LATE_TREADS = (ActuatorLag.name, CommandDelay.name)


def undecided(found: Explanation, fitter: Fitter, config: GapConfig) -> str:
    """Why the first name does not stand beside something unknown: others would, as well.

    What is unknown may be all of it, and these names what is like it.
    """
    first = next(step for step in found.steps if not isinstance(step.effect, Residual))
    rivals = found.contests.get(first.effect.name, ())
    best = next((one for one in rivals if one.effect.name == first.effect.name), first)
    near = sorted({one.effect.name for one in as_near(best, rivals, fitter, config)})
    if not near:
        return ""
    return f"{', '.join(near)} would explain as much, and something unknown is left beside each"


def as_near(
    best: Judged, rivals: Sequence[Judged], fitter: Fitter, config: GapConfig
) -> list[Judged]:
    """Rivals of another name that do not surely explain less than the best, in their order.

    What includes the best has to have as much evidence: it explains no less, with more freedom.
    Late stamps and late treads must be apart by more than a period of the gyroscope.
    """
    others = [
        one
        for one in rivals
        if one.effect.name != best.effect.name and one.gain > config.least_of_rival * best.gain
    ]
    if not others:
        return []
    own, *of_others = noise_of_windows([one.fitted for one in (best, *others)], fitter.measured)
    margin = margin_of(config, fitter.spread(best.fitted), best.gain)
    return [
        rival
        for rival, noise in zip(others, of_others, strict=True)
        if _is_part(rival, best, config)
        or (_are_one_period(rival, best, fitter) and rival.gain > config.mostly_closed * best.gain)
        or best.evidence - rival.evidence < config.equivalent_margin
        or (
            best.effect.name not in rival.effect.includes
            and _surely_lost(rival, best, noise - own, fitter, config) < margin
        )
    ]


def _is_part(rival: Judged, best: Judged, config: GapConfig) -> bool:
    included = rival.effect.name in best.effect.includes
    return included and rival.gain > config.mostly_closed * best.gain


def _are_one_period(one: Judged, other: Judged, fitter: Fitter) -> bool:
    """Whether these are late stamps and treads that act late, within a period of the gyroscope.

    It alone distinguishes them, and its rows are of their stamps, or means before or after.
    """
    by_name = {judged.effect.name: judged.fitted.effects[-1] for judged in (one, other)}
    scenes = fitter.measured.scenes
    if TimeOffset.name not in by_name or not by_name.keys() & {*LATE_TREADS}:
        return False
    gyroscopes = [gyroscope_of(scene.run.yaw_rate) for scene in scenes]
    periods_s = [float(np.median(np.diff(of.stamps_s))) for of in gyroscopes if of is not None]
    known = len(periods_s) == len(scenes) > 0
    return known and farthest_off_s(by_name[TimeOffset.name], scenes) <= max(periods_s)


def _surely_lost(
    rival: Judged, best: Judged, kept_out: FloatArray, fitter: Fitter, config: GapConfig
) -> float:
    """Evidence that a rival loses, at the lower bound, noise of the tread speeds apart.

    `kept_out` (K,) is the chi-squared of each window that this noise makes of the rival and not of
    the best, which explains nothing by it.
    """
    less = rival.fitted.held_out - best.fitted.held_out - kept_out
    scatter = scatter_of_noise(float(kept_out.sum()))
    paid = penalty(rival.fitted.freedom - best.fitted.freedom, best.fitted)
    moved = rival.fitted.base_moved - best.fitted.base_moved
    spread = max(1.0, fitter.spread(best.fitted))
    return (sure_sum(fitter.by_piece(less), config.trimmed) - scatter + moved) / spread + paid
