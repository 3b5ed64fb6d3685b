"""Interval of a share (Wilson 1927)."""

import math


def interval(good, count, z=1.959964):
    """Bounds of the 95 % interval of a share of `good` in `count`."""
    if count == 0:
        return 0.0, 1.0
    p, s = good / count, z * z / count
    middle = (p + s / 2) / (1 + s)
    half = math.sqrt(p * (1 - p) * s + s * s / 4) / (1 + s)
    return max(0.0, middle - half), min(1.0, middle + half)
