"""Derivatives of the balanced twist, by the implicit function theorem.

Where residual(twist, p) = 0, the twist follows p by -(d residual / d twist)^-1 d residual / d p.
"""

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.contact_balance import Balance
from odometry.models.contact_solve import solve_3x3
from odometry.models.inertia_model import G_M_S2


def parameter_derivative(balance: Balance) -> FloatArray:
    """Derivative (3, 9, N) of a balanced twist by the parameters, in the order of `Contact`.

    Zero by the mass, which is in no term, and by the number of contacts.
    """
    none = np.zeros_like(balance.residual)
    columns = [
        _by_mu(balance),
        none,
        _by_centre_of_mass(balance, 0),
        _by_centre_of_mass(balance, 1),
        balance.by_shift(_shift_by_height(balance)),
        _by_half_length(balance),
        _by_half_width(balance),
        none,
        _by_slip_scale(balance),
    ]
    return solve_3x3(-balance.by_twist, np.stack(columns, axis=1))


def speed_derivative(balance: Balance) -> FloatArray:
    """Derivative (3, 2, N) of a balanced twist by (v_left, v_right)."""
    is_left = (balance.stance.layout.places[2] > 0).astype(float)
    columns = [balance.by_slip((-is_left, 0.0)), balance.by_slip((is_left - 1, 0.0))]
    return solve_3x3(-balance.by_twist, np.stack(columns, axis=1))


def _by_mu(balance: Balance) -> FloatArray:
    """Friction is proportional to mu; so is gravity where friction would not hold it."""
    stance = balance.stance
    gravity = np.where(stance.held, stance.gravity, 0.0)
    return np.asarray((balance.friction / stance.mu) + balance.by_pull(gravity / stance.mu))


def _shift_by_height(balance: Balance) -> FloatArray:
    stance = balance.stance
    return np.asarray(balance.reach * balance.pull / (stance.normal * stance.base_m))


def _by_slip_scale(balance: Balance) -> FloatArray:
    change = -(balance.resistance**2) * balance.stance.slip_scale_m_s
    return np.asarray(np.sum(balance.load * change * balance.contact_wrenches, axis=1))


def _by_centre_of_mass(balance: Balance, axis: int) -> FloatArray:
    inside = balance.stance.centre_is_inside[axis].astype(float)
    return _by_centre(balance, axis, inside, inside / balance.stance.base_m[axis])


def _by_half_length(balance: Balance) -> FloatArray:
    """The contacts move forward and backward, and with them all quantities in base units."""
    forward, omega = balance.stance.layout.places[1], balance.omega
    moment = np.sum(balance.load * forward * balance.contact_wrenches[1], axis=0)
    contacts = balance.by_slip((0.0, omega * forward)) + _moment(moment)
    return np.asarray(contacts + _by_base(balance, 0))


def _by_half_width(balance: Balance) -> FloatArray:
    side, omega = balance.stance.layout.places[2], balance.omega
    moment = -np.sum(balance.load * side * balance.contact_wrenches[0], axis=0)
    contacts = balance.by_slip((-omega * side, 0.0)) + _moment(moment)
    return np.asarray(contacts + _by_base(balance, 1))


def _by_base(balance: Balance, axis: int) -> FloatArray:
    """A centre of mass stays in its place in metres; one that is held at the edge goes along."""
    stance = balance.stance
    centre, inside = stance.centre[axis], stance.centre_is_inside[axis]
    moved = np.where(inside, 0.0, centre)
    share = -(centre - moved + balance.reach * balance.shift[axis]) / stance.base_m[axis]
    return _by_centre(balance, axis, moved, share)


def _by_centre(balance: Balance, axis: int, metres: FloatArray, share: FloatArray) -> FloatArray:
    """Change (3, N) when the centre of mass moves by metres (N,), the centre of pressure by share.

    The share is of the base, before the change of the centrifugal force.
    """
    pull, shift = np.zeros_like(balance.pull), np.zeros_like(balance.shift)
    pull[axis] = metres * balance.omega**2 / G_M_S2
    shift[axis] = share
    lever = balance.pull[1] if axis == 0 else -balance.pull[0]
    return np.asarray(balance.by_pull(pull) + balance.by_shift(shift) + _moment(metres * lever))


def _moment(moment: FloatArray) -> FloatArray:
    return np.stack([np.zeros_like(moment), np.zeros_like(moment), moment])
