"""Sliding downhill while turning, by the force balance of ground contacts."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base_model import Base
from odometry.effects.contact_change import MODEL, ContactChange, balance_by_values
from odometry.effects.slope_icr import lacks_tilt
from odometry.models.inputs import Inputs


class SlopeByContact(ContactChange):
    """What gravity along the slope changes."""

    name = "slope_sliding"
    in_words = "sliding downhill in turns"
    equation = "twist + balance(speeds, roll, pitch) - balance(speeds, level)"
    looks_like = "turns on a slope that slide downhill"
    remedy = "keep it in the model, and record roll and pitch in every run"
    needs = "roll and pitch on terrain that is not level"

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        return lacks_tilt(inputs)

    def change(self, values: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """See `ContactChange.change`."""
        balance = self.balance_values(values, base)
        tilted, level = np.split(MODEL.twist(balance, _and_level(inputs)), 2)
        return np.asarray(tilted - level)

    def change_by_values(self, values: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """See `ContactChange.change_by_values`."""
        balance = self.balance_values(values, base)
        both = balance_by_values(balance, _and_level(inputs))
        tilted, level = np.split(both, 2, axis=1)
        return np.asarray(tilted - level)


def _and_level(inputs: Inputs) -> Inputs:
    """Inputs (2 K,) as they are (K,), then the same on level terrain: balances found at once."""
    level = np.zeros_like(inputs.roll_rad)
    return Inputs(
        np.concatenate([inputs.tread_speeds_m_s] * 2),
        np.concatenate([inputs.roll_rad, level]),
        np.concatenate([inputs.pitch_rad, level]),
    )
