"""Equations of motion of a skid-steer vehicle on its contacts.

The state of one vehicle is a row of complex numbers, x + i y; yaw and yaw rate are real: position
of the origin in the world, yaw, velocity of the centre of mass in body axes, yaw rate, the contact
force that the loads have followed so far, and the memory of each contact.
"""

from copy import copy
from typing import NamedTuple

import numpy as np

from odometry.arrays import ComplexArray, FloatArray
from odometry.errors import SimulationError
from odometry.simulation.contact.friction import FrictionLaw, cross
from odometry.simulation.contact.slope import Ground, Tilt, gravity, tilt
from odometry.simulation.contact.vehicle import ContactVehicle

POSITION, YAW, VELOCITY, YAW_RATE, FOLLOWED_FORCE, MEMORY = range(6)

MOST_CHANGES = 50


class Contacts(NamedTuple):
    """What happens at the n contacts of B vehicles, each (B, n); left side first.

    Attributes
    ----------
    loads_n : array
    slips_m_s : complex array
        Velocity of the tread's surface over the ground.
    forces_n : complex array
        On the vehicle, in the contact plane.
    memory_rates_m_s : complex array
        Of the friction law.
    damping_kg_s : array
        Force against a small change of slip.
    """

    loads_n: FloatArray
    slips_m_s: ComplexArray
    forces_n: ComplexArray
    memory_rates_m_s: ComplexArray
    damping_kg_s: FloatArray


