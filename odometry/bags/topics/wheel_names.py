"""Names of wheels, their sides of the robot, and units of their speeds."""

import math
import re
from collections.abc import Iterable, Mapping
from typing import Any

from odometry.errors import BagError

WHEEL = re.compile(r"wheel|track|tread|tyre|tire|drive|motor|sprocket|whl", re.IGNORECASE)
NO_WHEEL = re.compile(
    r"steer|caster|castor|arm|gripper|finger|flipper|head|shoulder|elbow|wrist|suspension|rocker",
    re.IGNORECASE,
)
SHORT = {
    "left": {"l", "fl", "rl", "bl", "ml", "lf", "lr", "lb", "lm", "lh"},
    "right": {"r", "fr", "rr", "br", "mr", "rf", "rb", "rm", "rh"},
}
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


def is_wheel(name: str) -> bool:
    """Whether a joint or field of this name may be a driven wheel."""
    return bool(WHEEL.search(name)) and not NO_WHEEL.search(name)


def side_of(name: str) -> str:
    """Side in a name: "left", "right", or empty where it names none or both."""
    low = name.lower()
    if ("left" in low) != ("right" in low):
        return "left" if "left" in low else "right"
    if "left" in low:
        return ""
    words = set(re.findall(r"[a-z]+", re.sub(r"([a-z])([A-Z])", r"\1 \2", name).lower()))
    sides = [side for side, short in SHORT.items() if words & short]
    return sides[0] if len(sides) == 1 else ""


def sided(names: Iterable[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names of the left and of the right wheels among names; both empty where that is unclear."""
    names = list(names)
    wheels = [name for name in names if is_wheel(name)] or names
    left = tuple(name for name in wheels if side_of(name) == "left")
    right = tuple(name for name in wheels if side_of(name) == "right")
    return (left, right) if len(left) == len(right) else ((), ())


def check_unit(unit: str) -> None:
    """Raise BagError unless a unit is one of UNITS."""
    if unit not in UNITS:
        raise BagError(f"unit {unit!r}, expected one of {', '.join(UNITS)}")


def gear_of(topic_map: Mapping[str, Any]) -> float:
    """Turns that are counted for one of a wheel, as [wheels] of a map says."""
    gear = float(topic_map.get("gear", 1.0))
    if not 1e-6 <= abs(gear) <= 1e6:
        raise BagError(f"gear = {gear!r}, expected the turns that are counted for one of a wheel")
    return gear
