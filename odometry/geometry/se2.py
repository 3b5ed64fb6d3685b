"""Rigid motions in the plane; a pose is (x, y, yaw) in metres and radians."""

import math

import numpy as np

from odometry.arrays import FloatArray, components_first, components_last
from odometry.geometry.angles import sine_and_cosine, wrap

NO_ANGLE = 1e-100  # below it quotients of angles would lose digits
SMALL_ANGLE = 1e-4  # below it slopes of sin(a)/a, (1-cos(a))/a come from series, right to 1e-13


def exp(displacement: FloatArray) -> FloatArray:
    """The pose reached by moving for one unit of time with a constant body twist.

    Parameters
    ----------
    displacement : (..., 3)
        v_x dt [m], v_y dt [m] and omega dt [rad], in the body frame at the start.

    Returns
    -------
    (..., 3)
        Pose at the end in the body frame at the start; yaw is not wrapped.
    """
    along, across, angle = components_first(np.asarray(displacement, dtype=np.float64))
    half = angle / 2
    chord = np.sinc(half / np.pi)  # it leads ahead by half the angle
    return _end(along, across, angle, chord * np.cos(half), chord**2 * half)


def quick_exp(displacement: FloatArray) -> FloatArray:
    """`exp` (..., 3), to some 1e-16, for many displacements (..., 3) at once."""
    along, across, angle = components_first(np.asarray(displacement, dtype=np.float64))
    half = angle / 2
    half_sine, half_cosine = sine_and_cosine(half)
    chord = _chord(half, half_sine)
    return _end(along, across, angle, chord * half_cosine, chord * half_sine)


def log(pose: FloatArray) -> FloatArray:
    """The constant displacement whose `exp` is a pose.

    Parameters
    ----------
    pose : (..., 3)
        Of the end in the body frame at the start; yaw is not wrapped, less than a whole turn.

    Returns
    -------
    (..., 3)
        v_x dt [m], v_y dt [m] and omega dt [rad].
    """
    x, y, angle = np.moveaxis(np.asarray(pose, dtype=np.float64), -1, 0)
    along, across = _rotate(x, y, -angle / 2)  # an arc ends half its angle aside of its start
    chord = np.sinc(angle / (2 * np.pi))
    return np.stack([along / chord, across / chord, angle], axis=-1)


def compose(first: FloatArray, second: FloatArray) -> FloatArray:
    """The pose `second`, given in the frame of `first`, in the frame of `first`'s parent."""
    first, second = np.asarray(first), np.asarray(second)
    x, y = _rotate(second[..., 0], second[..., 1], first[..., 2])
    return np.stack(
        [first[..., 0] + x, first[..., 1] + y, wrap(first[..., 2] + second[..., 2])], axis=-1
    )


def compose_one(first: FloatArray, second: FloatArray) -> FloatArray:
    """`compose` of two poses (3,), to the last bit, in a tenth of its time."""
    begin_x, begin_y, turn = first.tolist()
    x, y, yaw = second.tolist()
    cosine, sine = float(np.cos(turn)), float(np.sin(turn))  # their last bit is not that of math's
    angle = math.pi - (math.pi - (turn + yaw)) % (2 * math.pi)
    return np.array(
        [
            begin_x + (cosine * x - sine * y),
            begin_y + (sine * x + cosine * y),
            math.pi if angle == -math.pi else angle,
        ]
    )


def inverse(pose: FloatArray) -> FloatArray:
    """The parent's pose in the frame of `pose`."""
    pose = np.asarray(pose)
    x, y = _rotate(-pose[..., 0], -pose[..., 1], -pose[..., 2])
    return np.stack([x, y, wrap(-pose[..., 2])], axis=-1)


def between(first: FloatArray, second: FloatArray) -> FloatArray:
    """The pose of `second` in the frame of `first`, both given in one parent frame."""
    return compose(inverse(first), second)


def transform(pose: FloatArray, points: FloatArray) -> FloatArray:
    """Points (..., 2) of the frame of `pose` (..., 3), in its parent frame."""
    pose, points = np.asarray(pose), np.asarray(points)
    x, y = _rotate(points[..., 0], points[..., 1], pose[..., 2])
    moved = np.empty((*np.shape(x), 2))
    moved[..., 0] = pose[..., 0] + x
    moved[..., 1] = pose[..., 1] + y
    return moved


def _rotate(x: FloatArray, y: FloatArray, yaw: FloatArray) -> tuple[FloatArray, FloatArray]:
    cosine, sine = np.cos(yaw), np.sin(yaw)
    return cosine * x - sine * y, sine * x + cosine * y


def exp_jacobian(displacement: FloatArray) -> FloatArray:
    """Derivative (..., 3, 3) of `exp` by displacements (..., 3)."""
    return linearised_exp(displacement)[1]


def linearised_exp(displacement: FloatArray) -> tuple[FloatArray, FloatArray]:
    """`exp` (..., 3), to some 1e-16, and its derivative (..., 3, 3) by displacements (..., 3)."""
    along, across, angle = components_first(np.asarray(displacement, dtype=np.float64))
    half = angle / 2
    half_sine, half_cosine = sine_and_cosine(half)
    chord = _chord(half, half_sine)
    sine_ratio, cosine_ratio = chord * half_cosine, chord * half_sine
    sine = 2 * half_sine * half_cosine
    cosine = 1.0 - angle * cosine_ratio
    small = np.abs(angle) < SMALL_ANGLE
    safe = angle + small
    sine_slope = np.where(small, -angle / 3, (cosine - sine_ratio) / safe)
    cosine_slope = np.where(small, 0.5 - angle**2 / 8, (sine - cosine_ratio) / safe)
    jacobian = np.zeros((3, 3, *np.shape(angle)))
    jacobian[0, 0] = jacobian[1, 1] = sine_ratio
    jacobian[0, 1], jacobian[1, 0] = -cosine_ratio, cosine_ratio
    jacobian[0, 2] = sine_slope * along - cosine_slope * across
    jacobian[1, 2] = cosine_slope * along + sine_slope * across
    jacobian[2, 2] = 1.0
    end = _end(along, across, angle, sine_ratio, cosine_ratio)
    return end, np.moveaxis(jacobian, (0, 1), (-2, -1))


def _chord(half: FloatArray, half_sine: FloatArray) -> FloatArray:
    """Chord of an arc over its length, sin(half) / half: 1 without a turn."""
    straight = np.abs(half) < NO_ANGLE
    return np.asarray((half_sine + straight) / (half + straight))


def _end(
    along: FloatArray,
    across: FloatArray,
    angle: FloatArray,
    sine_ratio: FloatArray,
    cosine_ratio: FloatArray,
) -> FloatArray:
    """End of an arc, from sin(a)/a and (1 - cos(a))/a of its angle."""
    x = sine_ratio * along - cosine_ratio * across
    y = cosine_ratio * along + sine_ratio * across
    return components_last(np.stack([x, y, angle]))
