"""Single poses of the reference that are far off, while the robot drives on."""

from dataclasses import dataclass
from typing import Any

from odometry.effects.interface.base import Effect, EffectParameter, MeasurementEffect
from odometry.effects.interface.recorded import Recorded


@dataclass(frozen=True)
class ReferenceOutliers(MeasurementEffect):
    """Poses that disagree with those before and after, which agree with each other.

    Nothing follows from one for the next: they are left out, and what stays is as it was.

    Attributes
    ----------
    stamps_s : tuple of tuples of float
        Run times of the poses that were left out, run by run.
    """

    stamps_s: tuple[tuple[float, ...], ...] = ()

    name = "reference_fault"
    form = "outliers"
    in_words = "single poses of the reference that are far off"
    equation = "pose -> pose + jump, at single stamps"
    source = "heavy tails of a position fix"
    looks_like = "jumps of one pose, there and back, that treads and gyroscope do not have"
    remedy = "leave these poses out, or give the filter that uses them a gate"
    of_reference = True

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """How many there are, and how far off: for the reader."""
        return (
            EffectParameter("share", "", 0.0, 1.0, 0.0, 0.01),
            EffectParameter("distance", "m", 0.0, 1e6, 0.0, 0.01, None),
        )

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:  # noqa: ARG003 - of the interface
        """None: they are found before anything is fitted."""
        return ()

    def settings(self) -> dict[str, Any]:
        """See `Effect.settings`."""
        return {"stamps_s": [list(stamps) for stamps in self.stamps_s]}


@dataclass(frozen=True)
class FrozenPoses(ReferenceOutliers):
    """Poses that repeat the one before, while the treads run.

    Attributes
    ----------
    stamps_s : tuple of tuples of float
        Run times of the poses that were left out, run by run.
    """

    form = "frozen"
    in_words = "poses of the reference that repeat the last one"
    equation = "pose -> the last pose, for a while"
    source = "a tracker that lost its target and says nothing of it"
    looks_like = "a robot that stands while its treads run, and then jumps"
    remedy = "leave these poses out, or have the reference say when it has no new one"


@dataclass(frozen=True)
class JumpingPoses(ReferenceOutliers):
    """Steps between poses that no robot makes; what follows one is as good as what went before.

    Attributes
    ----------
    stamps_s : tuple of tuples of float
        Run times of the poses that such a step leads to, run by run.
    """

    form = "jumps"
    in_words = "jumps of the reference, farther than the treads went"
    equation = "pose -> pose + jump, from a stamp on"
    source = "loops that a map closes, and places where a receiver sees reflected signals"
    looks_like = "a robot that is somewhere else at once, and drives on from there"
    remedy = "use the motion between poses, but not across a jump: give what follows a new `window`"
