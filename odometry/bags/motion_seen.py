"""Which numbers of a topic ever change: velocities that are always zero are not measured."""

import math
from collections.abc import Iterator
from typing import Any

VELOCITY, PLACE = "velocity", "place"
MOVING_TYPES = ("sensor_msgs/msg/JointState", "nav_msgs/msg/Odometry")
Ranges = dict[tuple[str, str], tuple[float, float]]


def widen(ranges: Ranges, message: Any) -> None:
    """Widen the ranges of velocities and places by those of a joint state or an odometry."""
    for kind, name, value in _values(message):
        if math.isfinite(value):
            least, most = ranges.get((kind, name), (value, value))
            ranges[kind, name] = min(least, value), max(most, value)


def moved(ranges: Ranges, kind: str, name: str) -> bool:
    """Whether a place was ever another, or a velocity ever other than zero."""
    least, most = ranges.get((kind, name), (0.0, 0.0))
    return least != most or (kind == VELOCITY and least != 0)


def _values(message: Any) -> Iterator[tuple[str, str, float]]:
    if hasattr(message, "twist"):
        twist, place = message.twist.twist, message.pose.pose.position
        yield VELOCITY, "ahead", twist.linear.x
        yield VELOCITY, "turn", twist.angular.z
        yield PLACE, "x", place.x
        yield PLACE, "y", place.y
        return
    for name, value in zip(message.name, message.velocity, strict=False):
        yield VELOCITY, name, float(value)
    for name, value in zip(message.name, message.position, strict=False):
        yield PLACE, name, float(value)
