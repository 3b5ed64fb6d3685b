"""A reference sensor that is turned against the robot."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import EffectParameter, MeasurementEffect
from odometry.effects.reported import Reported


class HeadingOffset(MeasurementEffect):
    """The measured yaw is off by a constant angle."""

    name = "heading_offset"
    form = "constant"
    in_words = "a reference that is turned against the robot"
    equation = "yaw -> yaw + offset"
    source = "definition"
    looks_like = "straights on which the robot seems to drift to one side, forward and backward"
    remedy = "turn the sensor, or its frame, by the angle; then the yaw is the robot's"
    of_reference = True

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("offset", "rad", -3.2, 3.2, 0.0, 0.01),)

    def seen(
        self,
        values: FloatArray,
        poses: FloatArray,
        reported: Reported,  # noqa: ARG002
    ) -> FloatArray:
        """See `MeasurementEffect.seen`."""
        return np.asarray(poses + np.array([0.0, 0.0, values[0]]))

    def robot_poses(self, values: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.robot_poses`."""
        return np.asarray(reported.poses - np.array([0.0, 0.0, values[0]]))
