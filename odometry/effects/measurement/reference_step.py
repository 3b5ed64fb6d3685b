"""Faults of the reference that begin at a moment of each run, and stay: a clock that is set."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.commands.late_treads import BY_GYROSCOPE
from odometry.effects.interface.base import Effect, EffectParameter, MeasurementEffect
from odometry.effects.interface.recorded import Recorded
from odometry.effects.interface.time_course import UNBOUNDED_S, FromAMoment, Spans
from odometry.effects.measurement.pose_stamps import breaks_s
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.models.inputs import Inputs

OF_EACH = 2  # a size and a moment
KNOWN_S = 0.5  # a moment between two breaks


@dataclass(frozen=True)
class ReferenceStep(MeasurementEffect):
    """Nothing before a moment of each run, a size of this run after it; none in other runs.

    Attributes
    ----------
    observed_s : tuple of (float, float)
        Of each run: when its first window ends and its last one begins, in run time.
    breaks_s : tuple of tuples of float
        Moments of each run at which it may have been: a search begins at each.
    """

    observed_s: Spans = ((0.0, UNBOUNDED_S),)
    breaks_s: tuple[tuple[float, ...], ...] = ((),)

    form = "step"
    course = FromAMoment.name
    of_reference = True
    size: ClassVar[EffectParameter]

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`: size and moment of the first run, then of the next."""
        found = []
        for number, (first_s, last_s) in enumerate(self.observed_s, start=1):
            own = "" if len(self.observed_s) == 1 else f"_of_{number}"
            middle_s, end_s = float(first_s + last_s) / 2, float(last_s) + 1.0
            found += [
                replace(self.size, name=f"{self.size.name}{own}"),
                EffectParameter(f"moment{own}", "s", 0.0, end_s, middle_s, 1.0, None),
            ]
        return tuple(found)

    def starts(self, inputs: Inputs, base: object) -> FloatArray:  # noqa: ARG002 - of the interface
        """See `Effect.starts`: each break of each run in turn, and the first of every run."""
        never = np.array([p.high if p.absent is None else p.start for p in self.parameters])
        first = [
            of[0] if of else end for of, end in zip(self.breaks_s, never[1::OF_EACH], strict=True)
        ]
        found = [never.copy()]
        found[0][1::OF_EACH] = first
        for run, moments_s in enumerate(self.breaks_s):
            for moment_s in moments_s:
                start = never.copy()
                start[OF_EACH * run + 1] = moment_s
                found.append(start)
        return np.unique(found, axis=0)

    def elsewhere(self, values: FloatArray) -> FloatArray:
        """See `Effect.elsewhere`: each break of each of several runs, a step as large as another's.

        Its size in either direction.
        """
        found = []
        sizes = values[::OF_EACH]
        largest = float(sizes[np.argmax(np.abs(sizes))])
        for run, moments_s in enumerate(self.breaks_s if len(self.breaks_s) > 1 else ()):
            for size in (largest, -largest):
                for moment_s in moments_s:
                    found.append(values.copy())
                    found[-1][OF_EACH * run : OF_EACH * (run + 1)] = size, moment_s
        return np.array(found).reshape(-1, len(values))

    def resolution(self, values: FloatArray, inputs: Inputs) -> FloatArray:  # noqa: ARG002
        """See `Effect.resolution`."""
        return np.tile([0.0, KNOWN_S], len(values) // OF_EACH)

    def is_meant(self, values: FloatArray) -> bool:
        """See `Effect.is_meant`: a moment with nothing before it is none, nor one after all."""
        first_s, last_s = np.array(self.observed_s).T
        moments_s = values[1::OF_EACH]
        return bool((first_s <= moments_s).all() and (moments_s <= last_s).any())

    def settings(self) -> dict[str, Any]:
        """See `Effect.settings`."""
        return {"observed_s": [list(span) for span in self.observed_s]}

    def with_run(self, observed_s: tuple[float, float]) -> "ReferenceStep":
        """The same for one run more."""
        return replace(self, observed_s=(*self.observed_s, observed_s))

    def moment_s(self, values: FloatArray, run: int) -> float:
        """Moment of one run; negative numbers count from the last."""
        return float(values[1::OF_EACH][run])

    def after(self, values: FloatArray, stamps_s: FloatArray, run: int | None) -> FloatArray:
        """The size at each of the stamps (M,) of a run; zero where its moment is not known."""
        if run is None or OF_EACH * run >= len(values):
            return np.zeros_like(stamps_s)
        size, moment_s = values[OF_EACH * run : OF_EACH * (run + 1)]
        return np.where(stamps_s >= moment_s, size, 0.0)


@dataclass(frozen=True)
class ClockStep(ReferenceStep):
    """The clock of the poses is set at a moment of each run, or they come later from it on.

    It leaves a break in the stamps, and is offered where there is one.

    Attributes
    ----------
    observed_s, breaks_s
        See `ReferenceStep`.
    has_gyroscope : bool
        Whether every run has one.
    """

    has_gyroscope: bool = True

    name = TimeOffset.name
    in_words = "pose stamps that are late or early from a moment on"
    equation = "pose(t) -> pose(t - offset) from a moment of each run on"
    source = "definition"
    looks_like = (
        "a break in the stamps of the poses, and errors along the path after it where speed changes"
    )
    remedy = (
        "synchronise the clocks, or move the stamps of the poses after the moment by the offset"
    )
    needs = "poses whose stamps have a break"
    size = TimeOffset().parameters[0]

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """Where the stamps of a run break."""
        breaks = tuple(breaks_s(of.stamps_s) for of in recorded.reported)
        if not any(breaks):
            return ()
        gyroscope = all(of.yaw_rate_rad_s is not None for of in recorded.inputs)
        return (cls(recorded.observed_s, breaks, gyroscope),)

    def same_as(self, values: FloatArray) -> dict[str, str]:  # noqa: ARG002 - of the interface
        """See `Effect.same_as`: treads that act later from a moment on, without gyroscope."""
        return {} if self.has_gyroscope else {"command_delay": BY_GYROSCOPE}

    def delay_s(
        self, values: FloatArray, stamps_s: FloatArray, run: int | None = None
    ) -> FloatArray:
        """See `MeasurementEffect.delay_s`."""
        return self.after(values, stamps_s, run)
