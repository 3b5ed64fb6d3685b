"""Where the robot will be: the piece of ground to classify (Chen 2023, 3.2.2)."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.config import require_positive
from odometry.geometry import se2
from odometry.run import Robot
from terrain.camera import Camera

STEPS = 400  # places tried along the predicted motion
SIDE_POINTS = 8  # points tried on each side of the rectangle


@dataclass(frozen=True)
class RegionConfig:
    """Settings of the region.

    Attributes
    ----------
    footprint_scale : float
        The footprint is made larger by this factor (Chen 2023: 1.2).
    ahead_s : float
        How far ahead in time; 0 means the smallest for which the region lies in the image.
    most_ahead_s, most_ahead_lengths : float
        Limits of that search, in time and in robot lengths of wheel travel.
    coarsest : float
        The image may resolve the region this much more coarsely than the training patches.
    per_tread : bool
        Classify the ground of the left and of the right tread apart: the two halves of the
        footprint.
    """

    footprint_scale: float = 1.2
    ahead_s: float = 0.0
    most_ahead_s: float = 60.0
    most_ahead_lengths: float = 6.0
    coarsest: float = 2.5
    per_tread: bool = False

    def __post_init__(self) -> None:
        require_positive(self, "footprint_scale", "most_ahead_s", "most_ahead_lengths", "coarsest")
        if self.ahead_s != 0:
            require_positive(self, "ahead_s")


@dataclass(frozen=True)
class Rectangle:
    """A rectangle on the ground, its sides along the axes of the robot frame now [m]."""

    x_min: float
    x_max: float
    y_min: float
    y_max: float

    @property
    def corners(self) -> FloatArray:
        """Corners (4, 2), far left first, clockwise as seen in the image."""
        return np.array(
            [
                [self.x_max, self.y_max],
                [self.x_max, self.y_min],
                [self.x_min, self.y_min],
                [self.x_min, self.y_max],
            ]
        )


@dataclass(frozen=True)
class Region:
    """The ground under the robot some time ahead.

    Attributes
    ----------
    rectangle : Rectangle
        Round the footprint.
    tread_rectangles : (Rectangle, Rectangle)
        Round its left and its right half.
    ahead_s : float
    distance_ahead_m : float
        Wheel travel until the robot is there.
    pose_ahead : (3,)
        The robot then, in the robot frame now.
    """

    rectangle: Rectangle
    tread_rectangles: tuple[Rectangle, Rectangle]
    ahead_s: float
    distance_ahead_m: float
    pose_ahead: FloatArray


def predict_region(
    robot: Robot, camera: Camera, twist: FloatArray, wheel_speed_m_s: float, config: RegionConfig
) -> Region | str:
    """Carry the footprint ahead, put a rectangle round it, and see that the image holds it.

    Parameters
    ----------
    robot : Robot
        Length and width default to the track width.
    camera : Camera
    twist : (3,)
        Body twist by the current ICRs and the commanded tread speeds.
    wheel_speed_m_s : float
        Mean of |v_left| and |v_right|.
    config : RegionConfig

    Returns
    -------
    Region or str
        The reason in words where there is no region.
    """
    if wheel_speed_m_s <= 0:
        return "the robot stands"
    length = robot.length or robot.track_width
    latest_s = min(config.most_ahead_s, config.most_ahead_lengths * length / wheel_speed_m_s)
    if config.ahead_s > 0:
        ahead_s = np.array([config.ahead_s])
    else:
        ahead_s = np.linspace(0.0, latest_s, STEPS)
    poses = se2.exp(twist * ahead_s[:, None])
    footprint = _footprint(robot, config.footprint_scale)
    half_sizes = _half_sizes(footprint, poses[:, 2])
    low, high = poses[:, :2] - half_sizes, poses[:, :2] + half_sizes
    seen = camera.in_image(camera.ground_to_pixels(_outline(low, high))).all(axis=1)
    if not seen.any():
        return "the region lies outside the image"
    first = int(seen.argmax())
    time_s = float(ahead_s[first])
    return Region(
        _rectangle(poses[first, :2], half_sizes[first]),
        _tread_rectangles(poses[first], footprint),
        time_s,
        wheel_speed_m_s * time_s,
        poses[first],
    )


def _footprint(robot: Robot, scale: float) -> tuple[float, float]:
    """Length W_1 and width B_1 of the enlarged footprint."""
    return scale * (robot.length or robot.track_width), scale * (robot.width or robot.track_width)


def _rectangle(centre: FloatArray, half_size: FloatArray) -> Rectangle:
    (x_min, y_min), (x_max, y_max) = centre - half_size, centre + half_size
    return Rectangle(float(x_min), float(x_max), float(y_min), float(y_max))


def _tread_rectangles(
    pose: FloatArray, footprint: tuple[float, float]
) -> tuple[Rectangle, Rectangle]:
    """Rectangles round the left and the right half of the footprint at a pose (3,)."""
    length, width = footprint
    half_size = _half_sizes((length, width / 2), pose[2])
    left, right = se2.transform(pose, np.array([[0.0, width / 4], [0.0, -width / 4]]))
    return _rectangle(left, half_size), _rectangle(right, half_size)


def _half_sizes(footprint: tuple[float, float], yaw: FloatArray) -> FloatArray:
    """Half the sides (..., 2) of the bounding rectangle along x and y (eq. 22)."""
    length, width = footprint
    sine, cosine = np.abs(np.sin(yaw)), np.abs(np.cos(yaw))
    along_x = width * sine + length * cosine  # H_p
    along_y = width * cosine + length * sine  # L_p
    return np.stack([along_x, along_y], axis=-1) / 2


def _outline(low: FloatArray, high: FloatArray) -> FloatArray:
    """Points (N, 4 * SIDE_POINTS, 2) round each rectangle: a curved lens makes sides bulge."""
    rising = np.arange(SIDE_POINTS) / SIDE_POINTS
    start, end = np.zeros(SIDE_POINTS), np.ones(SIDE_POINTS)
    x = np.concatenate([rising, end, 1 - rising, start])
    y = np.concatenate([start, rising, end, 1 - rising])
    return np.asarray(low[:, None] + np.stack([x, y], axis=-1) * (high - low)[:, None])
