"""Which names mean a wheel, and on which side it stands."""

import re
from collections.abc import Iterable

WHEEL = re.compile(r"wheel|track|tread|tyre|tire|drive|motor|sprocket|whl", re.IGNORECASE)
NO_WHEEL = re.compile(
    r"steer|caster|castor|arm|gripper|finger|flipper|head|shoulder|elbow|wrist|suspension|rocker",
    re.IGNORECASE,
)
SHORT = {
    "left": {"l", "fl", "rl", "bl", "ml", "lf", "lr", "lb", "lm", "lh"},
    "right": {"r", "fr", "rr", "br", "mr", "rf", "rb", "rm", "rh"},
}


def is_wheel(name: str) -> bool:
    """Whether a joint or field of this name may be a driven wheel."""
    return bool(WHEEL.search(name)) and not NO_WHEEL.search(name)


def side_of(name: str) -> str:
    """Side that a name speaks of: "left", "right", or empty where it speaks of none or both."""
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
