"""What bags hold: their topics, the frames of the robot, and what cannot be read."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from odometry.bags.bag_files import BagFile
from odometry.bags.connection import Connection
from odometry.bags.errors import BagError
from odometry.bags.losses import Losses
from odometry.bags.message_types import MessageTypes
from odometry.bags.robot_seen import RobotSeen
from odometry.bags.tally import Tally
from odometry.bags.topic import Topic

REPORT_EVERY = 1000  # messages
Progress = Callable[[int], None]


@dataclass(frozen=True)
class Survey:
    """What a set of bag files holds.

    Attributes
    ----------
    files : tuple of BagFile
        In the order of their first messages.
    topics : Mapping of name to Topic
    robot : RobotSeen
    losses : tuple of str
        What could not be read.
    """

    files: tuple[BagFile, ...]
    topics: Mapping[str, Topic]
    robot: RobotSeen
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
    tallies, robot = dict[str, Tally](), RobotSeen()
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
