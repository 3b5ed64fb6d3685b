"""A linearly implicit method of second order for the equations of motion."""

import numpy as np

from odometry.arrays import ComplexArray, FloatArray
from odometry.simulation.contact.dynamics import VELOCITY, YAW_RATE, ContactDynamics, Contacts
from odometry.simulation.contact.friction import cross

GAMMA = float(1 - np.sqrt(0.5))
LONGEST_STEP_S = 0.005


class Damping:
    """Solver of (1 - h gamma A) k = b, where A is the damping of the contacts.

    A contact of damping c_i opposes the velocity of its place: force -c_i (v + i omega r_i). So A
    acts on velocity and yaw rate alone, and the 3 x 3 system is solved in closed form.

    Parameters
    ----------
    dynamics : ContactDynamics
    contacts : Contacts
        At the start of the step.
    step_s : float
    """

    def __init__(self, dynamics: ContactDynamics, contacts: Contacts, step_s: float) -> None:
        damping, arms = contacts.damping_kg_s, dynamics.arms_m
        by_mass = GAMMA * step_s / dynamics.vehicle.mass_kg
        self._by_inertia = GAMMA * step_s / dynamics.vehicle.yaw_inertia_kg_m2
        first = damping @ arms
        self._first = first
        self._straight = 1 + by_mass * damping.sum(axis=-1)
        self._coupling = 1j * by_mass * first
        turning = 1 + self._by_inertia * (damping @ np.abs(arms) ** 2)
        coupled = by_mass * self._by_inertia * np.abs(first) ** 2 / self._straight
        self._turning = turning - coupled

    def solve(self, rate: ComplexArray) -> ComplexArray:
        """The stage k (B, S) for a right-hand side (B, S), which is used up."""
        push = rate[:, VELOCITY] / self._straight
        twist = rate[:, YAW_RATE].real - self._by_inertia * cross(self._first, push)
        turn = twist / self._turning
        rate[:, YAW_RATE] = turn
        rate[:, VELOCITY] = push - self._coupling * turn / self._straight
        return rate


def rosenbrock_step(
    dynamics: ContactDynamics, state: ComplexArray, tread_speeds_m_s: FloatArray, step_s: float
) -> ComplexArray:
    """One step of ROS2 (Verwer, Spee, Blom and Hundsdorfer 1999).

    Of order 2 whatever matrix A approximates the Jacobian, and with the exact one damping stiff
    parts at any step: k1 = S F(y), k2 = S (F(y + h k1) - 2 k1), y + h (3 k1 + k2) / 2 with
    S = (1 - h gamma A)^-1.

    Parameters
    ----------
    dynamics : ContactDynamics
    state : (B, S) complex array
    tread_speeds_m_s : (B, 2) array
        Held over the step.
    step_s : float

    Returns
    -------
    (B, S) complex array
        The state a step later.
    """
    rate, contacts = dynamics.rate(state, tread_speeds_m_s)
    damping = Damping(dynamics, contacts, step_s)
    first = damping.solve(rate)
    rate, _ = dynamics.rate(state + step_s * first, tread_speeds_m_s)
    second = damping.solve(rate - 2 * first)
    return np.asarray(state + step_s / 2 * (3 * first + second))
