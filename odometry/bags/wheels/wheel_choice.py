"""Which topic the wheel speeds are taken from."""

from collections.abc import Iterator, Mapping
from typing import Any

from odometry.bags.files.topic import Topic
from odometry.bags.topics.message_fields import NO_WHEELS, TWISTS
from odometry.bags.topics.odometry_kinds import TRUTH, kind_of
from odometry.bags.topics.topic_guess import LIKELY, candidates, guess
from odometry.bags.topics.topic_roles import topic_named
from odometry.errors import BagError

NO_SPEEDS = (
    "the bag has no wheel speeds, which a run needs: only messages of poses, frames, images or "
    "inertial sensors. Record joint states or wheel odometry as well; poses alone can be added to "
    "a run that is there: terrain-odometry import RUN --pose FILE (TUM, KITTI, EuRoC)"
)


def wheel_topic(
    topics: Mapping[str, Topic], topic_map: Mapping[str, Any], reference: Mapping[str, Any]
) -> str:
    """Name of the topic of wheel speeds: said, else the likeliest one that is no reference.

    Raises
    ------
    BagError
        If none is likely, or the one that is said is not there.
    """
    if named := topic_map.get("topic"):
        return topic_named(topics, named).name
    said = str(reference.get("topic", "")).lstrip("/")
    left = {name: topic for name, topic in topics.items() if name.lstrip("/") != said}
    if found := candidates(left, "wheels"):
        return found[0]
    others = [f"{name} ({why})" for name, why in _other_odometry(topics)]
    near = [
        f"{name} ({topic.message_type}: {one.why})"
        for name, topic in left.items()
        if not _is_other(topic)
        for one in guess(topic)
        if one.rank >= LIKELY
    ]
    if not near and all(topic.message_type in NO_WHEELS for topic in topics.values()):
        raise BagError(NO_SPEEDS)
    seen = f"; perhaps one of {', '.join(near)}" if near else ""
    if others:
        seen += (
            ". Odometry of other sensors is there, but it shows no slip of the treads: "
            f"{', '.join(others)}. Record joint states or wheel odometry as well"
        )
    raise BagError(
        f"no topic is known to hold measured wheel speeds{seen}. Name it with --wheels TOPIC; "
        "--list shows all topics"
    )


def _is_other(topic: Topic) -> bool:
    """Whether a topic holds odometry, or a twist, that is not of the wheels."""
    there = topic.message_type in TWISTS and topic.sample is not None
    measured = there and all("command" not in one.why for one in guess(topic))
    return measured and not kind_of(topic).of_wheels


def _other_odometry(topics: Mapping[str, Topic]) -> Iterator[tuple[str, str]]:
    """Topics of odometry that is not of the wheels, and what they are."""
    for name, topic in topics.items():
        if _is_other(topic):
            kind = kind_of(topic)
            if kind.name == TRUTH:
                continue
            yield name, f"{kind.name} by {kind.sign}"
