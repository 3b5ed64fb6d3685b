"""A topic of a bag as the bag describes it, and one of its messages, not yet decoded."""

from dataclasses import dataclass
from typing import NamedTuple

Buffer = bytes | memoryview
READABLE = ("cdr", "ros1")


@dataclass(frozen=True)
class Connection:
    """A topic as a bag announces it.

    Attributes
    ----------
    topic : str
    message_type : str
        As ROS 2 writes it: package/msg/Name.
    encoding : str
        Encoding of the messages: one of READABLE, or another, which cannot be read.
    definition : str
        Text of the message definition; empty where the bag has none.
    schema : str
        Language of the definition: "msg" or "idl".
    """

    topic: str
    message_type: str
    encoding: str
    definition: str = ""
    schema: str = "msg"


class Message(NamedTuple):
    """A message, not decoded; `received_ns` is when the bag got it, since 1970."""

    connection: Connection
    received_ns: int
    data: Buffer


def ros2_name(message_type: str) -> str:
    """A type as ROS 2 writes it, of either version: sensor_msgs/Imu is sensor_msgs/msg/Imu."""
    package, _, name = message_type.rpartition("/")
    if not package or package.endswith(("/msg", "/action", "/srv")):
        return message_type
    return f"{package}/msg/{name}"
