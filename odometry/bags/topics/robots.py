"""Bags of several robots: which topics belong to the robot whose wheels are taken."""

import re
from collections.abc import Mapping
from typing import NamedTuple

from odometry.bags.files.topic import Topic
from odometry.bags.topics.odometry_kinds import UNKNOWN, kind_of_name
from odometry.bags.topics.topic_guess import GUESSED, guess

# What numbers robots of one name: husky1, husky_2, robot_a
NUMBER = re.compile(r"(?<=.)([_-]?\d+|[_-][a-z])$", re.IGNORECASE)
MOST_NAMED = 6  # topics in a sentence


class OwnTopics(NamedTuple):
    """What belongs to one robot of a bag.

    Attributes
    ----------
    topics : dict
        Without those of other robots; topics that name no robot are kept.
    robot : str
        The part of names that is this robot's; empty where there is one robot alone.
    notes : list of str
        What is to be said of it.
    """

    topics: dict[str, Topic]
    robot: str
    notes: list[str]


def own_topics(topics: Mapping[str, Topic], wheels: str) -> OwnTopics:
    """What belongs to the robot whose wheels these are.

    Parts of names are of robots where they differ in a number alone (husky1, husky2), or where
    both hold the same topic of wheels.
    """
    robot, others = _numbered(_parts(wheels)[:-1], topics)
    if not others:
        robot, others = _of_same_wheels(wheels, topics)
    kept = {
        name: topic
        for name, topic in topics.items()
        if robot in _parts(name) or not others & set(_parts(name))
    }
    left = [name for name in topics if name not in kept and guess(topics[name])]
    if not left:
        return OwnTopics(kept, robot if others else "", [])
    also = [name for name in left if any(one.role == "wheels" for one in guess(topics[name]))]
    how = f"; --wheels {also[0]} takes another" if also else ""
    more = ", ..." if len(left) > MOST_NAMED else ""
    note = (
        f"robots: by the names of topics there are {', '.join([robot, *sorted(others)])}; {robot} "
        f"is taken{how}. Left out: {', '.join(left[:MOST_NAMED])}{more}"
    )
    return OwnTopics(kept, robot, [note])


def _parts(name: str) -> list[str]:
    return name.strip("/").split("/")


def _may_be_robot(part: str) -> bool:
    """Whether a part of a name is not that of a sensor or a drive."""
    return kind_of_name(part) == UNKNOWN


def _numbered(namespace: list[str], topics: Mapping[str, Topic]) -> tuple[str, set[str]]:
    """The part of a namespace that has siblings which differ in a number alone, and these."""
    parts = {part for name in topics for part in _parts(name)}
    for robot in filter(_may_be_robot, namespace):
        stem = NUMBER.sub("", robot)
        if others := {part for part in parts if NUMBER.sub("", part) == stem} - {robot}:
            return robot, others
    return "", set()


def _of_same_wheels(wheels: str, topics: Mapping[str, Topic]) -> tuple[str, set[str]]:
    """The first part of a topic of wheels, and those of the same topics of other robots."""
    robot, *rest = _parts(wheels)
    if not rest or not _may_be_robot(robot):
        return "", set()
    others = {
        _parts(name)[0]
        for name, topic in topics.items()
        if _parts(name)[1:] == rest
        and _may_be_robot(_parts(name)[0])
        and topic.message_type == topics[wheels].message_type
        and any(one.role == "wheels" and one.rank <= GUESSED for one in guess(topic))
    }
    return robot, others - {robot}
