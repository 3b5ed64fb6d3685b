"""The footprint ahead, whole or by treads, and the share that an image shows (Chen 2023)."""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import inf

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se2
from odometry.run import Robot
from terrain.camera import Camera
from terrain.rectangle import Rectangle
from terrain.visible_terrain import is_visible

POINTS = 7  # along each side of the footprint; odd, so that its middle is one of them
TOGETHER = 100  # poses; the first that shows all is seldom far along
FEW = [0, POINTS - 1, POINTS**2 // 2, POINTS**2 - POINTS, POINTS**2 - 1]  # corners and middle


@dataclass(frozen=True)
class FootprintPart:
    """The footprint or one half of it: its middle (2,) in the robot frame, length and width."""

    middle_m: FloatArray
    length_m: float
    width_m: float

    def bounds(self, pose: FloatArray) -> Rectangle:
        """The rectangle round it at a pose (3,), along the axes of the robot frame now.

        Chen 2023 eq. 22.
        """
        sine, cosine = abs(np.sin(pose[2])), abs(np.cos(pose[2]))
        along_x = self.width_m * sine + self.length_m * cosine  # H_p
        along_y = self.width_m * cosine + self.length_m * sine  # L_p
        middle = se2.transform(pose, self.middle_m)
        return Rectangle.round(middle, np.array([along_x, along_y]) / 2)

    @cached_property
    def points(self) -> FloatArray:
        """Points spread over it (POINTS**2, 2), corners included, in the robot frame."""
        share = np.linspace(-0.5, 0.5, POINTS)
        points = np.stack(np.meshgrid(share * self.length_m, share * self.width_m), axis=-1)
        return np.asarray(self.middle_m + points.reshape(-1, 2))


def footprint_parts(robot: Robot, scale: float, *, per_tread: bool) -> tuple[FootprintPart, ...]:
    """The enlarged footprint, of length W_1 and width B_1, or its left and its right half."""
    length_m = scale * (robot.length or robot.track_width)
    width_m = scale * (robot.width or robot.track_width)
    return _parts_of(length_m, width_m, per_tread)


@lru_cache(maxsize=16)
def _parts_of(length_m: float, width_m: float, per_tread: bool) -> tuple[FootprintPart, ...]:
    if not per_tread:
        return (FootprintPart(np.zeros(2), length_m, width_m),)
    aside = np.array([0.0, width_m / 4])
    return FootprintPart(aside, length_m, width_m / 2), FootprintPart(-aside, length_m, width_m / 2)


def visible_shares(
    camera: Camera, poses: FloatArray, parts: tuple[FootprintPart, ...], coarsest_m: float = inf
) -> FloatArray:
    """The visible share (N,) of the parts at poses (N, 3), 0 where a middle is not visible.

    Of several parts the smallest share.
    """
    shares = np.ones(len(poses))
    for part in parts:
        shown = is_visible(camera, se2.transform(poses[:, None], part.points), coarsest_m)
        shares = np.minimum(shares, shown[:, POINTS**2 // 2] * shown.mean(axis=1))
    return shares


def first_whole(
    camera: Camera, poses: FloatArray, parts: tuple[FootprintPart, ...], coarsest_m: float
) -> int | None:
    """The first of poses (N, 3) at which all points of all parts are visible."""
    points = np.concatenate([part.points for part in parts])
    few = np.concatenate([part.points[FEW] for part in parts])
    for start in range(0, len(poses), TOGETHER):
        tried = poses[start : start + TOGETHER]
        places = se2.transform(tried[:, None], few)
        inside = np.flatnonzero(is_visible(camera, places).all(axis=1))
        for place in inside[is_visible(camera, places[inside], coarsest_m).all(axis=1)]:
            if is_visible(camera, se2.transform(tried[place], points), coarsest_m).all():
                return start + int(place)
    return None
