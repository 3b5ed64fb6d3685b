"""The motion of a robot whose mass and yaw inertia follow the balance of its contacts, late."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.held_commands import held_spans
from odometry.models.contact_balance import Balance, balance_at
from odometry.models.contact_stance import stance_of
from odometry.models.inertia_model import G_M_S2
from odometry.models.inputs import Inputs


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
    behind = np.zeros_like(balanced)
    for row in np.flatnonzero(~starts):
        behind[row] = kept[row] @ (behind[row - 1] - steps[row])
    return balanced + behind


def _kept(
    values: FloatArray, inputs: Inputs, balanced: FloatArray, held_s: FloatArray
) -> FloatArray:
    """What (N, 3, 3) a sample leaves of a distance from the balance, never of more energy.

    Where a robot is about to tip over the derivative of the forces may push away from it.
    """
    stance = stance_of(np.broadcast_to(values, (len(balanced), len(values))), inputs)
    balance = balance_at(stance, balanced.T)
    by_twist = np.moveaxis(balance.by_twist, -1, 0)
    inertia = _inertia(values)
    of_loads = _loads_shifted(balance) @ inertia[:2]
    rates = G_M_S2 * np.linalg.solve(inertia + of_loads, by_twist)
    root = np.linalg.cholesky(inertia).T
    unrooted = np.linalg.inv(root)
    kept = root @ np.linalg.inv(np.eye(3) - held_s[:, None, None] * rates) @ unrooted
    large = np.linalg.norm(kept, axis=(1, 2)) > 1.0  # by the sum of squares, which is no less
    sizes = np.linalg.norm(kept[large], ord=2, axis=(1, 2))
    kept[large] /= np.maximum(1.0, sizes)[:, None, None]
    return np.asarray(unrooted @ kept @ root)


def _loads_shifted(balance: Balance) -> FloatArray:
    """Friction lost (N, 3, 2) to loads shifting as the centre of mass speeds up, by its rate."""
    stance = balance.stance
    levers = balance.reach * stance.height_m / (stance.normal * stance.base_m)
    shifts = [balance.by_shift(levers * axis[:, None]) for axis in np.eye(2)]
    return np.moveaxis(np.asarray(shifts), (0, 1, 2), (2, 1, 0))


def _inertia(values: FloatArray) -> FloatArray:
    """Inertia (3, 3) about the origin over the mass: an even plate as large as the contacts."""
    _, _, x_cm, y_cm, _, half_length, half_width, _, _ = values
    turning_m2 = (half_length**2 + half_width**2) / 3 + x_cm**2 + y_cm**2
    return np.array([[1.0, 0.0, -y_cm], [0.0, 1.0, x_cm], [-y_cm, x_cm, turning_m2]])
