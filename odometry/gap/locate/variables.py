"""What a gap may depend on: one value a window of each variable that was recorded."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added, corrected_twist
from odometry.geometry.angles import wrap
from odometry.recording.run import UNKNOWN
from odometry.windows.dense.dense import DenseWindows

CREEPING_M_S = 0.05  # below this forward speed a curvature is taken as at it
STRAIGHT_RAD_S = 0.05  # windows of slower turns are straight
CONSTANT = 1e-6  # a variable that varies less than this is left out

SCALAR, ANGLE, LABEL = "scalar", "angle", "label"


@dataclass(frozen=True)
class Variable:
    """One value a window.

    Attributes
    ----------
    name, unit : str
    kind : str
        "scalar", "angle" (radians on the circle) or "label".
    values : (K of all scenes,)
    """

    name: str
    unit: str
    kind: str
    values: AnyArray


def window_variables(
    base: Base, effects: Sequence[Added], scenes: Sequence[DenseWindows]
) -> tuple[Variable, ...]:
    """Variables that were recorded in every scene and are not constant.

    Means over the window, by the motion of the simulation where motion is meant:

    - speed: of the treads, (v_left + v_right) / 2; speed_difference: |v_right - v_left|;
    - omega: yaw rate; curvature: omega by the forward speed; turn: left, straight or right;
    - lateral_acceleration: forward speed times yaw rate;
    - roll, pitch (nose down is positive);
    - terrain: its name at the middle.

    At the middle of the window: heading, left_wheel_angle and right_wheel_angle. time: run time
    at its start. speed_before: of the treads, in force just before it (the previous command);
    speed_change: that at its end less speed_before.
    """
    of_scenes = [_of_scene(base, effects, scene) for scene in scenes]
    shared = [v for v in of_scenes[0] if all(v.name in {w.name for w in o} for o in of_scenes)]
    pooled = []
    for variable in shared:
        values = np.concatenate(
            [w.values for of_scene in of_scenes for w in of_scene if w.name == variable.name]
        )
        if _varies(values, variable.kind):
            pooled.append(Variable(variable.name, variable.unit, variable.kind, values))
    return tuple(pooled)


def _varies(values: AnyArray, kind: str) -> bool:
    if kind == LABEL:
        return len(np.unique(values)) > 1
    return len(values) > 0 and bool(np.ptp(values) > CONSTANT)


def _of_scene(base: Base, effects: Sequence[Added], scene: DenseWindows) -> list[Variable]:
    inputs, means = scene.inputs, _Means(scene)
    twist = corrected_twist(base, effects, inputs)
    treads = (inputs.left + inputs.right) / 2
    forward, omega = means.of(twist[:, 0]), means.of(twist[:, 2])
    sign = np.where(forward < 0, -1.0, 1.0)
    before = treads[np.maximum(means.first - 1, 0)]
    found = [
        Variable("speed", "m/s", SCALAR, means.of(treads)),
        Variable("omega", "rad/s", SCALAR, omega),
        Variable(
            "curvature", "1/m", SCALAR, omega / (sign * np.maximum(np.abs(forward), CREEPING_M_S))
        ),
        Variable("turn", "", LABEL, _turns(omega)),
        Variable("roll", "rad", SCALAR, means.of(inputs.roll_rad)),
        Variable("pitch", "rad", SCALAR, means.of(inputs.pitch_rad)),
        Variable("lateral_acceleration", "m/s^2", SCALAR, means.of(twist[:, 0] * twist[:, 2])),
        Variable("speed_difference", "m/s", SCALAR, means.of(np.abs(inputs.right - inputs.left))),
        Variable("time", "s", SCALAR, scene.start_s),
        Variable("speed_before", "m/s", SCALAR, before),
        Variable("speed_change", "m/s", SCALAR, treads[np.maximum(means.last - 1, 0)] - before),
    ]
    if inputs.heading_rad is not None:
        found.append(Variable("heading", "rad", ANGLE, means.middle(inputs.heading_rad)))
    if inputs.wheel_angles_rad is not None:
        for side, angle in zip(("left", "right"), inputs.wheel_angles_rad.T, strict=True):
            found.append(Variable(f"{side}_wheel_angle", "rad", ANGLE, means.middle(angle)))
    if inputs.terrain is not None:
        labels = inputs.terrain.astype(str)[(means.first + means.last) // 2]
        found.append(Variable("terrain", "", LABEL, np.where(labels == "", UNKNOWN, labels)))
    return found


def _turns(omega_rad_s: FloatArray) -> AnyArray:
    turns = np.full(len(omega_rad_s), "straight")
    turns[omega_rad_s > STRAIGHT_RAD_S] = "left"
    turns[omega_rad_s < -STRAIGHT_RAD_S] = "right"
    return turns


class _Means:
    """Means over the windows of a scene, of what holds between stamps."""

    def __init__(self, scene: DenseWindows) -> None:
        self.scene = scene
        ends_s = scene.pose_s[scene.windows[:, [0, -1]]]
        self.middle_s = ends_s.mean(axis=1)
        self.first: IntArray
        self.last: IntArray
        self.first, self.last = np.searchsorted(scene.time_s, ends_s).T

    def of(self, values: FloatArray) -> FloatArray:
        """Mean (K,) of values (N,)."""
        steps_s = self.scene.steps_s
        sums = np.concatenate([[0.0], np.cumsum(values * steps_s)])
        ends_s = self.scene.time_s
        return np.asarray(
            (sums[self.last] - sums[self.first]) / (ends_s[self.last] - ends_s[self.first])
        )

    def middle(self, angle: FloatArray) -> FloatArray:
        """Angle (K,) in (-pi, pi], of a continuous one (N,), at the middle."""
        return wrap(np.interp(self.middle_s, self.scene.time_s, angle))
