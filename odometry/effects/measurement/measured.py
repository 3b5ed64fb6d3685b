"""Effects on the measurement undone: a run whose measured poses are those of the robot."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import MeasurementEffect
from odometry.effects.interface.corrected import Added, delay_s
from odometry.effects.interface.recorded import Reported
from odometry.effects.measurement.sensor_mount import LeverArm
from odometry.errors import ParameterError
from odometry.geometry.angles import wrap
from odometry.recording.run import Run

POSE_NAMES = ("x", "y", "yaw")


def on_measurement(effects: Sequence[Added]) -> tuple[Added, ...]:
    """Those of the effects that act on the measured pose."""
    return tuple(added for added in effects if isinstance(added.effect, MeasurementEffect))


def shared_measurement(groups: Sequence[Sequence[Added]]) -> tuple[Added, ...]:
    """The effects on the measurement that all groups have: they are of one sensor.

    Raises
    ------
    ParameterError
        If two groups differ in them.
    """
    first, *others = [on_measurement(group) for group in groups] or [()]
    for other in others:
        if _words(other) != _words(first):
            raise ParameterError(
                f"effects on the measurement: {_words(first)} on one terrain, {_words(other)} on "
                "another; expected those of one sensor"
            )
    return first


def robot_poses(effects: Sequence[Added], reported: Reported) -> FloatArray:
    """Poses (M, 3) of the robot from those that the sensor reports: the inverse of `seen_poses`."""
    for added in reversed(effects):
        if isinstance(added.effect, MeasurementEffect):
            reported = reported.of(added.effect.robot_poses(added.values, reported))
    return reported.poses


def robot_run(run: Run, effects: Sequence[Added]) -> Run:
    """The run with the poses of the robot in place of those that its sensor reports.

    The lever arm that `[sensors]` states is undone first, and is stated no more. Stamps become
    those at which the poses were measured: each is moved by its delay. A run without poses,
    and one whose sensor has no such effect and no lever arm, is the run itself.
    """
    stated = run.sensors.pose_m
    if run.pose is None or not (stated or on_measurement(effects)):
        return run
    stamps_s = run.pose.stamps_s - run.odometry.stamps_s[0]
    reported = Reported(stamps_s, run.pose.stack(*POSE_NAMES))
    if stated is not None:
        reported = reported.of(LeverArm().robot_poses(np.array(stated[:2]), reported))
    poses = robot_poses(effects, reported)
    poses[:, 2] = wrap(poses[:, 2])
    columns = {
        **run.pose.columns,
        "t": run.pose.stamps_s - delay_s(effects, stamps_s),
        **dict(zip(POSE_NAMES, np.ascontiguousarray(poses.T), strict=True)),
    }
    sensors = {
        key: value for key, value in run.settings.get("sensors", {}).items() if key != "pose"
    }
    settings = {**run.settings, "sensors": sensors}
    return replace(run, settings=settings, pose=replace(run.pose, columns=columns))


def _words(effects: Sequence[Added]) -> str:
    return " and ".join(f"{added.effect.name} {added.by_name}" for added in effects) or "none"
