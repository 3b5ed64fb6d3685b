"""Poses of a robot from the transforms of /tf."""

from typing import Any

from odometry.bags.transforms import Transforms, matrix_of, plain_frame
from odometry.geometry import se3

Row = tuple[float, ...]


class TransformPoses:
    """Poses of a frame in a world frame, one whenever the frame itself has moved.

    Between them may lie others, as odom is between map and the robot: each is taken as it was
    told last.
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
                if place is not None and self._is_above():
                    stamp = one.header.stamp
                    row = (*place[:3, 3], *se3.quaternion_wxyz(place[:3, :3]))
                    found.append((stamp.sec * 10**9 + stamp.nanosec, tuple(map(float, row))))
        return found

    def _is_above(self) -> bool:
        """Whether the world is an ancestor of the body."""
        frame, steps = self._body, 0
        while frame != self._world and frame in self._parents and steps < 100:
            frame, steps = self._parents[frame][0], steps + 1
        return frame == self._world
