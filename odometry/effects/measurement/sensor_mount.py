"""Where the reference sensor sits on the robot: away from its origin, or turned against it."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import EffectParameter, MeasurementEffect
from odometry.effects.interface.recorded import Reported
from odometry.effects.motion.lateral_skid import DISTINGUISHED_BY
from odometry.geometry import se2


class LeverArm(MeasurementEffect):
    """The measured position is that of a point ahead and to the left of the stated place."""

    name = "lever_arm"
    form = "constant"
    in_words = "a reference that sits elsewhere than stated"
    equation = "position -> position + R(yaw) (x_arm, y_arm)"
    source = "definition"
    looks_like = "sideways motion in turns, and distances that differ in left and right turns"
    remedy = (
        "measure where the sensor sits and state it in run.toml, [sensors]: x_arm and y_arm are "
        "added to what pose says there (nothing: 0, 0)"
    )
    of_reference = True
    alike: ClassVar[Mapping[str, str]] = {
        "lateral_skid": DISTINGUISHED_BY,
        "terrain": DISTINGUISHED_BY,
    }

    def same_as(self, values: FloatArray) -> Mapping[str, str]:  # noqa: ARG002 - of the interface
        """See `Effect.same_as`."""
        return {"lateral_skid": DISTINGUISHED_BY}

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (
            EffectParameter("x_arm", "m", -5.0, 5.0, 0.0, 0.01),
            EffectParameter("y_arm", "m", -5.0, 5.0, 0.0, 0.01),
        )

    def seen(
        self,
        values: FloatArray,
        poses: FloatArray,
        reported: Reported,  # noqa: ARG002
    ) -> FloatArray:
        """See `MeasurementEffect.seen`."""
        return _moved(poses, values)

    def robot_poses(self, values: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.robot_poses`."""
        return _moved(reported.poses, -values)


def _moved(poses: FloatArray, arm: FloatArray) -> FloatArray:
    """Poses (M, 3) with their positions moved by an arm (2,) in the robot frame."""
    return np.concatenate([se2.transform(poses, arm), poses[:, 2:]], axis=1)


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
    robot_alike = "a robot that always travels to one side of where it points"

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
