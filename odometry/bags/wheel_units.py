"""Units of wheel speeds, and gears."""

import math
from collections.abc import Mapping
from typing import Any

from odometry.bags.errors import BagError

# Unit: (what one is in radians or metres, whether it is of the wheel's angle, whether a speed)
UNITS: dict[str, tuple[float, bool, bool]] = {
    "rad/s": (1.0, True, True),
    "deg/s": (math.pi / 180, True, True),
    "rpm": (2 * math.pi / 60, True, True),
    "turns/s": (2 * math.pi, True, True),
    "m/s": (1.0, False, True),
    "mm/s": (1e-3, False, True),
    "rad": (1.0, True, False),
    "deg": (math.pi / 180, True, False),
    "turns": (2 * math.pi, True, False),
    "m": (1.0, False, False),
}


def check_unit(unit: str) -> None:
    """Raise BagError unless a unit is one of UNITS."""
    if unit not in UNITS:
        raise BagError(f"unit {unit!r}, expected one of {', '.join(UNITS)}")


def gear_of(wishes: Mapping[str, Any]) -> float:
    """Turns that are counted for one of a wheel, as [wheels] of a map says."""
    gear = float(wishes.get("gear", 1.0))
    if not 1e-6 <= abs(gear) <= 1e6:
        raise BagError(f"gear = {gear!r}, expected the turns that are counted for one of a wheel")
    return gear
