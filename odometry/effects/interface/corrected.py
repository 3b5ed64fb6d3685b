"""A kinematic model with effects added: the same face as any model."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import CommandEffect, Effect, MeasurementEffect, MotionEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.recorded import Reported
from odometry.models.base import KinematicModel, Linearised
from odometry.models.icr import IcrByTerrain
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot

RELATIVE_STEP = 1e-6


@dataclass(frozen=True)
class Added:
    """An effect with values (P,) of its parameters."""

    effect: Effect
    values: FloatArray

    @property
    def by_name(self) -> dict[str, float]:
        """Values by name."""
        names = [parameter.name for parameter in self.effect.parameters]
        return {name: float(value) for name, value in zip(names, self.values, strict=True)}

    @property
    def in_words(self) -> str:
        """The name that a roboticist would use."""
        return self.effect.in_words_at(self.values)


class Corrected(KinematicModel):
    """A base model, its parameters free, with effects on commands and motion held as they are.

    Samples of the inputs must be in time order. Effects on the measurement are no part of a
    motion; see `odometry.effects.measurement.measured`.
    """

    source = "a model of the catalogue with effects added"

    def __init__(self, base: KinematicModel, robot: Robot, effects: Sequence[Added]) -> None:
        self.base = base
        self.robot = robot
        self.effects = tuple(effects)
        self.name = "+".join([base.name, *(added.effect.name for added in self.effects)])
        self.parameters = base.parameters

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`; of stack (N,)."""
        base = Base(self.base, values, self.robot)
        return corrected_twist(base, self.effects, inputs)

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`.

        Effects on motion may depend on the base's parameters in any way: under these, the
        derivative is one by central differences.
        """
        if not any(isinstance(added.effect, MotionEffect) for added in self.effects):
            return self.base.linearised(values, with_true_speeds(self.effects, inputs))
        steps = RELATIVE_STEP * np.maximum(1.0, np.abs(values))
        columns = [
            (self.twist(values + step, inputs) - self.twist(values - step, inputs))
            / (2 * step.sum())
            for step in np.diag(steps)
        ]
        return Linearised(self.twist(values, inputs), np.stack(columns, axis=-1))

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`; that of the base."""
        return self.base.speed_jacobian(values, inputs)

    def guess(self, robot: Robot) -> dict[str, float]:
        """See `KinematicModel.guess`; that of the base."""
        return self.base.guess(robot)

    def ordinary_sizes(self, robot: Robot) -> FloatArray:
        """See `KinematicModel.ordinary_sizes`; those of the base."""
        return self.base.ordinary_sizes(robot)

    def check(self, values: FloatArray) -> None:
        """See `KinematicModel.check`; that of the base."""
        self.base.check(values)


def corrected_twist(base: Base, effects: Sequence[Added], inputs: Inputs) -> FloatArray:
    """Twist (N, 3) of the base under effects: those on commands first, then those on motion."""
    inputs = with_true_speeds(effects, inputs)
    twist = base.model.twist(base.values, inputs)
    for added in effects:
        if isinstance(added.effect, MotionEffect):
            twist = moved_twist(added.effect, added.values, twist, inputs, base)
    return twist


def moved_twist(
    effect: MotionEffect, values: FloatArray, twist: FloatArray, inputs: Inputs, base: Base
) -> FloatArray:
    """Twist (N, 3) with the effect beside the base as it is on the terrain of each sample."""
    if not isinstance(base.model, IcrByTerrain):
        return effect.twist(values, twist, inputs, base)
    first, *others = base.model.labels
    moved = effect.twist(values, twist, inputs, base.on(first))
    for label in others if inputs.terrain is not None else ():
        there = (np.asarray(inputs.terrain) == label)[:, None]
        moved = np.where(there, effect.twist(values, twist, inputs, base.on(label)), moved)
    return moved


def with_true_speeds(effects: Sequence[Added], inputs: Inputs) -> Inputs:
    """The inputs with the tread speeds that effects on commands make of the recorded ones."""
    for added in effects:
        if isinstance(added.effect, CommandEffect):
            speeds = added.effect.tread_speeds(added.values, inputs)
            inputs = replace(inputs, tread_speeds_m_s=speeds)
    return inputs


def delay_s(effects: Sequence[Added], stamps_s: FloatArray, run: int | None = None) -> FloatArray:
    """By how much (M,) all effects together make stamps of poses (M,), in run time, late.

    `run` is the number of the run, see `Reported.run`.
    """
    late_s = np.zeros_like(stamps_s)
    for added in effects:
        if isinstance(added.effect, MeasurementEffect):
            late_s = late_s + added.effect.delay_s(added.values, stamps_s, run)
    return late_s


def seen_poses(effects: Sequence[Added], poses: FloatArray, reported: Reported) -> FloatArray:
    """Poses (M, 3) as the reference sensor would report those of the robot.

    `reported` is what it did report, see `MeasurementEffect.seen`.
    """
    for added in effects:
        if isinstance(added.effect, MeasurementEffect):
            poses = added.effect.seen(added.values, poses, reported)
    return poses


def reported_yaw_rate(
    effects: Sequence[Added], yaw_rate_rad_s: FloatArray, inputs: Inputs
) -> FloatArray:
    """What the gyroscope would report (N,) of the yaw rate (N,) of the robot."""
    for added in effects:
        if isinstance(added.effect, MeasurementEffect):
            yaw_rate_rad_s = added.effect.gyroscope(added.values, yaw_rate_rad_s, inputs)
    return yaw_rate_rad_s
