"""Which topic has which role: as the user says, else as it is guessed."""

from collections.abc import Mapping
from typing import Any

from odometry.bags.message_kinds import CAMERA_INFO, POSES
from odometry.bags.topic import Topic
from odometry.bags.topic_guess import best, guess
from odometry.bags.topic_map import NONE
from odometry.errors import BagError

SAME_CLOCK_S = 2.0  # header stamps and times of reception that differ by less share a clock


def topic_for(
    topics: Mapping[str, Topic], topic_map: Mapping[str, Any], role: str, kinds: tuple[str, ...]
) -> str:
    """Name of the topic for a role; empty where there is none, or none is wanted."""
    said = topic_map.get("topic")
    if said is None:
        return best(topics, role) or ""
    if said == NONE:
        return ""
    topic = topic_named(topics, said)
    if topic.message_type not in kinds:
        raise BagError(
            f"{said}: {topic.message_type} cannot be used as {role}; expected {', '.join(kinds)}"
        )
    if topic.sample is None:
        raise BagError(f"{said}: no message of it can be read: {topic.problem}")
    return topic.name


def topic_named(topics: Mapping[str, Topic], name: str) -> Topic:
    """The topic of a name, with or without its first slash; BagError where there is none."""
    found = topics.get(name) or topics.get(f"/{name}")
    if found is None:
        raise BagError(f"there is no topic {name!r} in the bag; topics: {', '.join(topics)}")
    return found


def camera_info_of(topics: Mapping[str, Topic], topic_map: Mapping[str, Any], images: str) -> str:
    """The CameraInfo that goes with an image topic: said, else the one of the same folder."""
    if not images:
        return ""
    said = topic_map.get("camera_info")
    if said == NONE:
        return ""
    if said is not None:
        return topic_named(topics, said).name
    folder = images.rsplit("/", 1)[0]
    while folder:
        name = f"{folder}/camera_info"
        if name in topics and topics[name].message_type == CAMERA_INFO:
            return name
        folder = folder.rsplit("/", 1)[0]
    return ""


def other_odometry_of(
    topics: Mapping[str, Topic], said: tuple[str, ...] | None, reference: str
) -> tuple[str, ...]:
    """Topics whose poses are kept beside the run."""
    if said is not None:
        names = [topic_named(topics, name) for name in said]
        wrong = [topic.name for topic in names if topic.message_type not in POSES]
        if wrong:
            raise BagError(f"{wrong[0]}: there are no poses in it to keep as other odometry")
        return tuple(topic.name for topic in names)
    return tuple(
        name
        for name, topic in topics.items()
        if name != reference and any(one.role == "other_odometry" for one in guess(topic))
    )


def clock_of(used: list[Topic], requested: str) -> tuple[bool, list[str]]:
    """Whether header stamps are taken, and what is to be said of it."""
    if requested != "auto":
        return requested == "header", []
    offsets = [one.header_offset_s for one in used if one.header_offset_s is not None]
    if not offsets:
        return False, []
    unstamped = [one.name for one in used if one.header_offset_s is None]
    spread = max([*offsets, *(0.0 for _ in unstamped)]) - min([*offsets, *(0.0 for _ in unstamped)])
    if spread <= SAME_CLOCK_S:
        return True, []
    return False, [
        f"times: those of reception, as the clocks of header stamps differ by {spread:.3g} s "
        "(--time header takes the stamps all the same)"
    ]