class ContactDynamics:
    """A vehicle on a ground: the rate of its state, for B vehicles at once.

    Attributes
    ----------
    vehicle : ContactVehicle
    ground : Ground
    law : FrictionLaw
        The vehicle's, unless `on` gives another, as with the friction.
    centre_of_mass : complex
        In the contact plane, from the origin.
    arms_m : (n,) complex array
        From the centre of mass to each contact.
    normal_loads : NormalLoads
    friction : (n,) or (B, n) array
    lateral_share : float
        Of the traction sideways.
    entry_m : (2, n) array
        Distance of each contact from where its tread meets the ground, ahead and back.
    """

    def __init__(self, vehicle: ContactVehicle, ground: Ground) -> None:
        self.vehicle, self.ground = vehicle, ground
        x, y, self._height_m = vehicle.centre_of_mass_m
        self.centre_of_mass = complex(x, y)
        self.arms_m = vehicle.places_m - self.centre_of_mass
        self.normal_loads = NormalLoads(vehicle.places_m)
        self.law, self.friction, self.lateral_share = vehicle.law, vehicle.friction.ravel(), 1.0
        self.entry_m = np.tile(vehicle.entry_m, 2)

    def on(self, friction: FloatArray, law: FrictionLaw, lateral_share: float) -> "ContactDynamics":
        """The same with another friction (B, n), law, and share of the traction sideways."""
        other = copy(self)
        other.law, other.friction, other.lateral_share = law, friction, lateral_share
        return other

    def start(self, positions: ComplexArray, yaws_rad: FloatArray) -> ComplexArray:
        """States (B, S) at rest, under the loads of rest."""
        memory = self.law.states_per_contact * len(self.arms_m)
        state = np.zeros((len(positions), MEMORY + memory), dtype=np.complex128)
        state[:, POSITION], state[:, YAW] = positions, yaws_rad
        state[:, FOLLOWED_FORCE] = -self.vehicle.mass_kg * gravity(self.tilt(state))[0]
        return state

    def tilt(self, state: ComplexArray) -> Tilt:
        """Roll and pitch of the body flat on the ground."""
        return tilt(self.ground.rise(state[:, POSITION], np.exp(1j * state[:, YAW].real)))

    def origin_velocity(self, state: ComplexArray) -> ComplexArray:
        """Velocity (B,) of the robot's origin in body axes."""
        turning = 1j * state[:, YAW_RATE].real * self.centre_of_mass
        return np.asarray(state[:, VELOCITY] - turning)

    def contacts(
        self, state: ComplexArray, tread_speeds_m_s: FloatArray, normal_gravity_m_s2: FloatArray
    ) -> Contacts:
        """Loads, slips and forces of all contacts.

        The contact forces act at the ground, `height` below the centre of mass: the point on
        which the weight W acts moves against their sum F, sum(N_i r_i) = W r_cm - height F. F is
        the force that the suspension has followed so far.
        """
        weight = self.vehicle.mass_kg * normal_gravity_m_s2
        moment = weight * self.centre_of_mass - self._height_m * state[:, FOLLOWED_FORCE]
        loads = self.normal_loads(weight, moment)
        treads = np.repeat(tread_speeds_m_s, len(self.arms_m) // 2, axis=-1)
        slips = state[:, VELOCITY, None] + 1j * state[:, YAW_RATE, None].real * self.arms_m - treads
        renewal = np.abs(treads) / np.where(treads > 0, *self.entry_m)
        memory, law = state[:, MEMORY:], self.law
        rates = law.displacement_rate(slips, memory, renewal)
        opposed, factor = law.yielding(slips, memory, rates)
        stiffness = self.friction * loads * factor
        shared: ComplexArray = opposed.real + 1j * (self.lateral_share * opposed.imag)
        damping = stiffness * (law.lead * max(1.0, self.lateral_share))
        return Contacts(loads, slips, -stiffness * shared, rates, damping)

    def rate(
        self, state: ComplexArray, tread_speeds_m_s: FloatArray
    ) -> tuple[ComplexArray, Contacts]:
        """Rate of the states (B, S), and the contacts on the way.

        Newton and Euler in the body's axes: m (dv/dt + i omega v) = F + m g,
        I domega/dt = moment of F about the centre of mass. What the bending of the ground does to
        the normal loads (speed squared by curvature) is left out.
        """
        vehicle = self.vehicle
        attitude = self.tilt(state)
        in_plane, normal = gravity(attitude)
        contacts = self.contacts(state, tread_speeds_m_s, normal)
        force = contacts.forces_n.sum(axis=-1)
        moment = cross(self.arms_m, contacts.forces_n).sum(axis=-1)
        coriolis = 1j * state[:, YAW_RATE].real * state[:, VELOCITY]
        result = np.empty_like(state)
        result[:, POSITION], result[:, YAW] = self._pose_rate(state, attitude)
        result[:, VELOCITY] = force / vehicle.mass_kg + in_plane - coriolis
        result[:, YAW_RATE] = moment / vehicle.yaw_inertia_kg_m2
        result[:, FOLLOWED_FORCE] = (force - state[:, FOLLOWED_FORCE]) / vehicle.settling_s
        result[:, MEMORY:] = contacts.memory_rates_m_s
        return result, contacts

    def _pose_rate(self, state: ComplexArray, attitude: Tilt) -> tuple[ComplexArray, FloatArray]:
        """Velocity over ground, and rate of yaw.

        The velocity is Rz(yaw) Ry(pitch) Rx(roll) (v_x, v_y, 0). The yaw follows the body's rates
        about y and z; the one about y is that of the x axis following the bending ground.
        """
        sin_roll, cos_roll, sin_pitch, cos_pitch = attitude
        velocity, omega = self.origin_velocity(state), state[:, YAW_RATE].real
        heading = np.exp(1j * state[:, YAW].real)
        forward = cos_pitch * velocity.real + sin_pitch * sin_roll * velocity.imag
        over_ground = heading * (forward + 1j * cos_roll * velocity.imag)
        bending = self.ground.rise_rate(state[:, POSITION], over_ground) * heading.conj()
        nose_down = -bending.real * cos_pitch**2 * cos_roll
        return over_ground, (sin_roll * nose_down + cos_roll * omega) / cos_pitch


class NormalLoads:
    """Loads of n contacts at fixed places, from the weight and its moment.

    A rigid body sinks by the same plane a + b . r everywhere, so that N_i = max(0, a + b . r_i):
    a contact carries or lifts off, it never pulls. a and b follow from the balance of force and
    moments.

    Parameters
    ----------
    places_m : (n,) complex array
        Contacts in the contact plane, not all on a line.

    Attributes
    ----------
    of_balance : list of (float, float, float)
        For each contact: load by the weight and by both parts of its moment, where none lifts off.
    """

    def __init__(self, places_m: ComplexArray) -> None:
        self.places_m = places_m
        self._shape = np.stack([np.ones(len(places_m)), places_m.real, places_m.imag])
        self._linear = np.linalg.pinv(self._shape).T
        self.of_balance = [tuple(column) for column in self._linear.T.tolist()]

    def __call__(self, weight_n: FloatArray, moment_nm: ComplexArray) -> FloatArray:
        """Loads (B, n) [N].

        Parameters
        ----------
        weight_n : (B,) array
            Sum of the loads.
        moment_nm : (B,) complex array
            Sum of load times place: weight times the point on which it acts.

        Raises
        ------
        SimulationError
            If that point is outside of the contacts: the vehicle tips over.
        """
        balance = np.stack([weight_n, moment_nm.real, moment_nm.imag], axis=-1)
        loads = balance @ self._linear
        lifted = loads.min(axis=-1) < 0
        if lifted.any():
            loads[lifted] = self._with_lift_off(balance[lifted])
        return np.asarray(loads)

    def _with_lift_off(self, balance: FloatArray) -> FloatArray:
        """Change the set of carrying contacts until it is that of the positive loads."""
        carrying = np.ones((len(balance), self._shape.shape[1]), dtype=bool)
        for _ in range(MOST_CHANGES):
            stiffness = np.einsum("kn,bn,ln->bkl", self._shape, carrying, self._shape)
            try:
                plane = np.linalg.solve(stiffness, balance[..., None])[..., 0]
            except np.linalg.LinAlgError:
                break
            sunk = plane @ self._shape
            if ((sunk > 0) == carrying).all():
                return np.asarray(np.where(carrying, sunk, 0.0))
            carrying = sunk > 0
        points = balance[:, 1:] / balance[:, :1]
        raise SimulationError(
            "the vehicle tips over: its weight acts outside of its contacts, at one of (x, y) = "
            f"{np.round(points, 3).tolist()[:4]} m"
        )
