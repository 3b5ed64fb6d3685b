"""Where frames of a robot stand: transforms from messages and robot descriptions."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se3

Row = tuple[float, ...]
LONGEST_CHAIN = 100  # frames; more are a circle


@dataclass(frozen=True)
class Transforms:
    """A forest of frames.

    Attributes
    ----------
    parents : Mapping of frame to (parent, (4, 4))
        Pose of the frame in its parent [m].
    """

    parents: Mapping[str, tuple[str, FloatArray]] = field(default_factory=dict)

    @property
    def frames(self) -> set[str]:
        """Names of all frames."""
        return {*self.parents, *(parent for parent, _ in self.parents.values())}

    def between(self, target: str, source: str) -> FloatArray | None:
        """Pose (4, 4) of the frame `source` in the frame `target`; None where they do not meet."""
        target_chain, source_chain = self._chain(target), self._chain(source)
        common = next((name for name in source_chain if name in target_chain), None)
        if common is None:
            return None
        return np.asarray(se3.inverse(target_chain[common]) @ source_chain[common])

    def above(self, frame: str) -> set[str]:
        """Names of a frame and of all its ancestors."""
        return set(self._chain(frame))

    def _chain(self, frame: str) -> dict[str, FloatArray]:
        """Pose of `frame` in itself and in each of its ancestors, nearest first."""
        chain, pose = {frame: np.eye(4)}, np.eye(4)
        while frame in self.parents:
            frame, step = self.parents[frame]
            if frame in chain:
                break  # a circle
            pose = step @ pose
            chain[frame] = pose
        return chain


def plain_frame(name: str) -> str:
    """A frame's name without the slash that old drivers write before it."""
    return name.lstrip("/")


def matrix_of(transform: Any) -> FloatArray | None:
    """Pose (4, 4) of a geometry_msgs/Transform or Pose; None where it has no rotation."""
    place = getattr(transform, "translation", None)
    place = transform.position if place is None else place
    turn = getattr(transform, "rotation", None)
    turn = transform.orientation if turn is None else turn
    values = np.array([place.x, place.y, place.z, turn.w, turn.x, turn.y, turn.z], dtype=float)
    if not np.isfinite(values).all() or not np.linalg.norm(values[3:]) > 0.5:
        return None
    return se3.pose(values[:3], se3.rotation_from_quaternion_wxyz(values[3:]))


def stated(messages: Iterable[Any]) -> dict[str, tuple[str, FloatArray]]:
    """Transforms by child frame of geometry_msgs/TransformStamped messages, the last of each."""
    found = {}
    for one in messages:
        pose = matrix_of(one.transform)
        if pose is not None:
            parent, child = plain_frame(one.header.frame_id), plain_frame(one.child_frame_id)
            found[child] = (parent, pose)
    return found


SAME_M, SAME_RAD = 1e-3, 1e-3  # rounding


def change_of(before: tuple[str, FloatArray], after: tuple[str, FloatArray]) -> str:
    """How a parent and a pose (4, 4) in it differ from others, in words; empty where they agree."""
    if before[0] != after[0]:
        return f"in {before[0]}, then in {after[0]}"
    change = se3.inverse(before[1]) @ after[1]
    moved_m = float(np.linalg.norm(change[:3, 3]))
    turned_rad = math.acos(np.clip((np.trace(change[:3, :3]) - 1) / 2, -1, 1))
    if moved_m < SAME_M and turned_rad < SAME_RAD:
        return ""
    return f"{moved_m:.3g} m and {math.degrees(turned_rad):.3g} degrees apart"


class TransformPoses:
    """Poses of a frame in a world frame, one whenever the frame itself has moved.

    Between them other frames may lie, as odom between map and the robot: the latest transform of
    each is used.
    """

    def __init__(self, world: str, body: str, fixed: Transforms) -> None:
        self._world, self._body = world, body
        self._parents = dict(fixed.parents)
        self._carrier = body  # nearest to the body of the frames that move
        while self._carrier in self._parents:
            self._carrier = self._parents[self._carrier][0]

    def rows(self, message: Any) -> list[tuple[int, Row]]:
        """Header stamps [ns] and x, y, z, qw, qx, qy, qz that a TFMessage adds."""
        found = []
        for one in message.transforms:
            pose, child = matrix_of(one.transform), plain_frame(one.child_frame_id)
            if pose is None:
                continue
            self._parents[child] = (plain_frame(one.header.frame_id), pose)
            if child == self._carrier:
                place = Transforms(self._parents).between(self._world, self._body)
                if place is not None and self._leads(self._body, self._world):
                    stamp = one.header.stamp
                    row = (*place[:3, 3], *se3.quaternion_wxyz(place[:3, :3]))
                    found.append((stamp.sec * 10**9 + stamp.nanosec, tuple(map(float, row))))
        return found

    def gap(self) -> str:
        """Why there may be no rows, in terms of frames."""
        wanted = f"frames from {self._world} (parent) down to {self._body} (child)"
        if self._leads(self._world, self._body):
            return f"no {wanted}: {self._body} is the parent of {self._world} here (inverted)"
        return f"there are no moving {wanted}"

    def _leads(self, child: str, ancestor: str) -> bool:
        """Whether a frame is below another."""
        frame, steps = child, 0
        while frame != ancestor and frame in self._parents and steps < LONGEST_CHAIN:
            frame, steps = self._parents[frame][0], steps + 1
        return frame == ancestor
