"""A receiver that reports the direction in which its antenna moves for the heading."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import EffectParameter
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.recorded import Reported
from odometry.effects.measurement.reference_filter import ReferenceFilter
from odometry.models.inputs import Inputs

BLURRED_M_S = 0.1  # the least speed


class CourseForYaw(ReferenceFilter):
    """The yaw is the course of a point ahead of the origin, where the robot is fast enough.

    It leaps as a turn begins and ends, when neither treads nor gyroscope turn as much.
    """

    form = "course_for_yaw"
    in_words = "a yaw of the reference that is the direction of its motion"
    equation = "yaw -> yaw + atan(ahead omega / v_x) where |v_x| > least"
    source = "course over ground of a point ahead of the origin"
    looks_like = "a yaw that leaps as turns begin and end, and sideways motion in them"
    remedy = "take the heading from two antennas, a compass or the gyroscope"
    needs = "a gyroscope, and curves"
    essential = ("ahead",)

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        return "" if inputs.yaw_rate_rad_s is not None else "a gyroscope"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (
            EffectParameter("ahead", "m", -2.0, 2.0, 0.0, 0.01),
            EffectParameter("least", "m/s", 0.02, 1.0, 0.2, 0.02, None, in_steps=True),
        )

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:  # noqa: ARG002 - of the interface
        """See `Effect.starts`."""
        return np.array([[ahead, least] for ahead in (-0.2, 0.2) for least in (0.1, 0.2, 0.4)])

    def resolution(self, values: FloatArray, inputs: Inputs) -> FloatArray:  # noqa: ARG002
        """See `Effect.resolution`: few turns are driven at about the least speed."""
        return np.array([0.0, BLURRED_M_S])

    def seen(self, values: FloatArray, poses: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.seen`."""
        if len(poses) < 2:
            return poses
        ahead, least = values
        x_m_s, y_m_s, omega = np.gradient(poses, reported.stamps_s, axis=0).T
        forward = x_m_s * np.cos(poses[:, 2]) + y_m_s * np.sin(poses[:, 2])
        is_fast = np.abs(forward) > least
        course = np.where(is_fast, np.arctan(ahead * omega / np.where(is_fast, forward, 1.0)), 0.0)
        return np.column_stack([poses[:, :2], poses[:, 2] + course])
