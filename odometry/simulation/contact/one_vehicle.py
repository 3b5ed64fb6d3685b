"""One vehicle on its contacts in plain numbers: the equations and the method of many vehicles.

`ContactDynamics.rate` and `rosenbrock_step` take a stack of vehicles; here are the same equations
for one, several times faster where there is only one. Differences are roundings.
"""

from cmath import rect
from collections.abc import Callable, Sequence
from math import sqrt, tanh

import numpy as np

from odometry.arrays import ComplexArray, FloatArray
from odometry.simulation.contact.dynamics import ContactDynamics
from odometry.simulation.contact.friction import GRAVITY_M_S2
from odometry.simulation.contact.integrate import GAMMA
from odometry.simulation.contact.one_contacts import Forces, Memory, Sums, contacts_of, forces_of
from odometry.simulation.contact.slope import Ground, Plane, Zones

Body = tuple[complex, float, complex, float, complex]
"""Position, yaw, velocity, yaw rate and the contact force that the loads have followed."""
OfGround = Callable[[complex, complex], complex]


class OneVehicle:
    """Steps of one vehicle.

    Parameters
    ----------
    dynamics : ContactDynamics
        With the friction of one vehicle.
    forces : Forces
        Of its contacts.
    """

    def __init__(self, dynamics: ContactDynamics, forces: Forces) -> None:
        self._dynamics, self._forces = dynamics, forces
        vehicle = dynamics.vehicle
        self._mass, self._inertia = float(vehicle.mass_kg), float(vehicle.yaw_inertia_kg_m2)
        self._settling_s = float(vehicle.settling_s)
        self._height_m = float(vehicle.centre_of_mass_m[2])
        self._centre = dynamics.centre_of_mass
        self._of_balance = dynamics.normal_loads.of_balance
        self._rise, self._rise_rate = rises_on(dynamics.ground)

    def advanced(
        self, state: ComplexArray, tread_speeds_m_s: FloatArray, step_s: float, steps: int
    ) -> ComplexArray:
        """The state (1, S) some steps later; not a number where the vehicle runs away."""
        position, yaw, velocity, omega, force, *memory = state[0].tolist()
        treads = tread_speeds_m_s[0].tolist()
        body: Body = (position, yaw.real, velocity, omega.real, force)
        try:
            for _ in range(steps):
                body, memory = self._step(body, memory, treads, step_s)
        except (OverflowError, ValueError, ZeroDivisionError):
            return np.full_like(state, np.nan)
        return np.array([[*body, *memory]], dtype=np.complex128)

    def _step(
        self, body: Body, memory: Memory, treads: Sequence[float], step_s: float
    ) -> tuple[Body, list[complex]]:
        """One step of ROS2, see `rosenbrock_step`."""
        rate, at_start = self._rate(body, memory, treads)
        first = self._damped(rate, at_start, step_s)
        slid = at_start.memory_rates_m_s
        there = [j + step_s * k for j, k in zip(memory, slid, strict=True)]
        rate, at_end = self._rate(_moved(body, first, step_s), there, treads)
        second = self._damped(_moved(rate, first, -2.0), at_start, step_s)
        after = _moved(_moved(body, first, 1.5 * step_s), second, 0.5 * step_s)
        slides = zip(memory, slid, at_end.memory_rates_m_s, strict=True)
        return after, [j + 0.5 * step_s * (k + last) for j, k, last in slides]

    def _damped(self, rate: Body, contacts: Sums, step_s: float) -> Body:
        """The stage for a right-hand side, see `Damping`."""
        over_ground, yaw_rate, push, twist, following = rate
        by_mass, by_inertia = GAMMA * step_s / self._mass, GAMMA * step_s / self._inertia
        _, _, _, damping, first, turning = contacts
        straight = 1 + by_mass * damping
        size2 = first.real * first.real + first.imag * first.imag
        turning = 1 + by_inertia * turning - by_mass * by_inertia * size2 / straight
        push /= straight
        turn = (twist - by_inertia * (first.conjugate() * push).imag) / turning
        push -= 1j * by_mass * turn / straight * first
        return over_ground, yaw_rate, push, turn, following

    def _rate(self, body: Body, memory: Memory, treads: Sequence[float]) -> tuple[Body, Sums]:
        """Rate of the state, see `ContactDynamics.rate`."""
        position, yaw, velocity, omega, followed = body
        heading = rect(1.0, yaw)
        rise = self._rise(position, heading)
        stretch = sqrt(1 + rise.real * rise.real)
        length = sqrt(stretch * stretch + rise.imag * rise.imag)
        sin_roll, cos_roll = rise.imag / length, stretch / length
        sin_pitch, cos_pitch = -rise.real / stretch, 1 / stretch
        in_plane = complex(GRAVITY_M_S2 * sin_pitch, -GRAVITY_M_S2 * cos_pitch * sin_roll)
        weight = self._mass * GRAVITY_M_S2 * cos_pitch * cos_roll
        loads = self._loads(weight, weight * self._centre - self._height_m * followed)
        contacts = self._forces(velocity, omega, treads, loads, memory)
        force = contacts.force_n

        at_origin = velocity - 1j * omega * self._centre
        forward = cos_pitch * at_origin.real + sin_pitch * sin_roll * at_origin.imag
        over_ground = heading * complex(forward, cos_roll * at_origin.imag)
        bending = (self._rise_rate(position, over_ground) * heading.conjugate()).real
        nose_down = -bending * cos_pitch * cos_pitch * cos_roll
        rate = (
            over_ground,
            (sin_roll * nose_down + cos_roll * omega) / cos_pitch,
            force / self._mass + in_plane - 1j * omega * velocity,
            contacts.moment_nm / self._inertia,
            (force - followed) / self._settling_s,
        )
        return rate, contacts

    def _loads(self, weight_n: float, moment_nm: complex) -> list[float]:
        x, y = moment_nm.real, moment_nm.imag
        loads = [weight_n * a + x * b + y * c for a, b, c in self._of_balance]
        if min(loads) < 0:
            lifted = self._dynamics.normal_loads(np.array([weight_n]), np.array([moment_nm]))
            return list(lifted[0].tolist())
        return loads


