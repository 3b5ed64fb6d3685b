"""Quantities of a gap as text, and the share of the excess that effects close."""

from dataclasses import dataclass

import numpy as np

from odometry.digits import within_interval
from odometry.gap.answer.result import GapResult
from odometry.gap.config import GapConfig
from odometry.gap.prepare.statistic import MANY, SEED, Gap, drawn_gaps, squared_errors

WORDS = ((10.0, "very strong"), (6.0, "strong"), (2.0, "weak"), (0.0, "hardly any"))


@dataclass(frozen=True)
class Share:
    """Of the excess above the noise floor that is closed, with a 95 % interval; 1 is all.

    `pieces` is the number of held-out stretches; of one alone there is no interval.
    """

    value: float
    low: float
    high: float
    pieces: int


def held_out_share(result: GapResult, part_s: float = GapConfig.part_s) -> Share | None:
    """By drawing pieces of the held-out runs, and of the calibration; None without an excess.

    Before and after are paired where both are of the same windows. There is no excess where the gap
    before is not above the noise floor in 97.5 % of the draws.
    """
    held, kept = result.holdout_scenes, result.calibration.held_back
    base = result.calibration.base
    raw = result.holdout_before or held
    closing = result.closings[1]
    measure = closing.before.measure
    before = np.concatenate([squared_errors(base, (), scene, measure) for scene in raw])
    after = np.concatenate(
        [squared_errors(result.base, result.added, scene, measure) for scene in held]
    )
    floor = np.concatenate([squared_errors(own, (), scene, measure) for own, scene in kept])
    rng = np.random.default_rng(SEED)
    if raw is held:
        gaps = drawn_gaps((before, after), held, part_s, rng)
    else:
        gaps = np.concatenate(
            [drawn_gaps((of,), s, part_s, rng) for of, s in ((before, raw), (after, held))]
        )
    (floors,) = drawn_gaps((floor,), [scene for _, scene in kept], part_s, rng)
    floors *= closing.noise_floor.value / np.sqrt(floor.mean())  # as it is on these runs
    excess = gaps[0] - floors
    if closing.before.value <= closing.noise_floor.value:
        return None
    if np.quantile(excess, 0.025) <= 0:
        return None
    low, high = np.quantile((gaps[0] - gaps[1]) / excess, [0.025, 0.975])
    return Share(closing.share_closed, float(low), float(high), closing.before.pieces)


def metres(value: float) -> str:
    """A length of two figures."""
    return f"{value:.2g} m"


def of_two_figures(gap: Gap) -> str:
    """A gap without its interval."""
    return f"{gap.value:.2g} {gap.measure.unit}"


def with_interval(gap: Gap) -> str:
    """A gap and its 95 % interval, and from how many stretches that comes where they are few."""
    value, low, high = within_interval(gap.value, gap.low, gap.high)
    return f"{value} {gap.measure.unit} ({_interval(f'{low} to {high}', gap.pieces)})"


def percent(share: Share) -> str:
    """A share and its 95 % interval, as `with_interval` writes it."""
    interval = f"{100 * share.low:.0f} to {100 * share.high:.0f}"
    return f"{100 * share.value:.0f} % ({_interval(interval, share.pieces)})"


def evidence_words(evidence: float) -> str:
    """A word for twice a gain of log-likelihood.

    Kass and Raftery 1995, J. Am. Stat. Assoc. 90(430), p. 777.
    """
    return next((word for least, word in WORDS if evidence >= least), "none")


def _interval(words: str, pieces: int) -> str:
    if pieces < 2:
        return "no interval from one stretch"
    return words if pieces >= MANY else f"{words}, from only {pieces} stretches"
