"""Sliding downhill while turning, as ICRs that move with the attitude."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import Effect, EffectParameter, MotionEffect
from odometry.effects.interface.base_model import Base, slip_factors, tread_icrs
from odometry.effects.interface.recorded import Recorded
from odometry.models.icr_slope import GUESSED_HALF_LENGTH, IcrSlope
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot

MODEL = IcrSlope()
LEAST_TILT_RAD = 0.01  # of the steepest terrain: less is level


class SlopeByIcr(MotionEffect):
    """The change that the formula of Martinez 2024 makes to the base's ICRs.

    Parameters
    ----------
    half_width, half_length : float, optional
        Of the contact rectangle [m]; from the size of the robot where absent.
    """

    name = "slope_sliding"
    in_words = "sliding downhill in turns"
    form = "icr_slope"
    answers_to = "base"
    equation = "ICRs shifted by lambda_1 and lambda_2 times roll and pitch, less v_max - |v|"
    constant_names = ("half_width", "half_length")
    source = "Martinez 2024 eq. 1-11"
    looks_like = "turns on a slope that slide downhill, most while slow"
    remedy = "keep it in the model, and record roll and pitch in every run"
    needs = "roll and pitch on terrain that is not level; a base model with tread ICRs"

    def __init__(self, half_width: float | None = None, half_length: float | None = None) -> None:
        self.half_width, self.half_length = half_width, half_length

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """On contacts of the size of the robot."""
        robot = recorded.base.robot
        return (cls(robot.track_width / 2, half_length_m(robot)),)

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (
            EffectParameter("lambda_1", "s/rad", 0.0, 100.0, 0.5, 0.05),
            EffectParameter("lambda_2", "s/rad", 0.0, 100.0, 0.5, 0.05),
            EffectParameter("v_max", "m/s", 0.05, 20.0, 1.0, 0.05, None),
        )

    def lacks(self, inputs: Inputs, base: Base) -> str:
        """See `Effect.lacks`."""
        if base.model.name != "icr":
            return "a base model with tread ICRs"
        return lacks_tilt(inputs)

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:  # noqa: ARG002 - of the interface
        """Sliding that ends early and late with speed."""
        return np.array([[0.5, 0.5, v_max] for v_max in (0.7, 1.5, 4.0)])

    def twist(
        self, values: FloatArray, twist: FloatArray, inputs: Inputs, base: Base
    ) -> FloatArray:
        """See `MotionEffect.twist`: the difference that roll and pitch make."""
        icrs, alphas = tread_icrs(base, self.name), slip_factors(base)
        half_width = self.half_width or base.robot.track_width / 2
        half_length = self.half_length or half_length_m(base.robot)
        packed = np.array([*icrs, *alphas, *values, half_width, half_length])
        level = Inputs(inputs.tread_speeds_m_s)
        return np.asarray(twist + MODEL.twist(packed, inputs) - MODEL.twist(packed, level))


def half_length_m(robot: Robot) -> float:
    """Half length of the contact rectangle: from the robot's length, else a square's."""
    length = robot.length
    return robot.track_width / 2 if length is None else GUESSED_HALF_LENGTH * length


def lacks_tilt(inputs: Inputs) -> str:
    """What is lacking where neither roll nor pitch is more than noise."""
    angles = (inputs.roll_rad, inputs.pitch_rad)
    steepest = max(np.percentile(np.abs(angle), 90) for angle in angles)
    return "" if steepest > LEAST_TILT_RAD else "roll and pitch of terrain that is not level"
