"""What messages say of the robot itself: fixed transforms, a description, parameters."""

import re
from typing import Any

import numpy as np

from odometry.bags.connection import Message
from odometry.bags.robot_description import RobotDescription, robot_description
from odometry.bags.transforms import Transforms, stated

TRANSFORMS = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
PARAMETERS = "rcl_interfaces/msg/ParameterEvent"
TEXT = "std_msgs/msg/String"
ROBOT_TYPES = (*TRANSFORMS, PARAMETERS, TEXT)
MOST_DYNAMIC = 200  # messages of /tf that are decoded
NUMBERS = {"wheel_radius": "wheel_radius", "wheel_separation": "track_width"}
STILL = 1e-6  # of the values of a transform
WORLD = re.compile(r"(^|/)(odom|map|world|earth|utm)", re.IGNORECASE)
DOUBLE, STRING = 3, 4  # rcl_interfaces/msg/ParameterType


class RobotMessages:
    """Gathers what messages say of the robot, message by message."""

    def __init__(self) -> None:
        self._fixed: dict[str, Any] = {}
        self._moving: dict[str, Any] = {}
        self._changed: set[str] = set()
        self._moving_looks = 0
        self.description = RobotDescription()
        self.numbers: dict[str, float] = {}

    def may_describe_robot(self, message: Message) -> bool:
        """Whether a message of ROBOT_TYPES may say something of the robot."""
        kind, topic = message.connection.message_type, message.connection.topic
        if kind in TRANSFORMS:
            return topic.endswith("static") or self._moving_looks < MOST_DYNAMIC
        return kind == PARAMETERS or (kind == TEXT and b"<robot" in bytes(message.data))

    def add(self, message: Message, content: Any) -> None:
        """Read a message for which `may_describe_robot` is true."""
        kind = message.connection.message_type
        if kind in TRANSFORMS:
            fixed = message.connection.topic.endswith("static")
            self._moving_looks += not fixed
            found = stated(content.transforms)
            if fixed:
                self._fixed.update(found)
                return
            for child, link in found.items():
                before = self._moving.setdefault(child, link)
                if before[0] != link[0] or np.abs(before[1] - link[1]).max() > STILL:
                    self._changed.add(child)
        elif kind == TEXT:
            self._describe(content.data)
        else:
            for one in (*content.new_parameters, *content.changed_parameters):
                if one.value.type == STRING and "<robot" in one.value.string_value:
                    self._describe(one.value.string_value)
                elif one.value.type == DOUBLE and one.name in NUMBERS:
                    self.numbers[NUMBERS[one.name]] = one.value.double_value

    @property
    def fixed(self) -> Transforms:
        """Frames that do not move: as static messages or the description have them.

        Frames of /tf that did not change are taken too: old drivers send fixed ones there.
        """
        turning = {wheel.frame for wheel in self.description.wheels}
        still = {
            child: link
            for child, link in (*self._moving.items(), *self.description.parents.items())
            if child not in turning | self._changed and not WORLD.search(link[0])
        }
        return Transforms({**still, **self._fixed})

    @property
    def all(self) -> Transforms:
        """The same with wheels and what else moved, as it stood at first."""
        return Transforms({**self._moving, **self.description.parents, **self._fixed})

    def _describe(self, text: str) -> None:
        found = robot_description(text)
        if found is not None:
            self.description = found
