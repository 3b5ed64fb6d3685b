"""Faults of the reference sensor that follow the heading."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import EffectParameter, MeasurementEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.recorded import Reported
from odometry.models.inputs import Inputs

ROUNDS = 50  # of the inverse: each shrinks its error by the size of the distortion
SETTLED_RAD = 1e-14

SECTORS, LEAST_SECTORS = 12, 6  # of the circle, and in how many of them the robot must look
FEW_HEADINGS = "headings over half a turn"
LEAST_SHARE = 0.01  # of the samples, in a sector


class Compass(MeasurementEffect):
    """Iron on the robot distorts the measured yaw: an error of one wave a turn."""

    name = "reference_fault"
    form = "compass"
    in_words = "a compass that iron deflects"
    equation = "yaw -> yaw + a cos(yaw) + b sin(yaw)"
    source = "hard-iron error, to first order"
    looks_like = "turns that come out short towards one direction and long towards the opposite"
    remedy = "calibrate the compass on the robot, away from steel and motors"
    needs = "headings over half a turn or more: on a straight a wave is a constant or a drift"
    of_reference = True

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        return all_round(inputs)

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`; bounds keep the error less than one turn's own."""
        return (
            EffectParameter("a", "rad", -0.6, 0.6, 0.0, 0.01),
            EffectParameter("b", "rad", -0.6, 0.6, 0.0, 0.01),
        )

    def seen(self, values: FloatArray, poses: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.seen`: the error at the true heading, which follows from yaw."""
        bent = np.zeros_like(poses)
        bent[:, 2] = reported.yaw_rad - _true_yaw(values, reported.yaw_rad)
        return np.asarray(poses + bent)

    def robot_poses(self, values: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.robot_poses`."""
        true_yaw = _true_yaw(values, reported.yaw_rad)
        return np.concatenate([reported.poses[:, :2], true_yaw[:, None]], axis=1)


def _true_yaw(values: FloatArray, measured_rad: FloatArray) -> FloatArray:
    """Yaw (M,) whose bent one is (M,), by fixed-point iteration: |a| + |b| < 1.2 of slope."""
    yaw_rad = measured_rad
    for _ in range(ROUNDS):
        before = yaw_rad
        yaw_rad = measured_rad - values[0] * np.cos(yaw_rad) - values[1] * np.sin(yaw_rad)
        if np.abs(yaw_rad - before).max(initial=0.0) < SETTLED_RAD:
            break
    return np.asarray(yaw_rad)


def all_round(inputs: Inputs) -> str:
    """What is lacking: headings over half a turn or more; "" where there are."""
    if inputs.heading_rad is None:
        return "headings"
    sector = np.floor(inputs.heading_rad / (2 * np.pi) * SECTORS) % SECTORS
    shares = np.bincount(sector.astype(np.int64), minlength=SECTORS) / len(sector)
    enough = np.count_nonzero(shares >= LEAST_SHARE) >= LEAST_SECTORS
    return "" if enough else FEW_HEADINGS
