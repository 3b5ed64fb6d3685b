"""The digits of a number that its uncertainty allows."""

import math


def within_interval(value: float, low: float, high: float) -> tuple[str, str, str]:
    """A value and the ends of its interval, to a tenth of half the interval's length.

    Three figures where the interval has no length.
    """
    half = (high - low) / 2
    if not (math.isfinite(half) and half > 0):
        return f"{value:.3g}", f"{low:.3g}", f"{high:.3g}"
    decimals = max(0, 1 - math.floor(math.log10(half)))
    return f"{value:.{decimals}f}", f"{low:.{decimals}f}", f"{high:.{decimals}f}"


def within_sigma(value: float, sigma: float) -> tuple[str, str]:
    """A value and its standard deviation, of which two digits are kept."""
    number, _, deviation = within_interval(value, -sigma, sigma)
    return number, deviation


def three_figures(value: float) -> str:
    """A number of three figures, zeros at its end as well: those of a column end alike."""
    return f"{value:#.3g}".rstrip(".")
