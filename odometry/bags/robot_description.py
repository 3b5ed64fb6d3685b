"""What a robot description (URDF) says: fixed places of frames, wheels, their size."""

import xml.etree.ElementTree as ET  # entities are refused before parsing
from dataclasses import dataclass, field

import numpy as np

from odometry.arrays import FloatArray
from odometry.bags.wheel_names import is_wheel, side_of
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
