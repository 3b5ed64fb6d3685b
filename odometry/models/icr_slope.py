"""Tread ICRs that move with the attitude: ICR kinematics on slopes (Martinez 2024 eq. 1-11)."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry.tilt import paper_attitude
from odometry.models.base import KinematicModel, Linearised, Parameter, Stages
from odometry.models.icr import (
    ALPHAS,
    ICRS,
    Icr,
    icr_speed_matrix,
    icr_twist,
    icr_twist_jacobian,
)
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot

GUESSED_V_MAX_M_S = 1.0
GUESSED_HALF_LENGTH = 0.35  # of the body's length: the wheels stand within the body


class Column(IntEnum):
    """Where the parameters have what `icr` does not."""

    LAMBDA_1 = 5
    LAMBDA_2 = 6
    V_MAX = 7
    HALF_WIDTH = 8
    HALF_LENGTH = 9


class IcrSlope(KinematicModel):
    """ICRs of level terrain, shifted while turning on a slope.

    The shift is proportional to what the forward speed leaves of `v_max`, and zero above it.
    lambda_1 moves both tread ICRs with the pitch and x_icr with the roll; lambda_2 moves one
    tread ICR further out where the slope rises mainly ahead or behind. The ICRs stay outside
    the base rectangle sideways and within it lengthwise (limits I-III); ICRs of level terrain
    that break these limits are held at its edge on level terrain, too.

    The twist is continuous. Its derivatives jump where the effective tread speeds are equal or
    opposite, where the forward speed is `v_max`, and where a limit sets in.
    """

    name = "icr_slope"
    source = "Martinez 2024, eq. 1-11"
    parameters = (
        *Icr.parameters,
        Parameter("lambda_1", "s/rad", 0.0, neutral=0.0),
        Parameter("lambda_2", "s/rad", 0.0, neutral=0.0),
        Parameter("v_max", "m/s", 0.0, known=True),
        Parameter("half_width", "m", 1e-3, known=True),
        Parameter("half_length", "m", 0.0, known=True),
    )
    stages = Stages(  # Martinez 2024, III-B
        flat=tuple(parameter.name for parameter in Icr.parameters),
        tilted=("lambda_1", "lambda_2"),
    )

    def check(self, values: FloatArray) -> None:
        """y_left must exceed y_right on level terrain."""
        Icr().check(values)

    def icrs(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Momentary y_left, y_right, x_icr (..., 3) [m]: the ovals of Martinez 2024 Fig. 2."""
        return _shifted(values, inputs).limited

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""
        return _twist(_shifted(values, inputs))

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`."""
        shifted = _shifted(values, inputs)
        inside = shifted.free == shifted.limited
        spare = shifted.spare[..., None]
        icrs = np.zeros((*shifted.free.shape, 10))  # their derivative by the parameters
        icrs[..., [0, 1, 2], [0, 1, 2]] = inside
        icrs[..., Column.LAMBDA_1] = inside * spare * shifted.by_lambda_1
        icrs[..., Column.LAMBDA_2] = inside * spare * shifted.by_lambda_2
        icrs[..., Column.V_MAX] = inside * (spare > 0) * shifted.by_spare
        icrs[..., Column.HALF_WIDTH] = ~inside * [1.0, -1.0, 0.0]  # limits I and II
        icrs[..., 2, Column.HALF_LENGTH] = ~inside[..., 2] * np.sign(shifted.free[..., 2])  # III
        by_icr = icr_twist_jacobian(shifted.limited, shifted.effective_speeds)
        jacobian = by_icr @ icrs
        speeds = np.asarray(inputs.tread_speeds_m_s)[..., None, :]
        jacobian[..., ALPHAS] = _effective_speed_jacobian(shifted) * speeds
        return Linearised(_twist(shifted), jacobian)

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        by_effective = _effective_speed_jacobian(_shifted(values, inputs))
        return np.asarray(by_effective * values[..., None, ALPHAS])

    def determined_by(self, inputs: Inputs) -> dict[str, float]:
        """v_max: the largest |V_r + V_l| / 2 (v_y^m of Martinez 2024)."""
        return {"v_max": float(np.abs(inputs.tread_speeds_m_s.mean(axis=-1)).max())}

    def guess(self, robot: Robot) -> dict[str, float]:
        """The guess of `icr`, a base rectangle from the robot's size, both lambdas 1 s/rad."""
        half_width = robot.track_width / 2
        length = robot.length
        return {
            **Icr().guess(robot),
            "lambda_1": 1.0,
            "lambda_2": 1.0,
            "v_max": GUESSED_V_MAX_M_S,
            "half_width": half_width,
            "half_length": half_width if length is None else GUESSED_HALF_LENGTH * length,
        }


@dataclass(frozen=True)
class _Shifted:
    """Momentary ICRs and what they are made of; stacks (...)."""

    effective_speeds: FloatArray  # (..., 2), eq. 11
    forward: FloatArray  # their mean
    spare: FloatArray  # what the forward speed leaves of v_max, at least 0
    by_lambda_1: FloatArray  # (..., 3), the shift for each unit of lambda_1 and spare speed
    by_lambda_2: FloatArray  # (..., 3)
    by_spare: FloatArray  # (..., 3), the shift for each unit of spare speed
    free: FloatArray  # (..., 3), the ICRs before the limits
    limited: FloatArray  # (..., 3), and after


def _shifted(values: FloatArray, inputs: Inputs) -> _Shifted:
    half_width, half_length = values[..., Column.HALF_WIDTH], values[..., Column.HALF_LENGTH]
    stack = np.broadcast_shapes(values.shape[:-1], inputs.shape)
    effective = np.broadcast_to(values[..., ALPHAS] * inputs.tread_speeds_m_s, (*stack, 2))
    forward = effective.mean(axis=-1)
    spare = np.maximum(values[..., Column.V_MAX] - np.abs(forward), 0)
    roll, pitch = paper_attitude(inputs.roll_rad, inputs.pitch_rad)
    direction = np.sign(effective[..., 1] - effective[..., 0])  # eq. 8
    ring = direction * pitch  # eq. 5-6; y = -x_ICR
    lobe = direction * np.sign(pitch) * np.maximum(np.abs(pitch) - np.abs(roll), 0)  # eq. 9-10
    by_lambda_1 = np.stack([-ring, -ring, direction * roll], axis=-1)  # eq. 5-7
    by_lambda_2 = np.stack([-np.minimum(lobe, 0), -np.maximum(lobe, 0), 0 * lobe], axis=-1)
    lambda_1, lambda_2 = values[..., Column.LAMBDA_1, None], values[..., Column.LAMBDA_2, None]
    by_spare = lambda_1 * by_lambda_1 + lambda_2 * by_lambda_2
    free = values[..., ICRS] + spare[..., None] * by_spare
    limited = [
        np.maximum(free[..., 0], half_width),  # limit I
        np.minimum(free[..., 1], -half_width),  # limit II
        np.clip(free[..., 2], -half_length, half_length),  # limit III
    ]
    return _Shifted(
        effective, forward, spare, by_lambda_1, by_lambda_2, by_spare, free, np.stack(limited, -1)
    )


def _twist(shifted: _Shifted) -> FloatArray:
    return icr_twist(shifted.limited, shifted.effective_speeds)


def _effective_speed_jacobian(shifted: _Shifted) -> FloatArray:
    """Derivative (..., 3, 2) of the twist by the effective tread speeds."""
    inside = shifted.free == shifted.limited
    spare_by_speed = -np.sign(shifted.forward) * (shifted.spare > 0) / 2
    icrs_by_speed = inside * shifted.by_spare * spare_by_speed[..., None]
    by_icr = icr_twist_jacobian(shifted.limited, shifted.effective_speeds)
    through_icrs = np.einsum("...ij,...j->...i", by_icr, icrs_by_speed)
    return np.asarray(icr_speed_matrix(shifted.limited) + through_icrs[..., None])
