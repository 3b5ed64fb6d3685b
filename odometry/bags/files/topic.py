"""A topic of a bag: how the bag describes it, its messages, and a summary of them."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

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


VELOCITY, PLACE = "velocity", "place"
MOVING_TYPES = (
    "sensor_msgs/msg/JointState",
    "nav_msgs/msg/Odometry",
    "sensor_msgs/msg/NavSatFix",
    "sensor_msgs/msg/Imu",
    "geometry_msgs/msg/TwistStamped",
    "geometry_msgs/msg/TwistWithCovarianceStamped",
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "geometry_msgs/msg/TransformStamped",
)
Ranges = dict[tuple[str, str], tuple[float, float]]


def widen(ranges: Ranges, message: Any) -> None:
    """Widen the ranges of velocities and places by a message of MOVING_TYPES."""
    for kind, name, value in _values(message):
        if math.isfinite(value):
            least, most = ranges.get((kind, name), (value, value))
            ranges[kind, name] = min(least, value), max(most, value)


def moved(ranges: Ranges, kind: str, name: str) -> bool:
    """Whether a place was ever another, or a velocity ever other than zero."""
    least, most = ranges.get((kind, name), (0.0, 0.0))
    return least != most or (kind == VELOCITY and least != 0)


def farthest(ranges: Ranges, kind: str, names: Iterable[str]) -> float:
    """Largest absolute value of these names; 0 where there is none."""
    ends = (abs(end) for name in names for end in ranges.get((kind, name), (0.0, 0.0)))
    return max(ends, default=0.0)


def _values(message: Any) -> Iterator[tuple[str, str, float]]:
    if any(hasattr(message, part) for part in ("twist", "pose", "transform")):
        yield from _posed(message)
        return
    if hasattr(message, "angular_velocity"):
        yield from _inertial(message)
        return
    if hasattr(message, "latitude"):
        if message.status.status >= 0:
            yield PLACE, "latitude", message.latitude
            yield PLACE, "longitude", message.longitude
        return
    for name, value in zip(message.name, message.velocity, strict=False):
        yield VELOCITY, name, float(value)
    for name, value in zip(message.name, message.position, strict=False):
        yield PLACE, name, float(value)


def _posed(message: Any) -> Iterator[tuple[str, str, float]]:
    """Of odometry, a twist, a pose or a transform; with a covariance they lie one deeper."""
    if hasattr(message, "twist"):
        twist = getattr(message.twist, "twist", message.twist)
        yield VELOCITY, "ahead", twist.linear.x
        yield VELOCITY, "side", twist.linear.y
        yield VELOCITY, "turn", twist.angular.z
    pose = getattr(message, "pose", getattr(message, "transform", None))
    if pose is None:
        return
    pose = getattr(pose, "pose", pose)
    at = pose.position if hasattr(pose, "position") else pose.translation
    turn = pose.orientation if hasattr(pose, "orientation") else pose.rotation
    for axis in "xyz":
        yield PLACE, axis, getattr(at, axis)
    for axis in "wxyz":
        yield PLACE, f"orientation.{axis}", getattr(turn, axis)


def _inertial(message: Any) -> Iterator[tuple[str, str, float]]:
    """Rates and forces of an Imu, without those that it says are not measured.

    REP-145: a covariance that begins with -1 says so.
    """
    for what in ("angular_velocity", "linear_acceleration"):
        if getattr(message, f"{what}_covariance")[0] != -1:
            values = getattr(message, what)
            for axis in "xyz":
                yield VELOCITY, f"{what}.{axis}", getattr(values, axis)


@dataclass(frozen=True)
class Topic:
    """What the bags hold of a topic.

    Attributes
    ----------
    name, message_type : str
    count : int
    first_ns, last_ns : int
        When the first and the last message were received.
    sample : object or None
        The first message that could be decoded, images without their pixels.
    header_offset_s : float or None
        Median of header stamp minus time of reception; None where there is no header stamp.
    clock_back_s : float
        By how much header stamps go back at most while messages come in.
    unstamped : float
        Share of its messages without a header stamp.
    ranges : Mapping
        Smallest and largest value of the motion fields, see `motion_ranges`.
    problem : str
        Why it cannot be read; empty where it can.
    frames : tuple of str
        Frames that its fixes, or Imu messages, name, that of most first: of several sensors there
        are several.
    worlds : tuple of str
        Frames in which its poses are, that of most messages first.
    joints : tuple of str
        Names of joints in all messages that were looked at.
    """

    name: str
    message_type: str
    count: int
    first_ns: int
    last_ns: int
    sample: Any = None
    header_offset_s: float | None = None
    ranges: Ranges = field(default_factory=dict)
    problem: str = ""
    frames: tuple[str, ...] = ()
    worlds: tuple[str, ...] = ()
    joints: tuple[str, ...] = ()
    clock_back_s: float = 0.0
    unstamped: float = 0.0

    @property
    def duration_s(self) -> float:
        """Between the first and the last message."""
        return (self.last_ns - self.first_ns) / 1e9

    @property
    def rate_hz(self) -> float:
        """Mean rate; 0 of a single message."""
        return (self.count - 1) / self.duration_s if self.duration_s > 0 else 0.0


def header_ns(content: Any) -> int:
    """Header stamp of a message, 0 where it has none."""
    stamp = getattr(getattr(content, "header", None), "stamp", None)
    return max(0, stamp.sec * 10**9 + stamp.nanosec) if stamp is not None else 0
