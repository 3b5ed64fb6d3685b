"""The model that effects are added to."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.models.base import KinematicModel
from odometry.models.icr import Icr, IcrByTerrain
from odometry.recording.run import Robot


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
        By how much poses always follow the recorded speeds late.
    gyro_latency_s : float
        By how much the gyroscope does.
    """

    model: KinematicModel
    values: FloatArray
    robot: Robot
    latency_s: float = 0.0
    gyro_latency_s: float = 0.0

    def on(self, terrain: str) -> "Base":
        """The same as it is on one terrain, where its model has several."""
        if not isinstance(self.model, IcrByTerrain):
            return self
        return replace(self, model=Icr(), values=self.model.values_on(terrain, self.values))


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
