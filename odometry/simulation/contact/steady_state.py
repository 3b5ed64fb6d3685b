"""Twists at which the forces on a vehicle balance, found by letting it settle."""

import numpy as np

from odometry.arrays import BoolArray, ComplexArray, FloatArray
from odometry.simulation.contact.dynamics import (
    FOLLOWED_FORCE,
    POSITION,
    YAW,
    YAW_RATE,
    ContactDynamics,
)
from odometry.simulation.contact.friction import GRAVITY_M_S2
from odometry.simulation.contact.integrate import LONGEST_STEP_S, rosenbrock_step
from odometry.simulation.contact.slope import HeldAttitude
from odometry.simulation.contact.vehicle import ContactVehicle

BLOCK_S = 0.5
STILL = 1e-6  # largest rate of a settled state, per second: of m/s, rad/s, m, and of g times mass


def steady_state(
    vehicle: ContactVehicle,
    tread_speeds_m_s: FloatArray,
    *,
    roll_rad: FloatArray | float = 0.0,
    pitch_rad: FloatArray | float = 0.0,
    longest_s: float = 120.0,
) -> tuple[FloatArray, BoolArray]:
    """Stationary twists for constant tread speeds, all pairs at once.

    The vehicle starts from rest and drives until no state changes any more. On a slope the
    attitude is held, as if the ground turned with the vehicle.

    Parameters
    ----------
    vehicle : ContactVehicle
    tread_speeds_m_s : (B, 2) array
        Left and right.
    roll_rad, pitch_rad : (B,) arrays or numbers
        REP-103, see data/README.md.
    longest_s : float
        When to give up.

    Returns
    -------
    twists_body : (B, 3) array
        v_x, v_y of the origin [m/s], omega [rad/s].
    settled : (B,) array of bool
        False where the state still changed at the end; the twist is then the last one.
    """
    speeds = np.asarray(tread_speeds_m_s, dtype=np.float64)
    roll = np.broadcast_to(roll_rad, len(speeds))
    pitch = np.broadcast_to(pitch_rad, len(speeds))
    twists, settled = np.empty((len(speeds), 3)), np.zeros(len(speeds), dtype=bool)
    rows = np.arange(len(speeds))
    dynamics = ContactDynamics(vehicle, HeldAttitude(roll, pitch))
    state = dynamics.start(np.zeros(len(speeds), dtype=np.complex128), np.zeros(len(speeds)))
    for _ in range(int(longest_s / BLOCK_S)):
        for _ in range(int(BLOCK_S / LONGEST_STEP_S)):
            state = rosenbrock_step(dynamics, state, speeds[rows], LONGEST_STEP_S)
        velocity = dynamics.origin_velocity(state)
        twists[rows] = np.stack([velocity.real, velocity.imag, state[:, YAW_RATE].real], axis=-1)
        settled[rows] = _still(dynamics, state, speeds[rows])
        moving = ~settled[rows]
        rows, state = rows[moving], state[moving]
        if not rows.size:
            break
        dynamics = ContactDynamics(vehicle, HeldAttitude(roll[rows], pitch[rows]))
    return twists, settled


def _still(
    dynamics: ContactDynamics, state: ComplexArray, tread_speeds_m_s: FloatArray
) -> BoolArray:
    rate, _ = dynamics.rate(state, tread_speeds_m_s)
    rate[:, [POSITION, YAW]] = 0.0
    rate[:, FOLLOWED_FORCE] /= GRAVITY_M_S2 * dynamics.vehicle.mass_kg
    return np.asarray(np.abs(rate).max(axis=1) < STILL)
