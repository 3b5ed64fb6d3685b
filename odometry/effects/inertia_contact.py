"""Inertia in fast turns, by the force balance of ground contacts."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import Base
from odometry.effects.contact_change import MODEL, ContactChange
from odometry.models.inputs import Inputs

SLOW = 0.02  # of the speeds: centrifugal force is 0.0004 of its own


class InertiaByContact(ContactChange):
    """What centrifugal force changes."""

    name = "inertia"
    equation = "twist + balance(speeds) - balance(slow speeds) / slowness"
    looks_like = "turns that come out wider or tighter the faster they are driven"
    needs = "fast turns"

    def change(self, values: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """See `ContactChange.change`."""
        fast = Inputs(inputs.tread_speeds_m_s)
        slow = Inputs(SLOW * inputs.tread_speeds_m_s)
        return np.asarray(
            MODEL.twist(self.balance_values(values, base), fast)
            - MODEL.twist(self.balance_values(values, base, SLOW), slow) / SLOW
        )
