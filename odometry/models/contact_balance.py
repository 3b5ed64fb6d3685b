"""Balance of the forces on a robot whose treads slide: contact friction, gravity, inertia.

Everything is divided by the robot's weight, m g: the mass is in no term. Samples (N) come last;
contacts (C) before them. A wrench (3, N) is a force forward and to the left and a yaw moment
about the origin, [1, 1, m].
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.contact_stance import INSIDE, Stance, load_shares
from odometry.models.inertia_model import G_M_S2

IN_ROWS = np.array([[0, 1, 3], [1, 2, 4], [3, 4, 5]])  # of a symmetric matrix by its six entries
TIPPING = 0.95  # of the way to the edge of the base: where the centre of pressure is held


@dataclass(frozen=True)
class Balance:
    """The forces at a twist, and how they answer to small changes.

    Attributes
    ----------
    stance : Stance
    omega : (N,)
        [rad/s]
    centre_speeds_m_s : (2, N)
        Velocity of the centre of mass.
    slip_m_s : (2, C, N)
        Velocity of each contact over the ground.
    resistance : (C, N)
        1 / sqrt(slip^2 + slip_scale^2) [s/m]: friction by load, mu and slip.
    load : (C, N)
        On each contact, of the weight.
    pull : (2, N)
        Gravity and centrifugal force in the ground plane.
    shift : (2, N)
        Of the centre of pressure by `pull` if nothing held it, in base units.
    reach : (N,)
        Share of the shift that the base allows, 1 where it is not held.
    edge, heading : (2, N)
        Where it is held: 1 for the coordinate that is at its limit, and shift / shift there.
    contact_wrenches : (3, C, N)
        Of friction, by load.
    by_centre : (3, 2, N)
        Derivative of the friction wrench by the centre of pressure.
    """

    stance: Stance
    omega: FloatArray
    centre_speeds_m_s: FloatArray
    slip_m_s: FloatArray
    resistance: FloatArray
    load: FloatArray
    pull: FloatArray
    shift: FloatArray
    reach: FloatArray
    edge: FloatArray
    heading: FloatArray
    contact_wrenches: FloatArray
    by_centre: FloatArray

    @property
    def friction(self) -> FloatArray:
        """Wrench (3, N) of all contacts."""
        return np.asarray((self.load * self.contact_wrenches).sum(axis=1))

    @cached_property
    def residual(self) -> FloatArray:
        """Wrench (3, N) of all forces: zero where they balance."""
        return self.friction + wrench(self.pull, self.stance.centre_m)

    def by_slip(self, change: tuple[FloatArray | float, FloatArray | float]) -> FloatArray:
        """Change (3, N) of the wrench when the contacts' slip changes, each (C, N)."""
        slip, stance = self.slip_m_s, self.stance
        along = (slip[0] * change[0] + slip[1] * change[1]) * self.resistance**2
        stiffness = -self.load * self.resistance * stance.mu
        force = np.array(
            [stiffness * (part - slip * along) for part, slip in zip(change, slip, strict=True)]
        )
        return np.asarray(wrench(force, stance.places_m).sum(axis=1))

    def by_shift(self, change: FloatArray) -> FloatArray:
        """Change (3, ..., N) when the centre of pressure moves (2, ..., N), held at the edge."""
        edge, heading, by_centre = (
            _beside(of, change) for of in (self.edge, self.heading, self.by_centre)
        )
        along, across = change - heading * (edge[0] * change[0] + edge[1] * change[1])
        return np.asarray(by_centre[:, 0] * along + by_centre[:, 1] * across)

    def by_pull(self, change: FloatArray) -> FloatArray:
        """Change (3, ..., N) when the pull changes (2, ..., N): its own wrench, and the loads."""
        moved = _beside(self._levers, change) * change
        return self.by_shift(moved) + wrench(change, self.stance.centre_m)

    @cached_property
    def _levers(self) -> FloatArray:
        """How far (2, N) the centre of pressure moves by the pull, in base units."""
        stance = self.stance
        return np.asarray(self.reach * stance.height_m / (stance.normal * stance.base_m))

    @property
    def by_twist(self) -> FloatArray:
        """Derivative (3, 3, N) of the residual by the twist."""
        x_cm, y_cm = self.stance.centre_m
        v_x, v_y = self.centre_speeds_m_s
        omega = self.omega
        pulls = np.zeros((2, 3, len(omega)))
        pulls[0, 1], pulls[1, 0] = omega, -omega
        pulls[0, 2], pulls[1, 2] = v_y + omega * x_cm, omega * y_cm - v_x
        pulls /= G_M_S2
        return self._friction_by_twist() + self.by_pull(pulls)

    def _friction_by_twist(self) -> FloatArray:
        """The part (3, 3, N) of the contacts' slip, which is symmetric."""
        x, y = self.stance.places_m
        ahead, aside = self.slip_m_s * self.resistance
        stiffness = -self.load * self.resistance * self.stance.mu
        xx, xy = stiffness * (1 - ahead * ahead), -stiffness * ahead * aside
        yy = stiffness * (1 - aside * aside)
        x_turn, y_turn = x * xy - y * xx, x * yy - y * xy
        parts = np.stack([xx, xy, yy, x_turn, y_turn, x * y_turn - y * x_turn])
        return np.asarray(parts.sum(axis=1)[IN_ROWS])


