"""The face of every effect that can be added to a kinematic model."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.models.base import KinematicModel
from odometry.models.inputs import Inputs
from odometry.parameter_covariance import finite_number
from odometry.run import Robot


@dataclass(frozen=True)
class EffectParameter:
    """One parameter of an effect.

    Attributes
    ----------
    name, unit : str
    low, high : float
        Bounds within which it is searched.
    start : float
        Where a search begins.
    scale : float
        A small change of it that matters: the measure of steps.
    absent : float or None
        The value at which the effect does nothing; None where another parameter says that.
    """

    name: str
    unit: str
    low: float
    high: float
    start: float
    scale: float
    absent: float | None = 0.0


@dataclass(frozen=True)
class Base:
    """The model that effects are added to.

    Attributes
    ----------
    model : KinematicModel
    values : (P,)
        Its parameters.
    robot : Robot
        What it drives.
    latency_s : float
        By how much the robot always follows its recorded speeds late.
    """

    model: KinematicModel
    values: FloatArray
    robot: Robot
    latency_s: float = 0.0


def slip_factors(base: Base) -> FloatArray:
    """Slip factors (2,) of the left and the right tread; one where the model has none."""
    names = [parameter.name for parameter in base.model.parameters]
    by_name = dict(zip(names, base.values, strict=True))
    both = by_name.get("alpha", by_name.get("k", 1.0))
    return np.array([by_name.get("alpha_left", both), by_name.get("alpha_right", both)])


def tread_icrs(base: Base, effect: str) -> FloatArray:
    """y_left, y_right, x_icr (3,) of a base that has them.

    Raises
    ------
    ParameterError
        Naming the effect that needs them, where the base is another model.
    """
    if base.model.name != "icr":
        raise ParameterError(
            f"the effect {effect!r} moves tread ICRs, which the model {base.model.name!r} does not "
            "have; expected 'icr'"
        )
    return base.values[:3]


class Effect(ABC):
    """What may be missing in a model. A subclass is one file, and one row of the catalogue.

    Attributes
    ----------
    name, form : str
        What it is, and in which equations.
    acts_on : str
        "commands", "motion" or "measurement".
    equation, source : str
    looks_like : str
        How a person would notice it.
    needs : str
        Which data it needs.
    alike : Mapping of name to str
        Effects that it may be mistaken for, and what tells them apart.
    slow : bool
        Whether it takes long to compute.
    """

    name: ClassVar[str]
    form: ClassVar[str]
    acts_on: ClassVar[str]
    equation: ClassVar[str]
    source: ClassVar[str]
    looks_like: ClassVar[str]
    needs: ClassVar[str] = "tread speeds and a measured pose"
    alike: ClassVar[Mapping[str, str]] = {}
    slow: ClassVar[bool] = False

    @property
    @abstractmethod
    def parameters(self) -> tuple[EffectParameter, ...]:
        """Its parameters, in order."""

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the face
        """Which data a recording lacks to tell it, "" where it has them."""
        return ""

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:  # noqa: ARG002 - of the face
        """Values (S, P) from which a search begins."""
        return np.array([[parameter.start for parameter in self.parameters]])

    def usual(self, base: Base) -> tuple[FloatArray, FloatArray]:  # noqa: ARG002 - of the face
        """Values (P,) that are usual, and how far others are from them; infinite: no matter."""
        count = len(self.parameters)
        return np.zeros(count), np.full(count, np.inf)

    def same_as(self, values: FloatArray) -> Mapping[str, str]:  # noqa: ARG002 - of the face
        """Effects that do exactly the same at these values, and what would tell them apart."""
        return {}

    def is_meant(self, values: FloatArray) -> bool:  # noqa: ARG002 - of the face
        """Whether values (P,) describe what the name says, where a search may leave that."""
        return True

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

    def constants(self) -> dict[str, float]:
        """Known numbers that a parameter set holds among the parameters; arguments to make it."""
        return {}

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

    @abstractmethod
    def twist(
        self, values: FloatArray, twist: FloatArray, inputs: Inputs, base: Base
    ) -> FloatArray:
        """Twist (N, 3) with the effect, of the one (N, 3) without."""


class MeasurementEffect(Effect):
    """Acts on the measured pose."""

    acts_on = "measurement"

    def delay_s(self, values: FloatArray) -> float:  # noqa: ARG002 - of the face
        """By how much the stamps of poses are late."""
        return 0.0

    def seen(self, values: FloatArray, poses: FloatArray) -> FloatArray:  # noqa: ARG002
        """Poses (M, 3) as the sensor reports them, of those of the robot."""
        return poses

    def robot_poses(self, values: FloatArray, seen: FloatArray) -> FloatArray:  # noqa: ARG002
        """The inverse of `seen`."""
        return seen
