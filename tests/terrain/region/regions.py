"""A robot, its cameras, and the geometry of a region worked out without the packages."""

import numpy as np
from hypothesis import strategies as st

from odometry.recording.run import Robot
from terrain.camera.camera import Camera

ROBOT = Robot(track_width=0.4, length=0.6, width=0.5)


MATRIX = [[300.0, 0.0, 320.0], [0.0, 300.0, 240.0], [0.0, 0.0, 1.0]]


MOUNT = [0.3, 0.0, 0.9, 0.0, 0.8, 0.0]


AHEAD = Camera.from_mount((640, 480), MATRIX, [], MOUNT)


ALL_ROUND = Camera.from_mount(  # 200 m above, looking down: every place that is near lies in it
    (640, 480), MATRIX, [], [0.0, 0.0, 200.0, 0.0, np.pi / 2, 0.0]
)


speeds = st.floats(-2.0, 2.0)


twists = st.tuples(speeds, st.floats(-0.5, 0.5), st.floats(-1.5, 1.5)).map(np.array)


def moved_by_small_steps(twist, duration_s, steps=20_000):
    """Place and heading by Euler's midpoint rule in the plane, without sine or cosine ratios."""
    step_s = duration_s / steps
    yaw = twist[2] * step_s * (np.arange(steps) + 0.5)
    x = np.sum(twist[0] * np.cos(yaw) - twist[1] * np.sin(yaw)) * step_s
    y = np.sum(twist[0] * np.sin(yaw) + twist[1] * np.cos(yaw)) * step_s
    return np.array([x, y, twist[2] * duration_s])


def box_round_footprint(pose, length, width):
    """Least and largest x and y of the corners of a turned rectangle, one corner at a time."""
    corners = []
    for along in (-length / 2, length / 2):
        for across in (-width / 2, width / 2):
            x = pose[0] + along * np.cos(pose[2]) - across * np.sin(pose[2])
            y = pose[1] + along * np.sin(pose[2]) + across * np.cos(pose[2])
            corners.append((x, y))
    return np.min(corners, axis=0), np.max(corners, axis=0)


def outline(rectangle, points_a_side=1000):
    """Points round a rectangle."""
    part = np.linspace(0.0, 1.0, points_a_side)
    x = rectangle.x_min + part * (rectangle.x_max - rectangle.x_min)
    y = rectangle.y_min + part * (rectangle.y_max - rectangle.y_min)
    one = np.ones(points_a_side)
    sides = [(x, rectangle.y_min * one), (x, rectangle.y_max * one)]
    sides += [(rectangle.x_min * one, y), (rectangle.x_max * one, y)]
    return np.concatenate([np.column_stack(side) for side in sides])


def pixels_outside(camera, rectangle):
    """How many pixels the outline of a rectangle lies outside the image, at its worst."""
    pixels = camera.ground_to_pixels(outline(rectangle))
    beyond = np.concatenate([-pixels, pixels - (np.array(camera.image_size) - 1)])
    return np.inf if np.isnan(beyond).any() else beyond.max()


def corners_of_footprint(pose, length, width):
    """Corners (4, 2) of a turned rectangle."""
    x, y, yaw = pose
    turn = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    ends = [(1, 1), (1, -1), (-1, -1), (-1, 1)]
    return np.array(ends) * [length / 2, width / 2] @ turn + [x, y]


def pose_on_circle(travel_m, curvature):
    """Where a robot is that drives along a circle."""
    yaw = curvature * travel_m
    chord = 2 * np.sin(yaw / 2) / curvature if abs(curvature) > 1e-9 else travel_m
    return np.array([chord * np.cos(yaw / 2), chord * np.sin(yaw / 2), yaw])


def seen(camera, points):
    """Whether the image holds points (..., 2)."""
    u, v = np.moveaxis(camera.ground_to_pixels(points), -1, 0)
    width, height = camera.image_size
    return (u >= 0) & (u <= width - 1) & (v >= 0) & (v <= height - 1)
