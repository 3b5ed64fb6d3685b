"""Constant ICRs of a model that has them: what the ICR filter starts from."""

from dataclasses import dataclass

from odometry.arrays import FloatArray


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
