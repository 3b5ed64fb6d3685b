"""The messages of bags, one by one: a recording read as if live."""

from collections.abc import Iterator
from heapq import merge
from importlib import import_module
from operator import attrgetter
from pathlib import Path
from typing import Any, NamedTuple

from odometry.bags.files.bag_files import bag_files
from odometry.bags.files.damage import Losses
from odometry.bags.files.topic import header_ns
from odometry.errors import BagError
from odometry.installed import extra_module


class BagMessage(NamedTuple):
    """A message of a bag.

    Attributes
    ----------
    topic : str
    stamp_s : float
        Of its header, where it has one that says something; else when the bag received it. Since
        1970, correctly rounded.
    content : Any
        An object with the fields of its definition.

    Examples
    --------
    >>> import odometry
    >>> message = odometry.BagMessage("/imu/data", 12.5, None)
    >>> message.topic, message.stamp_s
    ('/imu/data', 12.5)
    """

    topic: str
    stamp_s: float
    content: Any


def bag_messages(*paths: str | Path) -> Iterator[BagMessage]:
    """Messages of bags of ROS 1 or ROS 2 in the order in which they were recorded.

    Parameters
    ----------
    *paths : path
        Files or folders; several are one recording, one after another or at the same time.

    Yields
    ------
    BagMessage
        Messages that cannot be decoded are left out, as is what is damaged; `import` says what.

    Raises
    ------
    BagError
        If a path is missing, or nothing of all of them is a bag.
    ExtraError
        If the packages of the extra `bags` are not installed.

    Examples
    --------
    >>> import odometry
    >>> try:
    ...     for message in odometry.bag_messages("drive.bag"):
    ...         print(message.topic, message.stamp_s)
    ... except odometry.OdometryError as error:  # here, as there is no such bag
    ...     print(error)
    drive.bag: there is no such file or folder
    """
    extra_module("rosbags", "bags", "reading bags")
    types = import_module("odometry.bags.files.message_types").MessageTypes()
    files = bag_files([Path(path) for path in paths], Losses())
    parts = (file.messages(Losses()) for file in files)
    for message in merge(*parts, key=attrgetter("received_ns")):
        try:
            content = types.decode(message)
        except BagError:
            continue
        stamp_ns = header_ns(content) or message.received_ns
        yield BagMessage(message.connection.topic, stamp_ns / 10**9, content)
