"""What becomes of the messages of a topic: rows of a file, or image files."""

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable
from typing import Any

from odometry.bags.files.topic import Message, header_ns
from odometry.bags.rows.image_files import ImageFiles
from odometry.bags.rows.ordered_rows import OrderedRows
from odometry.bags.topics.transforms import TransformPoses
from odometry.errors import BagError

Row = tuple[float, ...]


class Consumer(ABC):
    """Takes in the messages of one topic.

    Attributes
    ----------
    topic : str
    dropped : Counter
        How many messages were dropped, by reason.
    """

    def __init__(self, topic: str) -> None:
        self.topic = topic
        self.dropped: Counter[str] = Counter()

    def add(self, message: Message, content: Any) -> None:
        """Take in a message; one that cannot be used is counted."""
        try:
            self.take(message, content)
        except BagError as problem:
            self.dropped[str(problem)] += 1

    def begin_file(self) -> None:  # noqa: B027 - most need not know
        """Messages of another file come next."""

    @abstractmethod
    def take(self, message: Message, content: Any) -> None:
        """Take in a message; BagError if it cannot be used."""


class Stream(Consumer):
    """Turns messages of one topic into rows, or image files.

    Attributes
    ----------
    file : str
        Of the run folder.
    sink : OrderedRows or ImageFiles
    """

    def __init__(
        self, topic: str, file: str, sink: OrderedRows | ImageFiles, *, by_header: bool
    ) -> None:
        super().__init__(topic)
        self.file, self.sink = file, sink
        self._by_header = by_header

    def gap(self) -> str:
        """Why nothing of it could be used, to follow a sentence; empty where that is not known."""
        return ""

    def stamp_ns(self, message: Message, stamped_ns: int) -> int:
        """When a message was made, or received where headers do not count or say nothing."""
        return stamped_ns if self._by_header and stamped_ns else message.received_ns


class Rows(Stream):
    """A row a message."""

    def __init__(
        self,
        topic: str,
        file: str,
        sink: OrderedRows,
        read: Callable[[Any], Row],
        *,
        by_header: bool,
    ) -> None:
        super().__init__(topic, file, sink, by_header=by_header)
        self._rows, self._read = sink, read

    def begin_file(self) -> None:
        """Messages of another file come next."""
        self._rows.clock.begin_file()

    def take(self, message: Message, content: Any) -> None:
        """Take in a message; BagError if it cannot be used."""
        self._rows.add(self.stamp_ns(message, header_ns(content)), self._read(content))


class TransformRows(Stream):
    """As many rows a message as it moves the robot."""

    def __init__(
        self, topic: str, file: str, sink: OrderedRows, poses: TransformPoses, *, by_header: bool
    ) -> None:
        super().__init__(topic, file, sink, by_header=by_header)
        self._rows, self._poses = sink, poses

    def begin_file(self) -> None:
        """Messages of another file come next."""
        self._rows.clock.begin_file()

    def take(self, message: Message, content: Any) -> None:
        """Take in a message; BagError if it cannot be used."""
        for stamped_ns, row in self._poses.rows(content):
            self._rows.add(self.stamp_ns(message, stamped_ns), row)

    def gap(self) -> str:
        """Which chain of frames is missing."""
        return f": {self._poses.gap()}"


class Images(Stream):
    """An image a message."""

    def __init__(self, topic: str, sink: ImageFiles, *, by_header: bool) -> None:
        super().__init__(topic, "images.csv", sink, by_header=by_header)
        self._images = sink

    def take(self, message: Message, content: Any) -> None:
        """Take in a message; BagError if it cannot be used."""
        self._images.add(self.stamp_ns(message, header_ns(content)), content)
