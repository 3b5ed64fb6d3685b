"""Faults of the map in which the reference reports poses: stretched, turning, or drifting.

Each adds an error to the pose that depends on the place and on the time.
"""

from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.effects.interface.base import Effect, EffectParameter, MeasurementEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.recorded import Recorded, Reported
from odometry.effects.measurement.reference_fault import all_round
from odometry.models.inputs import Inputs

ROUNDS = 40  # of the inverse: each shrinks its error by the size of the fault


class MapFault(MeasurementEffect):
    """An error of the reported pose in the frame of the map."""

    name = "reference_fault"
    of_reference = True
    by_pose = False

    @abstractmethod
    def error(self, values: FloatArray, true: Reported) -> FloatArray:
        """Error (M, 3) of x, y [m] and yaw [rad] at true poses; that of yaw follows time alone."""

    def seen(self, values: FloatArray, poses: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.seen`.

        The steps of `poses` are laid on the map by the yaw reported, so that the noise of the
        places reported has no part in the error; what the map adds to each is turned back.
        """
        of_yaw = self.error(values, reported)[:, 2]
        turned = np.exp(1j * (poses[:, 2] + of_yaw - reported.yaw_rad)[:-1])
        steps = np.diff(poses[:, 0] + 1j * poses[:, 1]) / turned
        on_map = reported.poses[0, 0] + 1j * reported.poses[0, 1] + _summed(steps)
        true = np.column_stack([on_map.real, on_map.imag, reported.yaw_rad - of_yaw])
        error = self.error(values, reported.of(true))
        moved = _summed(np.diff(error[:, 0] + 1j * error[:, 1]) * turned)
        return np.asarray(poses + np.column_stack([moved.real, moved.imag, of_yaw]))

    def robot_poses(self, values: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.robot_poses`: by fixed-point iteration."""
        poses = reported.poses
        for _ in range(ROUNDS):
            poses = reported.poses - self.error(values, reported.of(poses))
        return np.asarray(poses)


class StretchedMap(MapFault):
    """Distances in the map are too long or too short, by a share that depends on direction."""

    form = "stretched_map"
    in_words = "a map that is stretched in one direction"
    equation = "(x, y) -> (x, y) + [[e_xx, e_xy], [e_xy, e_yy]] (x, y)"
    source = "strain of a plane, to first order"
    looks_like = "distances that are right in one compass direction and wrong across it"
    remedy = "measure two known distances across each other, and scale the map by them"
    needs = "headings over half a turn or more"
    alike: ClassVar[dict[str, str]] = {
        "wheel_scale": "a distance that a tape measures: wheels are wrong in every direction"
    }

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        return all_round(inputs)

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return tuple(
            EffectParameter(name, "", -0.4, 0.4, 0.0, 0.005) for name in ("e_xx", "e_yy", "e_xy")
        )

    def error(self, values: FloatArray, true: Reported) -> FloatArray:
        """See `MapFault.error`."""
        x, y = true.poses[:, 0], true.poses[:, 1]
        e_xx, e_yy, e_xy = values
        return np.column_stack([e_xx * x + e_xy * y, e_xy * x + e_yy * y, np.zeros_like(x)])


class TurningMap(MapFault):
    """The map turns about its origin at a constant rate."""

    form = "turning_map"
    in_words = "a map that turns slowly about its origin"
    equation = "(x, y) -> R(rate t) (x, y); yaw -> yaw + rate t"
    source = "definition"
    looks_like = "sideways motion that is the greater the farther the robot is from the origin"
    remedy = "hold the heading of the map, by a compass or two antennas"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("rate", "rad/s", -0.05, 0.05, 0.0, 1e-4),)

    def error(self, values: FloatArray, true: Reported) -> FloatArray:
        """See `MapFault.error`."""
        angle = values[0] * true.stamps_s
        off = (true.poses[:, 0] + 1j * true.poses[:, 1]) * (np.exp(1j * angle) - 1)
        return np.column_stack([off.real, off.imag, angle])


@dataclass(frozen=True)
class OfEachRun(MapFault):
    """A fault of the map with values that are each run's own; nothing in runs beyond these.

    Attributes
    ----------
    runs : int
    """

    runs: int = 1

    own: ClassVar[tuple[EffectParameter, ...]] = ()

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """One for as many runs as there are."""
        return (cls(len(recorded.inputs)),)

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`: those of the first run, then of the next."""
        if self.runs == 1:
            return self.own
        return tuple(
            replace(parameter, name=f"{parameter.name}_of_{run + 1}")
            for run in range(self.runs)
            for parameter in self.own
        )

    def settings(self) -> dict[str, Any]:
        """See `Effect.settings`."""
        return {"runs": self.runs}

    def with_run(self) -> "OfEachRun":
        """The same for one run more."""
        return replace(self, runs=self.runs + 1)

    def of_run(self, values: FloatArray, run: int | None) -> FloatArray:
        """Values of one run, zero where none are known."""
        count = len(self.own)
        if run is None or run >= self.runs:
            return np.zeros(count)
        return np.asarray(values[run * count : (run + 1) * count])


@dataclass(frozen=True)
class DriftingMap(OfEachRun):
    """The origin of the map drifts at a constant velocity, in each run its own.

    Attributes
    ----------
    runs : int
    """

    form = "drifting_map"
    in_words = "a map that drifts, in each run its own way"
    equation = "(x, y) -> (x, y) + (v_x, v_y) t"
    source = "definition"
    looks_like = "a stationary robot that moves all the same, always to one side of the map"
    mimicked_by = "wind, a current or a belt that carries the robot"
    remedy = "let the robot stand still for a minute: its pose moves as the reference drifts"
    needs = "headings over half a turn or more"
    own = (
        EffectParameter("v_x", "m/s", -1.0, 1.0, 0.0, 0.005),
        EffectParameter("v_y", "m/s", -1.0, 1.0, 0.0, 0.005),
    )

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        return all_round(inputs)

    def error(self, values: FloatArray, true: Reported) -> FloatArray:
        """See `MapFault.error`."""
        v_x, v_y = self.of_run(values, true.run)
        return np.outer(true.stamps_s, [v_x, v_y, 0.0])


@dataclass(frozen=True)
class DriftingYaw(OfEachRun):
    """The yaw of the reference drifts while its positions do not, in each run at its own rate.

    Attributes
    ----------
    runs : int
    """

    form = "drifting_yaw"
    in_words = "a yaw of the reference that drifts, in each run at a rate of its own"
    equation = "yaw -> yaw + rate t"
    source = "definition"
    looks_like = "straights on which the robot seems to go sideways, more and more"
    remedy = "correct the yaw by the direction in which the robot drives straight"
    own = (EffectParameter("rate", "rad/s", -0.05, 0.05, 0.0, 1e-4),)

    def error(self, values: FloatArray, true: Reported) -> FloatArray:
        """See `MapFault.error`."""
        (rate,) = self.of_run(values, true.run)
        return np.outer(true.stamps_s, [0.0, 0.0, rate])


def _summed(steps: AnyArray) -> AnyArray:
    """Sums (M,) of the steps (M - 1,) before each place."""
    return np.asarray(np.concatenate([[0.0], np.cumsum(steps)]))