def _moved(body: Body, rate: Body, step_s: float) -> Body:
    position, yaw, velocity, omega, force = body
    of_position, of_yaw, of_velocity, of_omega, of_force = rate
    return (
        position + step_s * of_position,
        yaw + step_s * of_yaw,
        velocity + step_s * of_velocity,
        omega + step_s * of_omega,
        force + step_s * of_force,
    )


def one_vehicle(dynamics: ContactDynamics) -> OneVehicle | None:
    """The vehicle of dynamics in plain numbers; None where its friction law is not known here."""
    contacts = contacts_of(dynamics.arms_m, dynamics.friction.reshape(-1), dynamics.entry_m)
    forces = forces_of(dynamics.law, contacts, float(dynamics.lateral_share))
    return None if forces is None else OneVehicle(dynamics, forces)


def rises_on(ground: Ground) -> tuple[OfGround, OfGround]:
    """`Ground.rise` and `Ground.rise_rate` of one point."""
    if type(ground) is Plane:
        gradient = ground.gradient
        return (lambda _, heading: gradient * heading.conjugate()), (lambda _, __: 0j)
    if type(ground) is Zones:
        return _rises_on_zones(ground)

    def rise(point: complex, heading: complex) -> complex:
        return complex(ground.rise(np.array([point]), np.array([heading]))[0])

    def rise_rate(point: complex, velocity: complex) -> complex:
        return complex(ground.rise_rate(np.array([point]), np.array([velocity]))[0])

    return rise, rise_rate


def _rises_on_zones(zones: Zones) -> tuple[OfGround, OfGround]:
    slopes = np.tan(zones.slopes_rad)
    first, uphill, crease_m = float(slopes[0]), zones.uphill, zones.crease_m
    edges: list[tuple[float, float]] = list(
        zip(zones.edges_m, np.diff(slopes).tolist(), strict=True)
    )

    def rise(point: complex, heading: complex) -> complex:
        along = (uphill.conjugate() * point).real
        steps = ((0.5 + 0.5 * tanh((along - edge) / crease_m)) * by for edge, by in edges)
        return (first + sum(steps)) * uphill * heading.conjugate()

    def rise_rate(point: complex, velocity: complex) -> complex:
        along = (uphill.conjugate() * point).real
        bends = ((1 - tanh((along - edge) / crease_m) ** 2) * by for edge, by in edges)
        climbing = (uphill.conjugate() * velocity).real
        return 0.5 / crease_m * sum(bends) * climbing * uphill

    return rise, rise_rate
