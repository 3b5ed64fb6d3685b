"""Drifting downhill while driving, on straight lines as well as in turns."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import EffectParameter, MotionEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.motion.slope_icr import lacks_tilt
from odometry.models.inputs import Inputs


class SlopeDrift(MotionEffect):
    """A robot that drives drifts downhill by a share of its treads' speed, as soil gives way.

    Along the robot (less way uphill, more downhill) and across it (crabbing on a side slope), each
    by the sine of the slope in that direction. The other forms slide in turns alone.
    """

    name = "slope_sliding"
    form = "drift"
    in_words = "drifting downhill while driving"
    answers_to = ""
    equation = (
        "v_x -> v_x + along |v| sin(pitch), v_y -> v_y - across |v| cos(pitch) sin(roll), "
        "|v| = (|v_left| + |v_right|) / 2"
    )
    source = "slip on slopes in proportion to the share of the weight that pulls downhill"
    looks_like = "straight drives across a slope that end below where they should"
    remedy = "keep it in the model, and record roll and pitch in every run"
    needs = "roll and pitch on terrain that is not level"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`: nothing creeps uphill."""
        return (
            EffectParameter("along", "", 0.0, 10.0, 0.2, 0.02, 0.0),
            EffectParameter("across", "", 0.0, 10.0, 0.2, 0.02, 0.0),
        )

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        return lacks_tilt(inputs)

    def twist(
        self,
        values: FloatArray,
        twist: FloatArray,
        inputs: Inputs,
        base: Base,  # noqa: ARG002 - of the interface
    ) -> FloatArray:
        """See `MotionEffect.twist`. Roll is positive with the right side down, pitch nose down."""
        along, across = values
        speed_m_s = np.abs(inputs.tread_speeds_m_s).mean(axis=-1)
        changed = np.array(twist)
        changed[:, 0] += along * speed_m_s * np.sin(inputs.pitch_rad)
        changed[:, 1] -= across * speed_m_s * np.cos(inputs.pitch_rad) * np.sin(inputs.roll_rad)
        return changed
