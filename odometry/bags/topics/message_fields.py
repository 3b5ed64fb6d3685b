"""Messages that an import knows: their types, where poses stand in them, numbers by paths."""

import re
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from odometry.errors import BagError

JOINTS = "sensor_msgs/msg/JointState"
ODOMETRY = "nav_msgs/msg/Odometry"
IMU = "sensor_msgs/msg/Imu"
FIX = "sensor_msgs/msg/NavSatFix"
IMAGE = "sensor_msgs/msg/Image"
COMPRESSED_IMAGE = "sensor_msgs/msg/CompressedImage"
CAMERA_INFO = "sensor_msgs/msg/CameraInfo"
TRANSFORM = "geometry_msgs/msg/TransformStamped"
POINT = "geometry_msgs/msg/PointStamped"
TRANSFORM_LISTS = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")

# Types with a twist (linear ahead, angular about z), and the fields that hold it
TWISTS: dict[str, Callable[[Any], Any]] = {
    ODOMETRY: lambda message: message.twist.twist,
    "geometry_msgs/msg/TwistStamped": lambda message: message.twist,
    "geometry_msgs/msg/TwistWithCovarianceStamped": lambda message: message.twist.twist,
}
# Types with a pose (position and orientation, or translation and rotation), and its fields
POSES: dict[str, Callable[[Any], Any]] = {
    ODOMETRY: lambda message: message.pose.pose,
    "geometry_msgs/msg/PoseStamped": lambda message: message.pose,
    "geometry_msgs/msg/PoseWithCovarianceStamped": lambda message: message.pose.pose,
    TRANSFORM: lambda message: message.transform,
}
IMAGES = (IMAGE, COMPRESSED_IMAGE)
# Types whose numbers are no speeds of wheels, whatever a user says
NO_WHEELS = (
    *(kind for kind in POSES if kind not in TWISTS),
    *(*TRANSFORM_LISTS, *IMAGES, IMU, FIX, POINT, CAMERA_INFO),
)


def body_frame(message: Any) -> str:
    """The frame whose pose or readings a message holds; empty where it does not say.

    Odometry and transforms name it as the child. A PoseStamped names the frame of the world
    alone.
    """
    child = getattr(message, "child_frame_id", "")
    if child or hasattr(message, "pose"):
        return str(child).lstrip("/")
    return str(getattr(getattr(message, "header", None), "frame_id", "")).lstrip("/")


def check_frame(message: Any, taken: str, what: str, table: str) -> None:
    """Raise BagError where a message is of another sensor on a topic than the one of a frame."""
    if (frame := body_frame(message)) != taken:
        raise BagError(
            f"of {frame or 'no frame'}, another {what} on this topic; {taken or 'no frame'} is "
            f"taken (frame of [{table}] in a map says which)"
        )


STEP = re.compile(r"([A-Za-z_]\w*)|\[(-?\d+)\]")
DEEPEST, LONGEST_ARRAY = 4, 16  # limits of the search for numbers


def number_paths(message: Any, prefix: str = "", depth: int = 0) -> Iterator[str]:
    """Paths of the numbers of a message, headers left out."""
    if isinstance(message, bool | str | bytes):
        return
    if isinstance(message, int | float | np.number):
        yield prefix
    elif isinstance(message, list | np.ndarray):
        if len(message) <= LONGEST_ARRAY:
            for place, one in enumerate(message):
                yield from number_paths(one, f"{prefix}[{place}]", depth)
    elif depth < DEEPEST:
        for name in getattr(message, "__dataclass_fields__", ()):
            if name not in ("header", "layout", "stamp", "__msgtype__"):
                inner = f"{prefix}.{name}" if prefix else name
                yield from number_paths(getattr(message, name), inner, depth + 1)


def number_at(path: str) -> Callable[[Any], float]:
    """A function that takes the number at a path out of a message.

    Raises
    ------
    BagError
        If the path is malformed; the function itself where a message has no number there.
    """
    steps = _steps(path)

    def read(message: Any) -> float:
        value = message
        try:
            for step in steps:
                value = value[step] if isinstance(step, int) else getattr(value, step)
            return float(value)
        except (AttributeError, IndexError, KeyError, TypeError, ValueError) as problem:
            raise BagError(f"no number at {path!r} of {type(message).__name__}") from problem

    return read


def _steps(path: str) -> list[str | int]:
    steps: list[str | int] = []
    position = 0
    while position < len(path):
        if steps and path[position] == ".":
            position += 1
        found = STEP.match(path, position)
        if found is None:
            break
        steps.append(found[1] or int(found[2]))
        position = found.end()
    if not steps or position < len(path):
        raise BagError(f"{path!r}: expected a path such as drivers[0].measured_velocity")
    return steps
