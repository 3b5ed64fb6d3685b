"""Where terrain that a ray meets is in the image after the robot has moved, and its derivatives."""

from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se3
from odometry.geometry.se3 import OPTICAL_FROM_CAMERA

LEAST_SLOPE, LEAST_DEPTH_M = 1e-3, 1e-3


def carried_rays(
    rays: FloatArray, values: FloatArray, place_m: FloatArray, steps: FloatArray
) -> FloatArray:
    """Normalised image coordinates (N, 2) after the steps of points of the terrain at `rays`.

    Parameters
    ----------
    rays : (N, 2)
        Normalised, without distortion, before the steps.
    values : (4,)
        z [m], roll, pitch, yaw [rad] of the mount.
    place_m : (2,)
        x and y of the mount.
    steps : (N, 3) or (3,)
        Motion of the robot: x, y [m], yaw [rad].

    Returns
    -------
    (N, 2)
        NaN for rays that do not meet the terrain, or are then behind the camera.
    """
    return _carried(rays, values, place_m, steps).coordinates


def carried_derivatives(
    rays: FloatArray, values: FloatArray, place_m: FloatArray, steps: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """`carried_rays`, and its derivative (N, 2, 7) by `values` and by x, y, yaw of each step."""
    here = _carried(rays, values, place_m, steps)
    rotation, angles = here.robot_from_optical, values[1:]
    down, height_m = -here.directions[:, 2], values[0]
    sine, cosine = np.sin(steps[..., 2]), np.cos(steps[..., 2])

    def turned(ground: FloatArray) -> FloatArray:
        """A change (N, 2) on the ground, in the robot frame after the steps; z is 0."""
        x = cosine * ground[:, 0] + sine * ground[:, 1]
        y = -sine * ground[:, 0] + cosine * ground[:, 1]
        return np.column_stack([x, y, np.zeros(len(x))])

    by_height = turned(here.directions[:, :2] / down[:, None]) - np.array([0.0, 0.0, 1.0])
    columns = [by_height @ rotation]
    for axis in _axes(angles):
        change = np.cross(axis, here.directions)
        across = change[:, :2] + here.directions[:, :2] * (change[:, 2] / down)[:, None]
        moved = turned(across * (height_m / down)[:, None])
        columns.append((moved - np.cross(axis, here.points_m)) @ rotation)
    x, y = (here.points_m[:, :2] + place_m).T
    none = np.zeros_like(x)
    columns += [
        np.column_stack(np.broadcast_arrays(*by_step, none)) @ rotation
        for by_step in ((-cosine, sine), (-sine, -cosine), (y, -x))
    ]
    changes = np.stack(columns, axis=-1)  # (N, 3, 7), in the optical frame
    sideways = here.coordinates[:, :, None] * changes[:, 2:]
    return here.coordinates, (changes[:, :2] - sideways) / here.depth_m[:, None, None]


class _Carried(NamedTuple):
    """Rays (N, 2) that were carried, and what lies on the way."""

    coordinates: FloatArray  # (N, 2)
    robot_from_optical: FloatArray  # (3, 3)
    directions: FloatArray  # (N, 3), of the rays in the robot frame; NaN: not down
    points_m: FloatArray  # (N, 3), from the camera in the robot frame after the steps
    depth_m: FloatArray  # (N,)


def _carried(
    rays: FloatArray, values: FloatArray, place_m: FloatArray, steps: FloatArray
) -> _Carried:
    robot_from_optical = se3.rotation_from_roll_pitch_yaw(values[1:]) @ OPTICAL_FROM_CAMERA.T
    directions = rays @ robot_from_optical[:, :2].T + robot_from_optical[:, 2]
    down = np.where(directions[:, 2] < -LEAST_SLOPE, -directions[:, 2], np.nan)
    ground_m = place_m + directions[:, :2] * (values[0] / down)[:, None]
    moved = ground_m - steps[..., :2]
    sine, cosine = np.sin(steps[..., 2]), np.cos(steps[..., 2])
    x = cosine * moved[:, 0] + sine * moved[:, 1] - place_m[0]
    y = -sine * moved[:, 0] + cosine * moved[:, 1] - place_m[1]
    points_m = np.column_stack([x, y, np.full(len(x), -values[0])])
    seen = points_m @ robot_from_optical
    depth = np.where(seen[:, 2] > LEAST_DEPTH_M, seen[:, 2], np.nan)
    coordinates = np.asarray(seen[:, :2] / depth[:, None])
    return _Carried(coordinates, robot_from_optical, directions, points_m, depth)


def _axes(angles: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Axes in the robot frame about which more roll, pitch and yaw turn the camera."""
    _, pitch, yaw = angles.tolist()
    ahead = np.array([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), -np.sin(pitch)])
    return ahead, np.array([-np.sin(yaw), np.cos(yaw), 0.0]), np.array([0.0, 0.0, 1.0])
