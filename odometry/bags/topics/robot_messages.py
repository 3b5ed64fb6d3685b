"""What messages say of the robot: fixed transforms, a description (URDF), parameters."""

import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.bags.files.topic import Message
from odometry.bags.topics.transforms import Transforms, change_of, stated
from odometry.bags.topics.wheel_names import is_wheel, side_of
from odometry.geometry import se3

LONGEST = 16 * 1024**2  # characters


@dataclass(frozen=True)
class Wheel:
    """A wheel of the robot.

    Attributes
    ----------
    joint : str
    frame : str
        Frame of the link that turns; its origin is the wheel's centre.
    side : str
        "left" or "right", by its place; else by its name.
    radius_m : float or None
        None where the wheel's shape is a mesh.
    """

    joint: str
    frame: str
    side: str
    radius_m: float | None


@dataclass(frozen=True)
class RobotDescription:
    """Parts of a URDF; joints stand where they are with all angles at zero.

    Attributes
    ----------
    name : str
    parents : dict of frame to (parent, (4, 4))
    wheels : tuple of Wheel
    """

    name: str = ""
    parents: dict[str, tuple[str, FloatArray]] = field(default_factory=dict)
    wheels: tuple[Wheel, ...] = ()


def robot_description(text: str) -> RobotDescription | None:
    """Read a URDF; None where the text is none."""
    if "<robot" not in text or "<!ENTITY" in text or len(text) > LONGEST:
        return None
    try:
        root = ET.fromstring(text.strip())  # noqa: S314 - no entities, see above
    except ET.ParseError:
        return None
    radii = {link.get("name", ""): _radius(link) for link in root.iter("link")}
    parents, wheels = {}, []
    for joint in root.findall("joint"):
        parent, child = _linked(joint, "parent"), _linked(joint, "child")
        if not parent or not child:
            continue
        parents[child] = (parent, _origin(joint))
        name = joint.get("name", "")
        turns = joint.get("type") in ("continuous", "revolute")
        side = side_of(name) or side_of(child)
        if turns and side and (is_wheel(name) or is_wheel(child)):
            wheels.append(Wheel(name, child, side, radii.get(child)))
    return RobotDescription(root.get("name", ""), parents, tuple(wheels))


def _linked(joint: ET.Element, role: str) -> str:
    found = joint.find(role)
    return found.get("link", "") if found is not None else ""


def _origin(joint: ET.Element) -> FloatArray:
    """Pose (4, 4) of a joint in its parent: xyz, and rpy as R = Rz(yaw) Ry(pitch) Rx(roll)."""
    origin = joint.find("origin")
    if origin is None:
        return np.eye(4)
    rotation = se3.rotation_from_roll_pitch_yaw(_triple(origin.get("rpy")))
    return se3.pose(_triple(origin.get("xyz")), rotation)


def _triple(text: str | None) -> FloatArray:
    try:
        values = np.array([float(word) for word in (text or "0 0 0").split()])
    except ValueError:
        return np.zeros(3)
    return values if values.shape == (3,) and np.isfinite(values).all() else np.zeros(3)


def _radius(link: ET.Element) -> float | None:
    """Radius of a link that is a cylinder or a sphere, by its collision, else visual shape."""
    for place in ("collision", "visual"):
        for kind in ("cylinder", "sphere"):
            shape = link.find(f"{place}/geometry/{kind}")
            try:
                radius = float(shape.get("radius", "")) if shape is not None else 0.0
            except ValueError:
                continue
            if 0 < radius < 10:
                return radius
    return None


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
        self._described: dict[str, RobotDescription] = {}
        self.numbers: dict[str, float] = {}
        self.restated: dict[str, str] = {}  # by frame: how it is stated otherwise later

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
                self._fix(found)
                return
            for child, link in found.items():
                before = self._moving.setdefault(child, link)
                if before[0] != link[0] or np.abs(before[1] - link[1]).max() > STILL:
                    self._changed.add(child)
        elif kind == TEXT:
            self._describe(content.data, message.connection.topic)
        else:
            for one in (*content.new_parameters, *content.changed_parameters):
                if one.value.type == STRING and "<robot" in one.value.string_value:
                    self._describe(one.value.string_value, str(content.node))
                elif one.value.type == DOUBLE and one.name in NUMBERS:
                    self.numbers[NUMBERS[one.name]] = one.value.double_value

    def _fix(self, found: dict[str, Any]) -> None:
        for child in found.keys() & self._fixed.keys():
            if change := change_of(self._fixed[child], found[child]):
                self.restated[child] = change
        self._fixed.update(found)

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

    def use_robot(self, name: str) -> None:
        """Of several descriptions, use the one whose topic or node has this part in its name."""
        for topic, description in self._described.items():
            if name and name in topic.split("/"):
                self.description = description

    def _describe(self, text: str, topic: str) -> None:
        found = robot_description(text)
        if found is not None:
            self._described[topic] = self.description = found