def balance_at(stance: Stance, twist: FloatArray) -> Balance:
    """The forces at twists (3, N)."""
    v_x, v_y, omega = twist
    x, y = stance.places_m
    x_cm, y_cm = stance.centre_m
    left, right = stance.tread_speeds_m_s
    tread = np.where(stance.layout.places[2] > 0, left, right)
    slip = np.stack([v_x - omega * y - tread, v_y + omega * x])
    resistance = 1 / np.sqrt(slip[0] ** 2 + slip[1] ** 2 + stance.slip_scale_m_s**2)
    contact_wrenches = wrench(-stance.mu * resistance * slip, stance.places_m)
    centre_speeds = np.array([v_x - omega * y_cm, v_y + omega * x_cm])  # Martinez 2017 eq. 9-10
    centrifugal = np.array([omega * centre_speeds[1], -omega * centre_speeds[0]]) / G_M_S2
    pull = stance.gravity + centrifugal
    shift = stance.height_m * pull / (stance.normal * stance.base_m)
    reach, edge, heading = _held_within_base(stance.centre, shift)
    shares, slopes = load_shares(stance.centre + reach * shift, stance.layout)
    by_centre = (contact_wrenches[:, None] * slopes).sum(axis=2)
    return Balance(
        stance,
        omega,
        centre_speeds,
        slip,
        resistance,
        stance.normal * shares,
        pull,
        shift,
        reach,
        edge,
        heading,
        contact_wrenches,
        stance.normal * by_centre,
    )


def wrench(force: FloatArray, place_m: FloatArray) -> FloatArray:
    """Forces (2, ...) at places (2, ...) with their moments about the origin: (3, ...)."""
    found = np.empty((3, *force.shape[1:]))
    found[:2] = force
    np.subtract(place_m[0] * force[1], place_m[1] * force[0], out=found[2])
    return found


def _beside(of: FloatArray, change: FloatArray) -> FloatArray:
    """What samples (..., N) have, beside changes (2, ..., N) of which each has several."""
    return of.reshape(*of.shape[:-1], *(1,) * (change.ndim - 2), of.shape[-1])


def _held_within_base(
    centre: FloatArray, shift: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Reach (N,), edge and heading (2, N) of `Balance`.

    The centre of pressure moves with the pull along one line, so that neither makes a yaw moment
    about the other; that stays so where it is held.
    """
    far = np.abs(shift) > TIPPING - INSIDE  # less leads to no edge
    room = np.full(shift.shape, np.inf)
    np.divide(np.copysign(TIPPING, shift) - centre, shift, out=room, where=far)
    reach = np.minimum(1.0, room.min(axis=0))
    first = room[0] <= room[1]
    edge = np.array([first, ~first]) * (reach < 1)
    heading = np.zeros(shift.shape)
    at_edge = np.where(first, shift[0], shift[1])
    np.divide(shift, at_edge, out=heading, where=reach < 1)
    return reach, edge, heading
