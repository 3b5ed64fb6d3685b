"""Counts the messages of a topic, and decodes some of them."""

from statistics import median
from types import SimpleNamespace
from typing import Any

from odometry.bags.connection import Connection, Message
from odometry.bags.errors import BagError
from odometry.bags.message_kinds import IMAGES, JOINTS
from odometry.bags.message_types import MessageTypes
from odometry.bags.motion_seen import MOVING_TYPES, Ranges, widen
from odometry.bags.robot_seen import ROBOT_TYPES, RobotSeen
from odometry.bags.sides import sided
from odometry.bags.topic import Topic, header_ns

FIRST_LOOKS, EVERY = 200, 20  # of topics that tell motion: all of the first, then each 20th


class Tally:
    """Counts the messages of a topic, and decodes some of them."""

    def __init__(self, connection: Connection) -> None:
        self.connection = connection
        self.count, self.first_ns, self.last_ns = 0, 2**63, -1
        self.sample: Any = None
        self.offsets_s: list[float] = []
        self.ranges: Ranges = {}
        self.problem = ""
        self._of_robot = connection.message_type in ROBOT_TYPES
        self.tells_motion = connection.message_type in MOVING_TYPES

    def add(self, message: Message, types: MessageTypes, robot: RobotSeen) -> None:
        """Take in a message; what it says of the robot goes to `robot`."""
        self.count += 1
        self.first_ns = min(self.first_ns, message.received_ns)
        self.last_ns = max(self.last_ns, message.received_ns)
        of_robot = self._of_robot and robot.wants(message)
        if not (of_robot or self._looks()):
            return
        try:
            content = types.decode(message)
        except BagError as problem:
            self.problem = str(problem)
            return
        if of_robot:
            robot.look(message, content)
        if self.tells_motion:
            widen(self.ranges, content)
        stamp_ns = header_ns(content)
        if stamp_ns:
            self.offsets_s.append((stamp_ns - message.received_ns) / 1e9)
        if self.sample is None or self._tells_more(content):
            image = self.connection.message_type in IMAGES
            self.sample = _without_pixels(content) if image else content

    def _looks(self) -> bool:
        """The first messages, then ever fewer; of those that tell motion a fixed share."""
        if self.tells_motion:
            return self.count <= FIRST_LOOKS or self.count % EVERY == 0
        return self.count <= 2 or self.count & (self.count - 1) == 0

    def _tells_more(self, content: Any) -> bool:
        """Whether joints are wheels where those of the sample, of another publisher, are none."""
        joints = self.connection.message_type == JOINTS
        return joints and not sided(self.sample.name)[0] and bool(sided(content.name)[0])

    def topic(self) -> Topic:
        """What was seen of the topic."""
        return Topic(
            self.connection.topic,
            self.connection.message_type,
            self.count,
            self.first_ns,
            self.last_ns,
            self.sample,
            median(self.offsets_s) if self.offsets_s else None,
            self.ranges,
            self.problem if self.sample is None else "",
        )


def _without_pixels(content: Any) -> Any:
    kept = ("header", "height", "width", "encoding", "format")
    return SimpleNamespace(**{key: getattr(content, key) for key in kept if hasattr(content, key)})
