"""The interface of every effect that can be added to a kinematic model."""
# ruff: noqa: ARG002, ARG003 - arguments of the interface

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.recorded import Recorded, Reported
from odometry.errors import ParameterError
from odometry.models.inputs import Inputs
from odometry.parameter_covariance import finite_number


@dataclass(frozen=True)
class EffectParameter:
    """One parameter of an effect.

    Attributes
    ----------
    name, unit : str
    low, high, start : float
        Bounds within which it is searched, and where a search begins.
    scale : float
        A small change of it that matters: the measure of steps.
    absent : float or None
        The value at which the effect does nothing; None where another parameter decides that.
    in_steps : bool
        Whether recorded motion changes in steps as it does, and not at all between them.
    """

    name: str
    unit: str
    low: float
    high: float
    start: float
    scale: float
    absent: float | None = 0.0
    in_steps: bool = False


class Effect(ABC):
    """What may be missing in a model. A subclass is one file, and one row of the catalogue.

    Attributes
    ----------
    name, form, in_words : str
        What it is, in which equations, and the name that a roboticist would use.
    acts_on : str
        "commands", "motion" or "measurement".
    equation, source : str
    looks_like : str
        How a person would notice it in a recording.
    remedy, needs : str
        What to do about it, and which data it needs.
    alike : Mapping of name to str
        Effects that it may be mistaken for, and what distinguishes them.
    includes : Mapping of name to str
        Effects that are this one at some values, and what distinguishes them.
    of_reference : bool
        Whether it is a fault of the reference sensor.
    moves_poses : bool
        Whether it changes where the robot is seen; a fault of the gyroscope does not.
    mimicked_by : str
        What a robot may do that looks the same in any run. Such an effect is never named; where
        it explains most, no other effect is named either.
    robot_alike : str
        The same, of a fault that is named with it as it is more common.
    essential : tuple of str
        Parameters without which it is another effect: most of what it does must be theirs.
    constant_names : tuple of str
        Known numbers that a parameter set holds among the parameters; arguments to make it.
    course : str
        How it comes and goes in time, "" where it is always there
        (`odometry.effects.interface.in_course`).
    slow : bool
        Whether it takes long to compute.
    physics : str
        Effects of the same physics share their numbers in one model; "" where they are its own.
    """

    name: ClassVar[str]
    form: ClassVar[str]
    in_words: ClassVar[str]
    acts_on: ClassVar[str]
    equation: ClassVar[str]
    source: ClassVar[str]
    looks_like: ClassVar[str]
    remedy: ClassVar[str]
    needs: ClassVar[str] = "tread speeds and a measured pose"
    alike: ClassVar[Mapping[str, str]] = {}
    includes: ClassVar[Mapping[str, str]] = {}
    of_reference: ClassVar[bool] = False
    mimicked_by: ClassVar[str] = ""
    moves_poses: ClassVar[bool] = True
    robot_alike: ClassVar[str] = ""
    essential: ClassVar[tuple[str, ...]] = ()
    constant_names: ClassVar[tuple[str, ...]] = ()
    course: ClassVar[str] = ""
    slow: ClassVar[bool] = False
    physics: ClassVar[str] = ""

    @classmethod
    def offered(cls, recorded: Recorded) -> "tuple[Effect, ...]":
        """Candidates of this form that measured runs may determine."""
        return (cls(),)

    @property
    @abstractmethod
    def parameters(self) -> tuple[EffectParameter, ...]:
        """Its parameters, in order."""

    def lacks(self, inputs: Inputs, base: Base) -> str:
        """The data that a recording lacks to determine it, "" where it has them."""
        return ""

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:
        """Values (S, P) from which a search begins."""
        return np.array([[parameter.start for parameter in self.parameters]])

    def elsewhere(self, values: FloatArray) -> FloatArray:
        """Values (S, P) to which a search goes on from (P,) where they cost less."""
        return np.empty((0, len(values)))

    def usual(self, base: Base) -> tuple[FloatArray, FloatArray]:
        """Values (P,) that are usual, and how far others are from them; infinite: no matter."""
        count = len(self.parameters)
        return np.zeros(count), np.full(count, np.inf)

    def resolution(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """By how much values (P,) in steps may differ and do the same to what was recorded."""
        return np.zeros(len(values))

    def same_as(self, values: FloatArray) -> Mapping[str, str]:
        """Effects that do exactly the same at these values, and what would distinguish them."""
        return {}

    def is_meant(self, values: FloatArray) -> bool:
        """Whether values (P,) agree with the name, where a search may leave that."""
        return True

    def in_words_at(self, values: FloatArray) -> str:
        """The name that a roboticist would use where its values are (P,)."""
        return self.in_words

    def pack(self, values: Mapping[str, float], where: str) -> FloatArray:
        """Values by name as an array (P,).

        Raises
        ------
        ParameterError
            If one is missing, unknown or not finite.
        """
        names = [parameter.name for parameter in self.parameters]
        if set(values) != set(names):
            raise ParameterError(f"{where}: parameters {sorted(values)}, expected {sorted(names)}")
        return np.array([finite_number(values[name], f"{where}: {name}") for name in names])

    @property
    def key(self) -> tuple[str, str, str]:
        """Name, form and course: what one candidate is and no other."""
        return self.name, self.form, self.course

    @property
    def searched(self) -> int:
        """How many numbers were searched beside the parameters: each costs as much evidence."""
        return 0

    def constants(self) -> dict[str, float]:
        """The numbers of `constant_names` that are known."""
        stated = {name: getattr(self, name) for name in self.constant_names}
        return {name: float(value) for name, value in stated.items() if value is not None}

    def settings(self) -> dict[str, Any]:
        """What else a parameter set must hold to make the effect again."""
        return {}


class CommandEffect(Effect):
    """Acts on the tread speeds."""

    acts_on = "commands"

    @abstractmethod
    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """True tread speeds (N, 2) of recorded ones; samples are in time order."""


class MotionEffect(Effect):
    """Acts on the body twist."""

    acts_on = "motion"

    @property
    def answers_to(self) -> str:
        """What changes what it adds, beside values and inputs: "twist" and base, "base" or ""."""
        return "twist"

    @abstractmethod
    def twist(
        self, values: FloatArray, twist: FloatArray, inputs: Inputs, base: Base
    ) -> FloatArray:
        """Twist (N, 3) with the effect, of the one (N, 3) without."""


class MeasurementEffect(Effect):
    """Acts on what a sensor reports: the measured pose, or the gyroscope.

    Attributes
    ----------
    by_pose : bool
        Whether each pose is reported by itself, whatever went before and comes after.
    always : tuple of float
        Its values where a reference has it in all runs; none of what comes up.
    """

    acts_on = "measurement"
    by_pose: ClassVar[bool] = True
    always: ClassVar[tuple[float, ...]] = ()

    def delay_s(
        self, values: FloatArray, stamps_s: FloatArray, run: int | None = None
    ) -> FloatArray:
        """By how much each of the stamps of poses (M,), in run time, is late (M,).

        `run` is the number of the run, see `Reported.run`.
        """
        return np.zeros_like(stamps_s)

    def seen(self, values: FloatArray, poses: FloatArray, reported: Reported) -> FloatArray:
        """Poses (M, 3) as the sensor reports them, of those of the robot.

        `reported` is what it did report: `poses` may be those of a drive that began at the
        origin, and an error may follow the true heading, place or time.
        """
        return poses

    def gyroscope(
        self, values: FloatArray, yaw_rate_rad_s: FloatArray, inputs: Inputs
    ) -> FloatArray:
        """What the gyroscope reports (N,) of the yaw rate (N,) of the robot."""
        return yaw_rate_rad_s

    def robot_poses(self, values: FloatArray, reported: Reported) -> FloatArray:
        """The inverse of `seen`: poses (M, 3) of the robot."""
        return reported.poses
