"""What is said of topics that were guessed: by which sign, and which others fit as well."""

from collections.abc import Iterator, Mapping
from typing import Any

from odometry.bags.files.topic import Topic
from odometry.bags.rows.pose_rows import turns
from odometry.bags.topics.message_fields import FIX, ODOMETRY, POSES, TWISTS
from odometry.bags.topics.odometry_kinds import SATELLITES, TRUTH, UNKNOWN, kind_of, no_wheels_move
from odometry.bags.topics.robot_messages import RobotMessages
from odometry.bags.topics.topic_guess import COMMANDS, candidates
from odometry.bags.topics.topic_roles import TopicMap

MOST_NAMED = 6  # topics in a sentence


def wheel_notes(topics: Mapping[str, Topic], topic_map: Mapping[str, Any], taken: str) -> list[str]:
    """What is to be said of the topic that was taken as wheel speeds."""
    topic = topics[taken]
    commands = _commands(taken)
    if topic.message_type not in TWISTS:
        return commands
    return [*commands, *_separation(taken, topic_map), *_kind_notes(topic, topic_map)]


def _commands(taken: str) -> list[str]:
    """That wheel speeds are those that were asked for."""
    if not COMMANDS.search(taken):
        return []
    return [
        f"wheel speeds: {taken} holds commands by its name: the robot follows them later, on a "
        "slope or under load not in full, and in an emergency stop not at all. All of this is "
        "taken for slip and for the robot; name measured speeds where the bag has any"
    ]


def _separation(taken: str, topic_map: Mapping[str, Any]) -> list[str]:
    """By which number turns of a twist become tread speeds."""
    if "separation" in topic_map:
        return []
    return [
        f"wheel speeds: {taken}: separation is taken to be the track width. Controllers often "
        "multiply it (wheel_separation_multiplier): then speeds of the sides, and with them all "
        "ICRs, are wrong by that factor; give separation, multiplied, in [wheels] of a map"
    ]


def _kind_notes(topic: Topic, topic_map: Mapping[str, Any]) -> list[str]:
    taken, kind = topic.name, kind_of(topic)
    if not kind.of_wheels:
        return [
            f"wheel speeds: {taken} looks like {kind.name} by {kind.sign}, which shows no slip of "
            "the treads; it is taken as it was named"
        ]
    if kind.name == UNKNOWN and "topic" not in topic_map:
        return [
            f"wheel speeds: that {taken} is of the wheels is a guess: nothing in its name says so. "
            "If it is not (a camera, a lidar or a filter made it), name the right one with --wheels"
        ]
    if moves := no_wheels_move(topic):
        return [
            f"wheel speeds: {taken} is no plain wheel odometry by {moves}: its twist may be that "
            "of the world's axes, or of a filter. Check it, or name another with --wheels"
        ]
    return []


def reference_notes(
    topics: Mapping[str, Topic], topic_map: Mapping[str, Any], taken: str
) -> list[str]:
    """What is to be said of poses that are the reference."""
    if not taken:
        return []
    return [*_without_yaw(topics[taken]), *_drifts(topics, topic_map, taken)]


def _without_yaw(topic: Topic) -> list[str]:
    if topic.message_type not in POSES or turns(topic):
        return []
    return [
        f"reference: {topic.name}: its orientation never changes, as one that is not filled in: "
        "yaw is left empty, positions alone are used"
    ]


def _drifts(topics: Mapping[str, Topic], topic_map: Mapping[str, Any], taken: str) -> list[str]:
    if "topic" in topic_map or topics[taken].message_type != ODOMETRY:
        return []
    kind = kind_of(topics[taken])
    if kind.name == TRUTH:
        return []
    drift = "" if kind.name == SATELLITES else ", which may drift over a long drive"
    fixes = [name for name, topic in topics.items() if topic.message_type == FIX]
    how = f"--reference {fixes[0]} takes the fixes" if fixes else "--reference none leaves it out"
    return [f"reference: {taken} is {kind.name} by {kind.sign}{drift}; {how}"]


def restated_frames(robot: RobotMessages, named: Mapping[str, str]) -> list[str]:
    """That static transforms state the way to a frame twice, otherwise; `named` by topic."""
    return [
        f"warning: {topic}: static transforms state the frame {frame} twice, {change}: the last is "
        "taken. Which is right? If the first, correct [sensors] and [camera] of run.toml"
        for topic, of in named.items()
        for frame, change in robot.restated.items()
        if frame in robot.fixed.above(of)
    ]


def equal_topics(
    topics: Mapping[str, Topic], topic_map: TopicMap, taken: Mapping[str, str]
) -> Iterator[str]:
    """That other topics fit as well as those that were guessed; `taken` is by role."""
    for role, name in taken.items():
        equal = candidates(topics, role)
        others = [other for other in equal if other != name]
        if not others or name not in equal or "topic" in getattr(topic_map, role):
            continue
        more = ", ..." if len(others) > MOST_NAMED else ""
        yield (
            f"{role}: {', '.join(others[:MOST_NAMED])}{more} would fit as well as {name}; "
            f"--{role} {others[0]} takes that one"
        )
