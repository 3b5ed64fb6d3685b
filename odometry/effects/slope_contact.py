"""Sliding downhill while turning, by the force balance of ground contacts."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base_model import Base
from odometry.effects.contact_change import ContactChange
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
        tilted, level = np.split(self.balanced(*self._tilted_and_level(values, inputs, base)), 2)
        return np.asarray(tilted - level)

    def change_by_values(self, values: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """See `ContactChange.change_by_values`."""
        both = self.balanced_by_values(*self._tilted_and_level(values, inputs, base))
        tilted, level = np.split(both, 2, axis=1)
        return np.asarray(tilted - level)

    def _tilted_and_level(
        self, values: FloatArray, inputs: Inputs, base: Base
    ) -> tuple[FloatArray, Inputs]:
        """Parameters (2 K, 9) of `Contact`, and inputs: as they are (K,), then on level terrain.

        Balances of both are found at once.
        """
        level = np.zeros_like(inputs.roll_rad)
        both = Inputs(
            np.concatenate([inputs.tread_speeds_m_s] * 2),
            np.concatenate([inputs.roll_rad, level]),
            np.concatenate([inputs.pitch_rad, level]),
        )
        return np.tile(self.balance_values(values, base), (2 * len(level), 1)), both
