"""Drives of skid-steer vehicles on contacts: many at once, with the truth of every stamp."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import ComplexArray, FloatArray
from odometry.errors import SimulationError
from odometry.simulation.contact.dynamics import MEMORY, POSITION, YAW, YAW_RATE, ContactDynamics
from odometry.simulation.contact.integrate import LONGEST_STEP_S, rosenbrock_step
from odometry.simulation.contact.one_vehicle import one_vehicle
from odometry.simulation.contact.slope import Ground, Plane, gravity
from odometry.simulation.contact.traction import (
    Traction,
    checked,
    names_at,
    switch_rows,
    switched,
)
from odometry.simulation.contact.vehicle import ContactVehicle

Steps = Callable[[ComplexArray, FloatArray, float, int], ComplexArray]


@dataclass(frozen=True, eq=False)
class ContactDrive:
    """What truly happened at N stamps, of one drive or of a stack (...) of them.

    Attributes
    ----------
    vehicle : ContactVehicle
    ground : Ground
    stamps_s : (N,) array
        Time [s], from 0.
    tread_speeds_m_s : (..., N, 2) array
        Left and right, each held until the next stamp.
    poses_world : (..., N, 6) array
        x, y, z [m], roll, pitch, yaw [rad]; yaw is not wrapped.
    twists_body : (..., N, 3) array
        v_x, v_y [m/s] of the origin and omega [rad/s] about the body's z.
    accelerations_m_s2 : (..., N, 2) array
        accel_x, accel_y of an accelerometer at the origin, gravity included (data/README.md): the
        mean from the stamp before; at the first stamp that of rest.
    traction : tuple of Traction
        What was in force, one after another; empty where it was the vehicle's own all along.
    """

    vehicle: ContactVehicle
    ground: Ground
    stamps_s: FloatArray
    tread_speeds_m_s: FloatArray
    poses_world: FloatArray
    twists_body: FloatArray
    accelerations_m_s2: FloatArray
    traction: tuple[Traction, ...] = ()

    @property
    def terrains(self) -> tuple[str, ...]:
        """Name of the traction in force at each stamp; empty where none was given."""
        return names_at(self.traction, self.stamps_s) if self.traction else ()

    def __getitem__(self, index: int | tuple[int, ...]) -> "ContactDrive":
        """One drive of a stack."""
        return ContactDrive(
            self.vehicle,
            self.ground,
            self.stamps_s,
            self.tread_speeds_m_s[index],
            self.poses_world[index],
            self.twists_body[index],
            self.accelerations_m_s2[index],
            tuple(piece[index] for piece in self.traction),
        )


def simulate_contact(
    vehicle: ContactVehicle,
    tread_speeds_m_s: FloatArray,
    step_s: float,
    *,
    ground: Ground | None = None,
    traction: Sequence[Traction] = (),
    start_poses: FloatArray | tuple[float, float, float] = (0.0, 0.0, 0.0),
    longest_step_s: float = LONGEST_STEP_S,
) -> ContactDrive:
    """Drive from rest with given tread speeds.

    Parameters
    ----------
    vehicle : ContactVehicle
    tread_speeds_m_s : (..., N, 2) array
        Left and right at each stamp, held until the next. A stack (...) of drives costs little
        more than one.
    step_s : float
        Time between stamps [s].
    ground : Ground, optional
        Level when absent.
    traction : sequence of Traction, optional
        Friction and law instead of the vehicle's, one piece after another from 0 s on.
    start_poses : (..., 3) array
        x, y [m], yaw [rad] at the first stamp.
    longest_step_s : float
        Steps of the integration are at most this long; the error falls with its square.

    Raises
    ------
    SimulationError
        If the speeds or the traction are not as above, or the vehicle tips over or runs away.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> from odometry.simulation import read_contact_vehicle
    >>> husky = read_contact_vehicle(odometry.shipped_data() / "vehicles" / "husky_like.toml")
    >>> ahead_m_s = np.full((20, 2), 0.5)
    >>> drive = odometry.simulate_contact(husky, ahead_m_s, step_s=0.1)
    >>> f"{drive.twists_body[-1, 0]:.2f} m/s"
    '0.50 m/s'
    """
    speeds = np.asarray(tread_speeds_m_s, dtype=np.float64)
    if speeds.ndim < 2 or speeds.shape[-1] != 2 or not np.isfinite(speeds).all():
        raise SimulationError(
            f"tread speeds of shape {speeds.shape}, expected (..., N, 2), all of them finite"
        )
    ground = Plane() if ground is None else ground
    stack, count = speeds.shape[:-2], speeds.shape[-2]
    flat = speeds.reshape(-1, count, 2)
    starts = np.broadcast_to(start_poses, (*stack, 3)).reshape(-1, 3)
    stamps_s = np.asarray(np.arange(count) * step_s)
    pieces = checked(traction, vehicle, stack, float(stamps_s[-1]))
    switches = dict(zip(switch_rows(pieces, stamps_s).tolist(), pieces, strict=True))
    dynamics = ContactDynamics(vehicle, ground)
    state = dynamics.start(starts[:, 0] + 1j * starts[:, 1], starts[:, 2])
    advanced = _steps_of(dynamics, len(state))
    substeps = max(1, int(np.ceil(step_s / longest_step_s - 1e-9)))
    states = np.empty((count, len(state), MEMORY), dtype=np.complex128)
    for k in range(count):
        if not np.isfinite(state).all():
            raise SimulationError(
                f"the drive runs away {k * step_s:.2f} s after its start: speeds too high for the "
                "turns, or a slope steeper than its friction holds"
            )
        if k in switches:
            dynamics, state = switched(dynamics, state, switches[k])
            advanced = _steps_of(dynamics, len(state))
        states[k] = state[:, :MEMORY]
        with np.errstate(over="ignore", invalid="ignore"):
            if k < count - 1:
                state = advanced(state, flat[:, k], step_s / substeps, substeps)
    poses, twists, accelerations = _observed(dynamics, states, step_s)
    return ContactDrive(
        vehicle,
        ground,
        stamps_s,
        speeds,
        poses.reshape(*stack, count, 6),
        twists.reshape(*stack, count, 3),
        accelerations.reshape(*stack, count, 2),
        pieces,
    )


def _steps_of(dynamics: ContactDynamics, drives: int) -> Steps:
    """What takes states (B, S) so many steps further: plain numbers for one drive, else NumPy."""
    one = one_vehicle(dynamics) if drives == 1 else None
    if one is not None:
        return one.advanced

    def of_many(state: ComplexArray, speeds: FloatArray, step_s: float, steps: int) -> ComplexArray:
        for _ in range(steps):
            state = rosenbrock_step(dynamics, state, speeds, step_s)
        return state

    return of_many


def _observed(
    dynamics: ContactDynamics, states: ComplexArray, step_s: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Poses, twists and accelerations (B, N, ...) of states (N, B, S)."""
    count, drives, _ = states.shape
    rows = np.swapaxes(states, 0, 1).reshape(drives * count, -1)
    attitude = dynamics.tilt(rows)
    roll = np.arctan2(attitude.sin_roll, attitude.cos_roll)
    pitch = np.arctan2(attitude.sin_pitch, attitude.cos_pitch)
    position = rows[:, POSITION]
    z = dynamics.ground.heights_m(position)
    yaw, omega = rows[:, YAW].real, rows[:, YAW_RATE].real
    velocity = dynamics.origin_velocity(rows)
    turning = (1j * omega * velocity - gravity(attitude)[0]).reshape(drives, count)
    gained = np.diff(velocity.reshape(drives, count), axis=1) / step_s
    felt = np.empty((drives, count), dtype=np.complex128)
    felt[:, 0] = turning[:, 0]
    felt[:, 1:] = gained + (turning[:, 1:] + turning[:, :-1]) / 2
    poses = np.stack([position.real, position.imag, z, roll, pitch, yaw], axis=-1)
    twists = np.stack([velocity.real, velocity.imag, omega], axis=-1)
    return poses, twists, np.stack([felt.real, felt.imag], axis=-1)
