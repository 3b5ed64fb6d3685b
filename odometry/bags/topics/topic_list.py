"""The topics of bags as lines of text, with what each is probably used for."""

from collections.abc import Iterator

from odometry.bags.files.topic import Topic
from odometry.bags.topics.message_fields import TRANSFORM_LISTS
from odometry.bags.topics.robot_messages import TEXT
from odometry.bags.topics.robots import own_topics
from odometry.bags.topics.survey import Survey
from odometry.bags.topics.topic_guess import best, guess

ROLES = ("wheels", "imu", "reference", "images")


def topic_lines(survey: Survey) -> Iterator[str]:
    """A line a topic; an asterisk marks what an import takes by itself."""
    wheels = best(survey.topics, "wheels")
    topics = own_topics(survey.topics, wheels).topics if wheels else survey.topics
    taken = {best(topics, role) for role in ROLES}
    rows = [
        (
            "*" if name in taken else "",
            name,
            topic.message_type,
            str(topic.count),
            f"{topic.rate_hz:.4g} Hz",
            f"{topic.duration_s:.1f} s",
            said_of(topic),
        )
        for name, topic in survey.topics.items()
    ]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        yield "  ".join(cells).rstrip()


def said_of(topic: Topic) -> str:
    """What a topic is probably used for, or why it cannot be read."""
    if topic.problem:
        return f"cannot be read: {topic.problem}"
    if topic.message_type in TRANSFORM_LISTS:
        return "frames of the robot"
    if topic.message_type == TEXT and "<robot" in topic.sample.data:
        return "robot description"
    guesses = sorted(guess(topic), key=lambda one: one.rank)
    return "; ".join(": ".join(filter(None, (one.role, one.why))) for one in guesses)
