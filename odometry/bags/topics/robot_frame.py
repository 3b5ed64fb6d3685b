"""The robot frame of a run folder in terms of a bag's frames, and the robot's size.

The robot frame has its origin at the centre of the rectangle that the wheels touch, on the
terrain; its axes are those of the robot's base frame. Where the places of the wheels and their
radius are known, so is this origin. Else base_footprint is taken to lie there. The height of
base_link above the terrain is not known without either.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from statistics import mean
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.bags.topics.robot_messages import RobotMessages
from odometry.bags.topics.wheel_names import is_wheel, side_of
from odometry.errors import BagError

BASES = ("base_footprint", "base_link", "base", "chassis_link", "body", "trunk")
UNEQUAL = 1.02  # ratio of radii
HOW_TRACK = "measure from the middle of the left wheels (or tracks) to the middle of the right ones"
HOW_HEIGHT = "measure how high the origin of that frame is above the terrain"


@dataclass(frozen=True)
class RobotFrame:
    """Where the robot frame lies, and what is known of the robot.

    Attributes
    ----------
    base : str
        The frame of the bag whose axes the robot frame has; empty where none is known.
    robot_from_base : (4, 4)
        Pose of the base frame in the robot frame.
    height_known : bool
        Whether the height of the base frame above the terrain is known.
    track_width_m, wheel_radius_m : float or None
    name : str
    size_m : Mapping
        length, width [m] and mass [kg], where the user says them.
    notes : tuple of str
        Where the numbers come from.
    """

    base: str
    robot_from_base: FloatArray
    height_known: bool
    track_width_m: float | None
    wheel_radius_m: float | None
    name: str
    size_m: Mapping[str, float]
    notes: tuple[str, ...]

    def pose_of(self, frame: str, robot: RobotMessages) -> FloatArray | None:
        """Pose (4, 4) of a frame of the bag in the robot frame; None where it is not known."""
        if frame == self.base and frame:
            return self.robot_from_base
        seen = robot.fixed.between(self.base, frame) if self.base else None
        return None if seen is None else np.asarray(self.robot_from_base @ seen)


def robot_frame(
    robot: RobotMessages,
    topic_map: Mapping[str, Any],
    bodies: Iterable[str],
    prefix: str = "",
) -> RobotFrame:
    """Find the robot frame and the robot's size.

    Parameters
    ----------
    robot : RobotMessages
    topic_map : Mapping
        The table [robot] of a map.
    bodies : of str
        Frames whose motion odometry topics hold: where names do not give the base frame, one of
        these is it.
    prefix : str
        Where there are several robots: what frames of this one begin with.

    Raises
    ------
    BagError
        If the map names a frame that the bag does not have.
    """
    base = _base(robot, topic_map, bodies, prefix)
    centres = _wheel_centres(robot, base)
    notes = []
    radius, track = topic_map.get("wheel_radius"), topic_map.get("track_width")
    radii = [w.radius_m for w in robot.description.wheels if w.radius_m is not None]
    if radius is None and radii:
        radius = mean(radii)
        notes.append(f"wheel radius {radius:.4g} m: from the robot description")
        if max(radii) > UNEQUAL * min(radii):
            notes.append(
                f"warning: the robot description has wheels of {min(radii):.4g} to "
                f"{max(radii):.4g} m radius, of which this is the mean: state --wheel-radius"
            )
    elif radius is None and "wheel_radius" in robot.numbers:
        radius = robot.numbers["wheel_radius"]
        notes.append(f"wheel radius {radius:.4g} m: from a parameter in the bag")
    if track is None and centres:
        track = mean(y for _, y, _ in centres["left"]) - mean(y for _, y, _ in centres["right"])
        notes.append(f"track width {track:.4g} m: from the places of the wheels")
    elif track is None and "track_width" in robot.numbers:
        track = robot.numbers["track_width"]
        notes.append(f"track width {track:.4g} m: from wheel_separation, a parameter in the bag")
    place, height_known = _base_place(base, centres, radius, topic_map)
    return RobotFrame(
        base,
        place,
        height_known,
        track,
        radius,
        str(topic_map.get("name", robot.description.name)),
        {key: float(topic_map[key]) for key in ("length", "width", "mass") if key in topic_map},
        tuple(notes),
    )


def _base(
    robot: RobotMessages, topic_map: Mapping[str, Any], bodies: Iterable[str], prefix: str
) -> str:
    frames = robot.all.frames
    if "frame" in topic_map:
        named = str(topic_map["frame"]).lstrip("/")
        if frames and named not in frames:
            raise BagError(
                f"[robot] frame = {named!r}: the bag has no such frame; found: "
                f"{', '.join(sorted(frames)[:24])}"
            )
        return named
    for name in BASES:
        found = sorted(f for f in frames if re.fullmatch(rf"(.*[/_])?{name}", f))
        if found:
            own = [f for f in found if prefix and re.match(rf"{re.escape(prefix)}[/_]", f)]
            return (own or found)[0]
    return next((body for body in bodies if body in frames), "")


def _wheel_centres(robot: RobotMessages, base: str) -> dict[str, list[FloatArray]]:
    """Centres (3,) of the wheels in the base frame by side; empty where a side has none."""
    if not base:
        return {}
    frames = {wheel.frame: wheel.side for wheel in robot.description.wheels}
    if not frames:
        frames = {f: side_of(f) for f in robot.all.parents if is_wheel(f) and side_of(f)}
    centres: dict[str, list[FloatArray]] = {"left": [], "right": []}
    for frame, side in frames.items():
        pose = robot.all.between(base, frame)
        if pose is not None:
            centres[side].append(pose[:3, 3])
    whole = all(centres.values()) and len(centres["left"]) == len(centres["right"])
    apart = whole and mean(c[1] for c in centres["left"]) > mean(c[1] for c in centres["right"])
    return centres if apart else {}


def _base_place(
    base: str,
    centres: Mapping[str, list[FloatArray]],
    radius_m: float | None,
    topic_map: Mapping[str, Any],
) -> tuple[FloatArray, bool]:
    """Pose (4, 4) of the base frame in the robot frame, and whether its height is known."""
    pose = np.eye(4)
    if centres:
        middle = np.mean([*centres["left"], *centres["right"]], axis=0)
        pose[:2, 3] = -middle[:2]
    if "frame_height" in topic_map:
        pose[2, 3] = float(topic_map["frame_height"])
    elif centres and radius_m is not None:
        pose[2, 3] = radius_m - middle[2]
    elif not base.endswith("base_footprint"):
        return pose, False
    return pose, True
