"""The face of every kinematic model."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.models.inputs import Inputs
from odometry.parameter_covariance import LARGEST
from odometry.run import Robot


@dataclass(frozen=True)
class Parameter:
    """One parameter of a model.

    Attributes
    ----------
    name : str
        As CONVENTIONS and the parameter sets spell it.
    unit : str
        "" where it has none.
    low, high : float
        Bounds within which the model means something.
    default : float or None
        The value of a parameter set that does not name it; None where it must.
    known : bool
        Measured on the robot or chosen, not identified from its motion unless asked to.
    search : (float, float) or None
        Where an identification looks; between the bounds where None.
    in_sign : bool
        Acts through a sign alone: it has no derivative, and is found by trying values.
    """

    name: str
    unit: str = ""
    low: float = -np.inf
    high: float = np.inf
    default: float | None = None
    known: bool = False
    search: tuple[float, float] | None = None
    in_sign: bool = False


class KinematicModel(ABC):
    """Tread speeds and attitude in, body twist out.

    A subclass is one file, and one row of `odometry.models.catalogue`. Stacks broadcast:
    values (..., P) against inputs (...).
    """

    name: str
    source: ClassVar[str]
    parameters: tuple[Parameter, ...]

    @abstractmethod
    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Body twist (..., 3): v_x, v_y [m/s], omega [rad/s].

        Parameters
        ----------
        values : (..., P)
            In the order of `parameters`.
        inputs : Inputs
            Of stack (...).

        Raises
        ------
        ParameterError
            If the model needs an input that was not recorded.
        """

    @abstractmethod
    def parameter_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Derivative (..., 3, P) of the twist by the parameters."""

    @abstractmethod
    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Derivative (..., 3, 2) of the twist by (v_left, v_right)."""

    @abstractmethod
    def guess(self, robot: Robot) -> dict[str, float]:
        """Every parameter, from what is known of a robot: where an identification starts."""

    def pack(self, values: Mapping[str, float]) -> FloatArray:
        """Parameters by name as an array (P,) in the order of `parameters`.

        Raises
        ------
        ParameterError
            If one is missing, unknown, or out of its bounds.
        """
        names = [parameter.name for parameter in self.parameters]
        for name in values:
            if name not in names:
                raise ParameterError(
                    f"{name!r} is no parameter of {self.name!r}; it has {', '.join(names)}"
                )
        packed = []
        for parameter in self.parameters:
            value = values.get(parameter.name, parameter.default)
            if value is None:
                raise ParameterError(f"the model {self.name!r} needs {parameter.name!r}")
            if not (abs(value) <= LARGEST and parameter.low <= value <= parameter.high):
                raise ParameterError(
                    f"{parameter.name} = {value}, expected a finite number from "
                    f"{max(parameter.low, -LARGEST):g} to {min(parameter.high, LARGEST):g}"
                )
            packed.append(float(value))
        self.check(np.array(packed))
        return np.array(packed)

    def check(self, values: FloatArray) -> None:  # noqa: B027 - most models have no such relation
        """Raise ParameterError where a relation between parameters (P,) does not hold."""
