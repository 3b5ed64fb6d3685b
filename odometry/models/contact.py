"""Quasi-static force balance of the contacts under both treads.

None of the papers has it. Its parts are known: pressure on single points (Martinez 2017,
section II), centrifugal force (Martinez 2017 eq. 10), Coulomb friction against the sliding of each
contact.
"""

from collections.abc import Callable

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.models.base import KinematicModel, Linearised, Parameter
from odometry.models.contact_balance import Balance, balance_at
from odometry.models.contact_solve import balanced_near, balanced_twist
from odometry.models.contact_stance import INSIDE, Stance, stance_of
from odometry.models.icr_slope import GUESSED_HALF_LENGTH
from odometry.models.inertia_model import G_M_S2
from odometry.models.inputs import Inputs
from odometry.models.three_equations import solve_3x3
from odometry.recording.run import Robot

BLOCK = 4096  # samples at a time: what is known of their contacts fits the cache
GUESSED_HEIGHT = 0.3  # of the track width
GUESSED_MASS_KG = 1.0


class Contact(KinematicModel):
    """The steady twist at which friction, gravity and centrifugal force balance.

    `contacts` points a side (rounded), evenly spaced from -half_length to half_length at
    y = half_width and y = -half_width, slide at s_i = (v_x - omega y_i - v_tread, v_y + omega x_i)
    and are held back by mu N_i s_i / sqrt(|s_i|^2 + slip_scale^2). Gravity, by roll and pitch, and
    the centrifugal force of the steady twist act at the centre of mass (x_cm, y_cm, height). The
    loads N_i are those of a rigid body on equal springs that cannot pull: they balance the normal
    force and the moments of roll and pitch, load transfer included. Angular acceleration, changes
    of the twist and products of inertia are left out.

    The loads are shares of the normal part of m g, and so friction, gravity and centrifugal force
    are all proportional to m: divided by it, no term of the balance has it left. The twist does
    not depend on the mass. Level and slow, it does not depend on mu or height either.

    Limits, all of them continuous, with derivatives that jump:

    - A slope steeper than 0.95 mu is taken as one of 0.95 mu: beyond mu a robot slides ever
      faster, and no twist is steady.
    - Load transfer ends where the centre of pressure has gone 0.95 of the way from the middle to
      the edge of the base: beyond 1 the robot tips over.
    - A contact lifts off, or comes down.

    Below `slip_scale` friction is viscous: a robot at rest on a slope creeps down, at
    slip_scale tan / sqrt(mu^2 - tan^2) of the slope. Where a robot corners at more than its
    friction bears there may be no steady twist, or several; the answer is then the one that the
    search finds or, failing that, the twist of least residual, whose derivatives mean little.
    It is always finite.
    """

    name = "contact"
    source = "force balance of this project; contacts and inertia as Martinez 2017, II and III-A"
    parameters = (
        Parameter("mu", "", 1e-3, search=(0.05, 1.5)),
        Parameter("mass", "kg", 1e-3, known=True),
        Parameter("x_cm", "m", search=(-0.3, 0.3)),
        Parameter("y_cm", "m", search=(-0.3, 0.3)),
        Parameter("height", "m", 0.0, search=(0.0, 2.0), neutral=0.0),
        Parameter("half_length", "m", 1e-3, search=(0.02, 3.0)),
        Parameter("half_width", "m", 1e-3, known=True),
        Parameter("contacts", "", 2.0, 100.0, known=True),
        Parameter("slip_scale", "m/s", 1e-9, search=(1e-3, 0.3)),
    )

    def check(self, values: FloatArray) -> None:
        """The centre of mass must lie within 0.9 of the base."""
        _, _, x_cm, y_cm, _, half_length, half_width, _, _ = values
        for name, centre, half in (("x_cm", x_cm, half_length), ("y_cm", y_cm, half_width)):
            if abs(centre) > INSIDE * half:
                raise ParameterError(
                    f"{name} = {centre} m, expected within {INSIDE} of {half} m from the middle "
                    "of the contacts: the robot would tip over"
                )

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""
        return _in_blocks(balanced_twist, values, inputs)

    def twist_near(self, values: FloatArray, inputs: Inputs, known: FloatArray) -> FloatArray:
        """`twist`, searched from twists (N, 3) for values a little different.

        Where several twists are steady, the answer is the one near those.
        """
        return _in_blocks(balanced_near, values, inputs, known)

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`."""
        both = _in_blocks(_linearised, values, inputs)
        return Linearised(both[..., 0], both[..., 1:])

    def derivative_at(self, values: FloatArray, inputs: Inputs, twist: FloatArray) -> FloatArray:
        """Derivative (N, 3, P) by the parameters (N, P) of twists (N, 3) that are balanced."""
        balance = balance_at(stance_of(values, inputs), twist.T)
        return np.asarray(np.moveaxis(parameter_derivative(balance), -1, 0))

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        return _in_blocks(_speed_derivative, values, inputs)

    def guess(self, robot: Robot) -> dict[str, float]:
        """Four wheels under the treads, mass in the middle."""
        half_width = robot.track_width / 2
        return {
            "mu": 0.6,
            "mass": robot.mass or GUESSED_MASS_KG,
            "x_cm": 0.0,
            "y_cm": 0.0,
            "height": GUESSED_HEIGHT * robot.track_width,
            "half_length": GUESSED_HALF_LENGTH * robot.length if robot.length else half_width,
            "half_width": half_width,
            "contacts": 2.0,
            "slip_scale": 0.03,
        }


def _linearised(stance: Stance) -> FloatArray:
    """The twist, then its derivative by the parameters (3, 1 + 9, N)."""
    twist = balanced_twist(stance)
    by_parameters = parameter_derivative(balance_at(stance, twist))
    return np.concatenate([twist[:, None], by_parameters], axis=1)


def _speed_derivative(stance: Stance) -> FloatArray:
    return speed_derivative(balance_at(stance, balanced_twist(stance)))


def _in_blocks(
    answer: Callable[..., FloatArray], values: FloatArray, inputs: Inputs, *known: FloatArray
) -> FloatArray:
    """Broadcast, and answer a stance of N samples at a time: of (M, N) it makes (..., M).

    What is `known` (..., M) of the samples goes with the stance, as (M, N).
    """
    stack = np.broadcast_shapes(np.shape(values)[:-1], inputs.shape)
    rows = np.broadcast_to(values, (*stack, np.shape(values)[-1])).reshape(-1, np.shape(values)[-1])
    speeds = np.broadcast_to(inputs.tread_speeds_m_s, (*stack, 2)).reshape(-1, 2)
    roll, pitch = (
        np.broadcast_to(angle, stack).reshape(-1) for angle in (inputs.roll_rad, inputs.pitch_rad)
    )
    flat = Inputs(speeds, roll, pitch)
    answers = [
        answer(stance_of(rows[block], flat.rows(block)), *(of[block].T for of in known))
        for block in (slice(k, k + BLOCK) for k in range(0, max(len(rows), 1), BLOCK))
    ]
    joined = np.concatenate(answers, axis=-1)
    entries = joined.ndim - 1
    last = range(-entries, 0)
    return np.moveaxis(joined.reshape(*joined.shape[:-1], *stack), range(entries), last)


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
