"""What bags hold: topics, frames of the robot, what cannot be read."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from types import SimpleNamespace
from typing import Any

from odometry.bags.files.bag_files import BagFile
from odometry.bags.files.damage import Losses
from odometry.bags.files.message_types import MessageTypes
from odometry.bags.files.topic import (
    MOVING_TYPES,
    Connection,
    Message,
    Ranges,
    Topic,
    header_ns,
    widen,
)
from odometry.bags.topics.message_fields import FIX, IMAGES, IMU, JOINTS, POSES, body_frame
from odometry.bags.topics.robot_messages import ROBOT_TYPES, RobotMessages
from odometry.bags.topics.transforms import plain_frame
from odometry.bags.topics.wheel_names import sided
from odometry.errors import BagError

REPORT_EVERY = 1000  # messages
Progress = Callable[[int], None]
FIRST_LOOKS, EVERY = 200, 20  # of topics with motion: all of the first, then each 20th


class Tally:
    """Counts the messages of a topic, and decodes some of them."""

    def __init__(self, connection: Connection) -> None:
        self.connection = connection
        self.count, self.first_ns, self.last_ns = 0, 2**63, -1
        self.sample: Any = None
        self.offsets_s: list[float] = []
        self.unstamped = 0  # of those that were decoded
        self.ranges: Ranges = {}
        self.clock_back_s, self._latest = 0.0, (0, 0)
        self.problem = ""
        self.frames, self.worlds = Counter[str](), Counter[str]()
        self.joints: dict[str, None] = {}
        self._of_robot = connection.message_type in ROBOT_TYPES
        self.tells_motion = connection.message_type in MOVING_TYPES

    def add(self, message: Message, types: MessageTypes, robot: RobotMessages) -> None:
        """Take in a message; what it says of the robot goes to `robot`."""
        self.count += 1
        self.first_ns = min(self.first_ns, message.received_ns)
        self.last_ns = max(self.last_ns, message.received_ns)
        of_robot = self._of_robot and robot.may_describe_robot(message)
        if not (of_robot or self._looks()):
            return
        try:
            content = types.decode(message)
        except BagError as problem:
            self.problem = str(problem)
            return
        if of_robot:
            robot.add(message, content)
        if self.tells_motion:
            widen(self.ranges, content)
        self._name(content)
        stamp_ns = header_ns(content)
        self.unstamped += not stamp_ns
        if stamp_ns:
            self.offsets_s.append((stamp_ns - message.received_ns) / 1e9)
            stamped_ns, received_ns = self._latest
            if message.received_ns > received_ns:
                self.clock_back_s = max(self.clock_back_s, (stamped_ns - stamp_ns) / 1e9)
                self._latest = stamp_ns, message.received_ns
        if self.sample is None or self._tells_more(content):
            image = self.connection.message_type in IMAGES
            self.sample = _without_pixels(content) if image else content

    def _name(self, content: Any) -> None:
        """Take in the frames and joints that a message names."""
        kind = self.connection.message_type
        if kind in POSES:
            self.worlds[plain_frame(content.header.frame_id)] += 1
        if kind in (FIX, IMU):
            self.frames[body_frame(content)] += 1
        if kind == JOINTS:
            self.joints.update(dict.fromkeys(content.name))

    def _looks(self) -> bool:
        """The first messages, then fewer and fewer; of those with motion a fixed share."""
        if self.tells_motion:
            return self.count <= FIRST_LOOKS or self.count % EVERY == 0
        return self.count <= 2 or self.count & (self.count - 1) == 0

    def _tells_more(self, content: Any) -> bool:
        """Whether joints are wheels where those of the sample, of another publisher, are none."""
        joints = self.connection.message_type == JOINTS
        return joints and not sided(self.sample.name)[0] and bool(sided(content.name)[0])

    def topic(self) -> Topic:
        """Summary of the topic."""
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
            _most_first(self.frames),
            _most_first(self.worlds),
            tuple(self.joints),
            self.clock_back_s,
            self.unstamped / max(self.unstamped + len(self.offsets_s), 1),
        )


def _most_first(counts: Counter[str]) -> tuple[str, ...]:
    return tuple(name for name, _ in counts.most_common())


def _without_pixels(content: Any) -> Any:
    kept = ("header", "height", "width", "encoding", "format")
    return SimpleNamespace(**{key: getattr(content, key) for key in kept if hasattr(content, key)})


@dataclass(frozen=True)
class Survey:
    """What a set of bag files holds.

    Attributes
    ----------
    files : tuple of BagFile
        In the order of their first messages.
    topics : Mapping of name to Topic
    robot : RobotMessages
    losses : tuple of str
        What could not be read.
    """

    files: tuple[BagFile, ...]
    topics: Mapping[str, Topic]
    robot: RobotMessages
    losses: tuple[str, ...]

    @property
    def count(self) -> int:
        """Messages that could be read."""
        return sum(topic.count for topic in self.topics.values())


def survey(
    files: Sequence[BagFile], types: MessageTypes, lost: Losses, progress: Progress
) -> Survey:
    """Read files once, and decode some messages of each topic.

    Parameters
    ----------
    files : of BagFile
    types : MessageTypes
    lost : Losses
        What is known to be lost already; it is added to.
    progress : callable
        Called with numbers of messages that were read since the call before.

    Raises
    ------
    BagError
        If no message can be read.
    """
    tallies, robot = dict[str, Tally](), RobotMessages()
    begins: dict[BagFile, int] = {}
    for file in files:
        of_file: dict[int, Tally | None] = {}
        begin, count = None, 0
        for message in file.messages(lost):
            count += 1
            if count % REPORT_EVERY == 0:
                progress(REPORT_EVERY)
            begin = message.received_ns if begin is None else min(begin, message.received_ns)
            key = id(message.connection)
            if key not in of_file:
                of_file[key] = _tally(message.connection, tallies, lost)
            tally = of_file[key]
            if tally is not None:
                tally.add(message, types, robot)
        progress(count % REPORT_EVERY)
        if begin is None:
            lost.append(f"{file.path}: there is no message in it")
        else:
            begins[file] = begin
    if not begins:
        raise BagError(f"there is no message to read: {'; '.join(lost.lines)}")
    topics = {name: tally.topic() for name, tally in sorted(tallies.items())}
    return Survey(tuple(sorted(begins, key=begins.__getitem__)), topics, robot, lost.lines)


def _tally(connection: Connection, tallies: dict[str, Tally], losses: Losses) -> Tally | None:
    """Tally of a topic; None, and a loss, where the topic has another type elsewhere."""
    tally = tallies.setdefault(connection.topic, Tally(connection))
    if tally.connection.message_type != connection.message_type:
        losses.append(
            f"{connection.topic}: its messages of the type {connection.message_type}, where others "
            f"are {tally.connection.message_type}"
        )
        return None
    return tally
