"""Tread ICRs of several terrains in one model: those of the sample's label.

No row of the catalogue: in a parameter set every terrain has a table of `icr` of its own.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.models.base import Linearised, zero_matrices
from odometry.models.icr import Icr
from odometry.models.inputs import Inputs
from odometry.run import Robot

PLAIN = Icr()
COUNT = len(PLAIN.parameters)


class IcrByTerrain(Icr):
    """`Icr` with parameters of its own for each labelled terrain, one after the other.

    Attributes
    ----------
    labels : tuple of str
        The parameters of the first are those of samples with another label or none.
    """

    has_constant_icrs = False
    is_linear_in_speeds = False

    def __init__(self, labels: Sequence[str]) -> None:
        self.labels = tuple(labels)
        others = (
            replace(parameter, name=f"{parameter.name}_{label}")
            for label in self.labels[1:]
            for parameter in Icr.parameters
        )
        self.parameters = (*Icr.parameters, *others)

    def values_on(self, label: str, values: FloatArray) -> FloatArray:
        """Parameters (5,) of `icr` on a terrain, of those (P,) of all."""
        number = self.labels.index(label) if label in self.labels else 0
        return np.asarray(values[number * COUNT : (number + 1) * COUNT])

    def check(self, values: FloatArray) -> None:
        """y_left must exceed y_right on each terrain."""
        for own in values.reshape(-1, COUNT):
            PLAIN.check(own)

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`; values (P,), inputs of stack (N,)."""
        return PLAIN.twist(self._of_samples(values, inputs), inputs)

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`; values (P,), inputs of stack (N,)."""
        twist, own = PLAIN.linearised(self._of_samples(values, inputs), inputs)
        jacobian = zero_matrices(inputs.shape, 3, len(self.parameters))
        for number in range(len(self.labels)):
            here = self._numbers(inputs) == number
            jacobian[here, :, number * COUNT : (number + 1) * COUNT] = own[here]
        return Linearised(twist, jacobian)

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`; values (P,), inputs of stack (N,)."""
        return PLAIN.speed_jacobian(self._of_samples(values, inputs), inputs)

    def guess(self, robot: Robot) -> dict[str, float]:
        """Those of `icr`, the same on all terrains."""
        guess = PLAIN.guess(robot)
        names = [parameter.name for parameter in self.parameters]
        values = [guess[parameter.name] for parameter in Icr.parameters] * len(self.labels)
        return dict(zip(names, values, strict=True))

    def _of_samples(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        return np.asarray(values.reshape(-1, COUNT)[self._numbers(inputs)])

    def _numbers(self, inputs: Inputs) -> IntArray:
        numbers = np.zeros(inputs.shape, dtype=np.int64)
        for number, label in enumerate(self.labels):
            if inputs.terrain is not None:
                numbers[np.asarray(inputs.terrain) == label] = number
        return numbers
