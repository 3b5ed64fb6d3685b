"""Quantities of a gap as text: no more digits than their intervals allow."""

import math

from odometry.gap.share_closed import Share
from odometry.gap.statistic import MANY, Gap

WORDS = ((10.0, "very strong"), (6.0, "strong"), (2.0, "weak"), (0.0, "hardly any"))


def metres(value: float) -> str:
    """A length of two figures."""
    return f"{value:.2g} m"


def with_interval(gap: Gap) -> str:
    """A gap and its 95 % interval, and from how many stretches that comes where they are few."""
    value, low, high = rounded(gap.value, gap.low, gap.high)
    return f"{value} m ({_interval(f'{low} to {high}', gap.pieces)})"


def percent(share: Share) -> str:
    """A share and its 95 % interval, as `with_interval` writes it."""
    interval = f"{100 * share.low:.0f} to {100 * share.high:.0f}"
    return f"{100 * share.value:.0f} % ({_interval(interval, share.pieces)})"


def rounded(value: float, low: float, high: float) -> tuple[str, str, str]:
    """A value and the ends of its interval, to a tenth of half the interval's length.

    Three figures where the interval has no length.
    """
    half = (high - low) / 2
    if not (math.isfinite(half) and half > 0):
        return f"{value:.3g}", f"{low:.3g}", f"{high:.3g}"
    decimals = max(0, 1 - math.floor(math.log10(half)))
    return f"{value:.{decimals}f}", f"{low:.{decimals}f}", f"{high:.{decimals}f}"


def evidence_words(evidence: float) -> str:
    """A word for twice a gain of log-likelihood.

    Kass and Raftery 1995, J. Am. Stat. Assoc. 90(430), p. 777.
    """
    return next((word for least, word in WORDS if evidence >= least), "none")


def _interval(words: str, pieces: int) -> str:
    if pieces < 2:
        return "no interval from one stretch"
    return words if pieces >= MANY else f"{words}, from only {pieces} stretches"
