"""The face of every kinematic model."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from odometry.arrays import FloatArray, components_last
from odometry.errors import ParameterError
from odometry.models.inputs import Inputs
from odometry.parameter_covariance import LARGEST
from odometry.recording.run import Robot


@dataclass(frozen=True)
class IcrForm:
    """A model with constant ICRs, in the parameters of `icr`.

    Attributes
    ----------
    icrs : (3,)
        y_left, y_right, x_icr [m].
    alphas : (2,)
        Slip factors of the left and the right tread.
    by_parameters : (5, P)
        Derivative of the ICRs and slip factors by the model's own parameters.
    """

    icrs: FloatArray
    alphas: FloatArray
    by_parameters: FloatArray


@dataclass(frozen=True)
class Parameter:
    """One parameter of a model.

    Attributes
    ----------
    name : str
        As data/README.md and the parameter sets spell it.
    unit : str
        "" where it has none.
    low, high : float
        Bounds within which the model means something.
    default : float or None
        The value of a parameter set that does not name it; None where it must.
    known : bool
        Measured on the robot or chosen, not identified from its motion unless released.
    search : (float, float) or None
        Where an identification looks; between the bounds where None.
    usual : (float, float) or None
        Where it lies on robots that slip; a value outside of it is doubted.
    neutral : float or None
        The value at which it has no effect, where that is a bound: to end there is an answer.
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
    usual: tuple[float, float] | None = None
    neutral: float | None = None
    in_sign: bool = False


USUAL_GAIN = (0.3, 1.5)  # of a tread's speed: slip lies within it, another unit does not


class Linearised(NamedTuple):
    """A twist (..., 3) and its derivative (..., 3, P) by the parameters."""

    twist: FloatArray
    by_parameters: FloatArray


@dataclass(frozen=True)
class Stages:
    """Which parameters an identification finds first, on flat terrain, and which then, on tilted.

    Attributes
    ----------
    flat, tilted : tuple of str
        Names; known parameters that are released belong to the second stage.
    """

    flat: tuple[str, ...]
    tilted: tuple[str, ...]


class KinematicModel(ABC):
    """Tread speeds and attitude in, body twist out.

    A subclass is one file, and one row of `odometry.models.catalogue`. Stacks broadcast:
    values (..., P) against inputs (...).

    Attributes
    ----------
    name, source : str
    parameters : tuple of Parameter
    stages : Stages or None
        None where all parameters are identified at once.
    has_constant_icrs : bool
        Whether there is an `icr_form`.
    is_linear_in_speeds : bool
        Whether the twist is a matrix times the tread speeds, the same for all samples.
    """

    name: str
    source: ClassVar[str]
    parameters: tuple[Parameter, ...]
    stages: ClassVar[Stages | None] = None
    has_constant_icrs: ClassVar[bool] = False
    is_linear_in_speeds: ClassVar[bool] = False

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
    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """The twist, exactly as of `twist`, and its derivative; what both need is found once."""

    def parameter_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Derivative (..., 3, P) of the twist by the parameters."""
        return self.linearised(values, inputs).by_parameters

    @abstractmethod
    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Derivative (..., 3, 2) of the twist by (v_left, v_right)."""

    @abstractmethod
    def guess(self, robot: Robot) -> dict[str, float]:
        """Every parameter, from what is known of a robot: where an identification starts."""

    def ordinary_sizes(self, robot: Robot) -> FloatArray:
        """A size (P,) for every parameter, the unit of search steps and of deviations.

        The guessed value; where that is 0, a quarter of the search range; and where there is no
        end to it, half the track width of what is in metres and 1 of anything else.
        """
        guess = self.guess(robot)
        sizes = []
        for parameter in self.parameters:
            low, high = parameter.search or (parameter.low, parameter.high)
            if guess[parameter.name]:
                sizes.append(abs(guess[parameter.name]))
            elif np.isfinite(high - low):
                sizes.append((high - low) / 4)
            else:
                sizes.append(robot.track_width / 2 if parameter.unit.startswith("m") else 1.0)
        return np.array(sizes)

    def determined_by(self, inputs: Inputs) -> dict[str, float]:  # noqa: ARG002 - of the interface
        """Known parameters that recorded inputs (N,) determine, by name."""
        return {}

    def icr_form(self, values: FloatArray) -> IcrForm:  # noqa: ARG002 - of the interface
        """The constant ICRs that parameters (P,) stand for.

        Raises
        ------
        ParameterError
            If the model has no constant ICRs, or these parameters stand for none.
        """
        raise ParameterError(f"the model {self.name!r} has no constant ICRs")

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


def vectors(*entries: FloatArray) -> FloatArray:
    """Vectors (..., M) of M entries, which are broadcast to one stack (...)."""
    packed = np.empty((len(entries), *np.broadcast_shapes(*map(np.shape, entries))))
    for row, entry in enumerate(entries):
        packed[row] = entry
    return components_last(packed)


def zero_matrices(stack: tuple[int, ...], rows: int, columns: int) -> FloatArray:
    """Matrices (..., rows, columns) to be filled entry by entry."""
    return np.moveaxis(np.zeros((rows, columns, *stack)), (0, 1), (-2, -1))
