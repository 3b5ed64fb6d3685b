"""The face of the models whose tread speeds follow from a wanted motion."""

from abc import abstractmethod

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.base import KinematicModel


class InvertibleModel(KinematicModel):
    """A model with inverse kinematics (Martinez 2017 eq. 23-24).

    Two tread speeds cannot choose three velocities: v_y follows from the other two.
    """

    @abstractmethod
    def tread_speeds(self, values: FloatArray, v_x: FloatArray, omega: FloatArray) -> FloatArray:
        """Tread speeds (..., 2) that give a motion: v_left, v_right [m/s].

        Parameters
        ----------
        values : (..., P)
            In the order of `parameters`.
        v_x, omega : (...)
            Wanted body twist [m/s, rad/s]; stacks broadcast.

        Returns
        -------
        (..., 2)
            Before any slip, as the wheels turn; NaN where no tread speeds give the motion.
        """


def icr_tread_speeds(
    y_left: FloatArray, y_right: FloatArray, v_x: FloatArray, omega: FloatArray
) -> FloatArray:
    """Effective tread speeds (..., 2) at constant tread ICRs (Martinez 2017 eq. 23-24)."""
    treads = np.broadcast_arrays(v_x - omega * y_left, v_x - omega * y_right)
    return np.stack(treads, axis=-1)


def before_slip(effective: FloatArray, factors: FloatArray) -> FloatArray:
    """Effective speeds over their slip factors, NaN where a factor is 0."""
    speeds = np.full(np.broadcast_shapes(np.shape(effective), np.shape(factors)), np.nan)
    np.divide(effective, factors, out=speeds, where=np.asarray(factors) != 0)
    return speeds
