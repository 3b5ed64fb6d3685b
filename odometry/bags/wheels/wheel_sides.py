"""Which joints, or numbers of a message, are the left and the right wheels."""

from collections.abc import Mapping
from typing import Any

from odometry.bags.files.topic import Topic, moved
from odometry.bags.topics.message_fields import number_at, number_paths
from odometry.bags.topics.topic_guess import SIMPLE_ARRAY
from odometry.bags.topics.wheel_names import side_of, sided
from odometry.errors import BagError


def sides_of(
    topic: Topic, topic_map: Mapping[str, Any], joints: list[str] | None
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names of joints, or paths, of the left and of the right wheels.

    Raises
    ------
    BagError
        If what the user says is not there, or the sides cannot be determined.
    """
    if ("left" in topic_map) != ("right" in topic_map):
        raise BagError(f"{topic.name}: left and right wheels belong together; give both")
    array = SIMPLE_ARRAY.match(topic.message_type) is not None
    if "left" in topic_map:
        left, right = (tuple(map(str, topic_map[side])) for side in ("left", "right"))
        if array:
            left, right = (tuple(_in_array(one) for one in side) for side in (left, right))
        _check_there(topic, left + right, joints)
        if both := sorted(set(left) & set(right)):
            raise BagError(f"{topic.name}: {', '.join(both)} is said to be left and right")
    elif joints is not None:
        left, right = sided(joints)
    elif array:
        pair = len(topic.sample.data) == 2
        left, right = (("data[0]",), ("data[1]",)) if pair else ((), ())
    else:
        left, right = sided(path for path in number_paths(topic.sample) if side_of(path))
    if not left or not right:
        seen = joints if joints is not None else list(number_paths(topic.sample))
        raise BagError(
            f"{topic.name}: which are the wheels of the left and of the right side? Seen: "
            f"{', '.join(seen[:24])}. Give --left and --right, several separated by commas"
        )
    return left, right


def _in_array(place: str) -> str:
    return f"data[{place}]" if place.lstrip("-").isdigit() else place


def _check_there(topic: Topic, names: tuple[str, ...], joints: list[str] | None) -> None:
    for name in names:
        if joints is None:
            number_at(name)(topic.sample)
        elif name not in joints:
            raise BagError(f"{topic.name}: there is no joint {name!r}; found: {', '.join(joints)}")


def dead_joints(topic: Topic, sides: tuple[tuple[str, ...], ...], kind: str) -> list[str]:
    """Joints that never moved while others of their side did; `kind` as in `ranges`."""
    dead = []
    for side in sides:
        still = [name for name in side if not moved(topic.ranges, kind, name)]
        if len(still) < len(side):
            dead += still
    return dead
