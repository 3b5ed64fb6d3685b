"""Stamps as whole nanoseconds, which other programs count, and as seconds; each rounded once."""

from decimal import Decimal

NANOSECONDS = 10**9  # in a second


def seconds(word: str) -> float:
    """The float64 nearest to a whole number of nanoseconds; ValueError for any other word."""
    return int(word) / NANOSECONDS  # Python's division of integers rounds once


def nanoseconds(stamp_s: float) -> int:
    """The whole number of nanoseconds nearest to a stamp."""
    return int((Decimal(stamp_s) * NANOSECONDS).to_integral_value())
