"""Numbers in messages of any type, by paths such as drivers[0].measured_velocity."""

import re
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from odometry.errors import BagError

STEP = re.compile(r"([A-Za-z_]\w*)|\[(-?\d+)\]")
DEEPEST, LONGEST_ARRAY = 4, 16  # limits of the search for numbers


def number_paths(message: Any, prefix: str = "", depth: int = 0) -> Iterator[str]:
    """Paths of the numbers of a message, headers left out."""
    if isinstance(message, bool | str | bytes):
        return
    if isinstance(message, int | float | np.number):
        yield prefix
    elif isinstance(message, list | np.ndarray):
        if len(message) <= LONGEST_ARRAY:
            for place, one in enumerate(message):
                yield from number_paths(one, f"{prefix}[{place}]", depth)
    elif depth < DEEPEST:
        for name in getattr(message, "__dataclass_fields__", ()):
            if name not in ("header", "layout", "stamp", "__msgtype__"):
                inner = f"{prefix}.{name}" if prefix else name
                yield from number_paths(getattr(message, name), inner, depth + 1)


def number_at(path: str) -> Callable[[Any], float]:
    """A function that takes the number at a path out of a message.

    Raises
    ------
    BagError
        If the path is malformed; the function itself where a message has no number there.
    """
    steps = _steps(path)

    def read(message: Any) -> float:
        value = message
        try:
            for step in steps:
                value = value[step] if isinstance(step, int) else getattr(value, step)
            return float(value)
        except (AttributeError, IndexError, KeyError, TypeError, ValueError) as problem:
            raise BagError(f"no number at {path!r} of {type(message).__name__}") from problem

    return read


def _steps(path: str) -> list[str | int]:
    steps: list[str | int] = []
    position = 0
    while position < len(path):
        if steps and path[position] == ".":
            position += 1
        found = STEP.match(path, position)
        if found is None:
            break
        steps.append(found[1] or int(found[2]))
        position = found.end()
    if not steps or position < len(path):
        raise BagError(f"{path!r}: expected a path such as drivers[0].measured_velocity")
    return steps
