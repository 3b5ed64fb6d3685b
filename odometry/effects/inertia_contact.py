"""Inertia in fast turns and changes of speed, by the forces of ground contacts."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import Effect
from odometry.effects.base_model import Base
from odometry.effects.contact_change import IN_BALANCE, ContactChange
from odometry.effects.contact_following import followed
from odometry.effects.recorded import Recorded
from odometry.models.inputs import Inputs

LATERAL_M_S2 = 0.3  # with less the contact model is not fitted
STEP = 1e-5  # of a parameter, for a derivative
SLOW = 0.02  # of the speeds: centrifugal force is 0.0004 of its own


class InertiaByContact(ContactChange):
    """What centrifugal force changes, and how late mass and yaw inertia follow the balance."""

    name = "inertia"
    in_words = "inertia in fast turns"
    equation = "twist + follows(balance(speeds)) - balance(slow speeds) / slowness"
    looks_like = "fast turns that come out wider or tighter, and follow changes of speed late"
    remedy = "keep it in the model, or drive turns more slowly"
    needs = "fast turns"

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """Where turns are fast enough for it."""
        if recorded.lateral_m_s2 < LATERAL_M_S2:
            return ()
        return super().offered(recorded)

    def change(self, values: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """See `ContactChange.change`."""
        fast, both, balances = self._fast_and_slow(values, inputs, base)
        balanced, of_slow = np.split(self.balanced(balances, both), 2)
        return np.asarray(followed(balances[0], fast, balanced) - of_slow / SLOW)

    def change_by_values(self, values: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """See `ContactChange.change_by_values`; of what follows by differences."""
        fast, both, balances = self._fast_and_slow(values, inputs, base)
        balanced, _ = np.split(self.balanced(balances, both), 2)
        by_values, of_slow = np.split(self.balanced_by_values(balances, both), 2, axis=1)
        at = followed(balances[0], fast, balanced)
        changes = []
        for place, column in zip(IN_BALANCE, by_values, strict=True):
            stepped = balances[0].copy()
            stepped[place] += STEP
            changes.append((followed(stepped, fast, balanced + STEP * column) - at) / STEP)
        of_slow = of_slow / SLOW
        of_slow[-1] *= SLOW  # the slip scale is that of slow speeds
        return np.asarray(changes) - of_slow

    def _fast_and_slow(
        self, values: FloatArray, inputs: Inputs, base: Base
    ) -> tuple[Inputs, Inputs, FloatArray]:
        """Level inputs (K,); the same and slow ones (2 K,), and parameters (2 K, 9) of `Contact`.

        Balances of both are found at once.
        """
        fast = Inputs(inputs.tread_speeds_m_s, time_s=inputs.time_s)
        both = Inputs(np.concatenate([fast.tread_speeds_m_s, SLOW * fast.tread_speeds_m_s]))
        balances = [self.balance_values(values, base, scale) for scale in (1.0, SLOW)]
        return fast, both, np.repeat(balances, len(fast.roll_rad), axis=0)
