"""Sliding downhill and inertia by the forces of contacts with the terrain."""

import numpy as np
from scipy.linalg.lapack import dtbtrs

from odometry.arrays import FloatArray
from odometry.effects.commands.held_commands import held_spans
from odometry.effects.interface.base import Effect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.recorded import Recorded
from odometry.effects.motion.contact_change import IN_BALANCE, ContactChange
from odometry.effects.motion.slope_icr import lacks_tilt
from odometry.models.contact_balance import Balance, balance_at
from odometry.models.contact_stance import stance_of
from odometry.models.inertia_model import G_M_S2
from odometry.models.inputs import Inputs
from odometry.models.three_equations import solve_3x3

LATERAL_M_S2 = 0.1  # with less no turn shifts a load; mass follows late at any speed
STEP = 1e-5  # of a parameter, for a derivative
SLOW = 0.02  # of the speeds: centrifugal force is 0.0004 of its own


class InertiaByContact(ContactChange):
    """What centrifugal force changes, and how late mass and yaw inertia follow the balance."""

    name = "inertia"
    in_words = "inertia in turns and changes of speed"
    equation = "twist + follows(balance(speeds)) - balance(slow speeds) / slowness"
    looks_like = "fast turns that come out wider or tighter, and follow changes of speed late"
    remedy = "keep it in the model, or drive turns more slowly"
    needs = "turns"

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


def followed(values: FloatArray, inputs: Inputs, balanced: FloatArray) -> FloatArray:
    """Twist (N, 3) of a robot that its contacts pull towards the balanced one (N, 3).

    Newton and Euler in body axes, M dv/dt = F(v, dv/dt), with F to first order about the balance,
    where it is zero; the loads answer to dv/dt, too. A step backward in time for each sample. Where
    a record begins, and without stamps, the balance has been reached.

    Parameters
    ----------
    values : (9,)
        Of `Contact`.
    inputs : Inputs
        N samples in time order.
    balanced : (N, 3)
        The twist of `Contact` there.
    """
    if inputs.time_s is None:
        return balanced
    held_s, starts = held_spans(inputs.time_s)
    kept = _kept(values, inputs, balanced, held_s)
    steps = np.diff(balanced, axis=0, prepend=balanced[:1])
    kept[..., starts] = 0.0
    return balanced + _recursion(kept, -np.einsum("ijn,nj->ni", kept, steps))


def _recursion(kept: FloatArray, pushed: FloatArray) -> FloatArray:
    """Rows (N, 3), each `kept` (3, 3, N) times the row before and what is `pushed` (N, 3).

    One triangular system, whose diagonals are five below the main one.
    """
    diagonals = np.zeros((6, pushed.size))
    for row, column in np.ndindex(3, 3):
        diagonals[3 + row - column, column:-3:3] = -kept[row, column, 1:]
    rows, _ = dtbtrs(diagonals, pushed.reshape(-1, 1), uplo="L", diag="U")
    return np.asarray(rows.reshape(-1, 3))


def _kept(
    values: FloatArray, inputs: Inputs, balanced: FloatArray, held_s: FloatArray
) -> FloatArray:
    """What (3, 3, N) a sample leaves of a distance from the balance, never of more energy.

    Where a robot is about to tip over the derivative of the forces may push away from it.
    """
    stance = stance_of(np.broadcast_to(values, (len(balanced), len(values))), inputs)
    balance = balance_at(stance, balanced.T)
    inertia = _inertia(values)
    pushed = inertia[..., None] + np.einsum("ijn,jk->ikn", _loads_shifted(balance), inertia[:2])
    kept = solve_3x3(pushed - G_M_S2 * held_s * balance.by_twist, pushed)
    root = np.linalg.cholesky(inertia).T
    scaled = np.tensordot(root, kept, axes=1).transpose(2, 0, 1) @ np.linalg.inv(root)
    large = np.linalg.norm(scaled, axis=(1, 2)) > 1.0  # by the sum of squares, which is no less
    sizes = np.linalg.norm(scaled[large], ord=2, axis=(1, 2))
    kept[..., large] /= np.maximum(1.0, sizes)
    return kept


def _loads_shifted(balance: Balance) -> FloatArray:
    """Friction lost (3, 2, N) to loads shifting as the centre of mass speeds up, by its rate."""
    stance = balance.stance
    levers = balance.reach * stance.height_m / (stance.normal * stance.base_m)
    return np.stack([balance.by_shift(levers * axis[:, None]) for axis in np.eye(2)], axis=1)


def _inertia(values: FloatArray) -> FloatArray:
    """Inertia (3, 3) about the origin over the mass: an even plate as large as the contacts."""
    _, _, x_cm, y_cm, _, half_length, half_width, _, _ = values
    turning_m2 = (half_length**2 + half_width**2) / 3 + x_cm**2 + y_cm**2
    return np.array([[1.0, 0.0, -y_cm], [0.0, 1.0, x_cm], [-y_cm, x_cm, turning_m2]])


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
