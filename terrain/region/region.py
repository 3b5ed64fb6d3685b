"""The region that the robot will drive over: the terrain to classify (Chen 2023, 3.2.2)."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import inf

import numpy as np

from odometry.arrays import FloatArray
from odometry.config import require, require_positive
from odometry.geometry import se2
from odometry.recording.run import Robot
from terrain.camera.camera import Camera
from terrain.region.footprint_parts import (
    FootprintPart,
    Rectangle,
    first_whole,
    footprint_parts,
    largest_visible,
    visible_shares,
)

__all__ = ["NoRegion", "Rectangle", "Region", "RegionConfig", "predict_region"]

STEPS = 200  # places along the predicted motion
GRADES = 4  # of the visible share, from all of the footprint to the least share
TRIES = 10  # places with the same share that are tested for one that can be classified
COARSE = "the image is too coarse there"


@dataclass(frozen=True)
class RegionConfig:
    """Settings of the region.

    Attributes
    ----------
    footprint_scale : float
        The footprint is made larger by this factor (Chen 2023: 1.2).
    ahead_s : float
        How far ahead in time; 0 means the smallest for which all of the footprint is visible,
        or else as much of it as possible.
    least_share : float
        There is no region unless the image shows the middle of the footprint and so much of it.
    most_ahead_s, most_ahead_lengths : float
        Limits of that search, in time and in robot lengths of wheel travel.
    coarsest : float
        The image may resolve the region this much more coarsely than the training patches.
    per_tread : bool
        Classify the terrain of the left and of the right tread apart: the two halves of the
        footprint.
    """

    footprint_scale: float = 1.2
    ahead_s: float = 0.0
    least_share: float = 0.4
    most_ahead_s: float = 60.0
    most_ahead_lengths: float = 6.0
    coarsest: float = 2.5
    per_tread: bool = False

    def __post_init__(self) -> None:
        require_positive(self, "footprint_scale", "most_ahead_s", "most_ahead_lengths", "coarsest")
        if self.ahead_s != 0:
            require_positive(self, "ahead_s")
        require(
            0 < self.least_share <= 1, f"least_share = {self.least_share}, expected above 0, to 1"
        )


@dataclass(frozen=True)
class Region:
    """The terrain under the robot some time ahead.

    Attributes
    ----------
    rectangles : tuple of Rectangle
        The terrain to classify: the largest rectangle that the image shows of the rectangle
        round the footprint; with `per_tread`, of those round its left and its right half.
    ahead_s : float
    distance_ahead_m : float
        Wheel travel until the robot is there.
    pose_ahead : (3,)
        The robot then, in the robot frame now.
    """

    rectangles: tuple[Rectangle, ...]
    ahead_s: float
    distance_ahead_m: float
    pose_ahead: FloatArray

    @property
    def place(self) -> FloatArray:
        """The middle (2,) of the terrain to classify, in the robot frame now [m]."""
        return self.rectangle.middle

    @property
    def rectangle(self) -> Rectangle:
        """Round all of `rectangles`."""
        corners = np.concatenate([rectangle.corners for rectangle in self.rectangles])
        low, high = corners.min(axis=0), corners.max(axis=0)
        return Rectangle(float(low[0]), float(high[0]), float(low[1]), float(high[1]))


@dataclass(frozen=True)
class NoRegion:
    """Why there is no region.

    Attributes
    ----------
    reason : str
        In words, without a capital and a full stop.
    """

    reason: str


def predict_region(
    robot: Robot,
    camera: Camera,
    twist: FloatArray,
    wheel_speed_m_s: float,
    config: RegionConfig,
    *,
    coarsest_m: float = inf,
    scale_mismatch: Callable[[Rectangle], str] = lambda _: "",
) -> Region | NoRegion:
    """Move the footprint ahead until it is visible, and keep the part of it that the image shows.

    Parameters
    ----------
    robot : Robot
        Length and width default to the track width.
    camera : Camera
    twist : (3,)
        Body twist that is predicted at the commanded tread speeds.
    wheel_speed_m_s : float
        Mean of |v_left| and |v_right|.
    config : RegionConfig
    coarsest_m : float
        Terrain of which a pixel covers more than this counts as not visible.
    scale_mismatch : callable
        Why a rectangle cannot be classified, or ""; the region is the first that can.

    Returns
    -------
    Region or NoRegion
    """
    if wheel_speed_m_s <= 0:
        return NoRegion("the robot is stationary")
    ahead_s = _times_ahead_s(robot, wheel_speed_m_s, config)
    poses = se2.exp(twist * ahead_s[:, None])
    parts = footprint_parts(robot, config.footprint_scale, per_tread=config.per_tread)
    reasons = []
    for place in _places(camera, poses, parts, coarsest_m, config.least_share):
        rectangles = [
            largest_visible(camera, part.bounds(poses[place]), coarsest_m) for part in parts
        ]
        reasons = [reason for reason in map(scale_mismatch, rectangles) if reason]
        if not reasons:
            time_s, pose = float(ahead_s[place]), poses[place].copy()  # not a view of all of them
            return Region(tuple(rectangles), time_s, wheel_speed_m_s * time_s, pose)
    if reasons:
        return NoRegion(reasons[0])
    in_image = visible_shares(camera, poses, parts) >= config.least_share
    return NoRegion(COARSE if in_image.any() else "the region lies outside the image")


def _times_ahead_s(robot: Robot, wheel_speed_m_s: float, config: RegionConfig) -> FloatArray:
    if config.ahead_s > 0:
        return np.array([config.ahead_s])
    length_m = robot.length or robot.track_width
    latest_s = min(config.most_ahead_s, config.most_ahead_lengths * length_m / wheel_speed_m_s)
    return np.linspace(0.0, latest_s, STEPS)


def _places(
    camera: Camera,
    poses: FloatArray,
    parts: tuple[FootprintPart, ...],
    coarsest_m: float,
    least_share: float,
) -> Iterator[int]:
    """Places to try: the first ones where all is visible, then where less is, to the least.

    Usually the first one is enough, and the search ends there.
    """
    first = first_whole(camera, poses, parts, coarsest_m)
    if first is not None:
        yield first
    shares = visible_shares(camera, poses, parts, coarsest_m)
    tried = first is not None
    for share in np.linspace(1.0, least_share, GRADES):
        places = np.flatnonzero(shares >= share - 1e-9)
        yield from places[:: max(1, -(-len(places) // TRIES))][tried:]
        tried = False
