"""Friction that changes during a drive: another terrain, or wheels that begin to slip."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import ComplexArray, FloatArray, IntArray
from odometry.errors import SimulationError
from odometry.simulation.contact.dynamics import MEMORY, ContactDynamics
from odometry.simulation.contact.friction import FrictionLaw
from odometry.simulation.contact.vehicle import ContactVehicle


@dataclass(frozen=True, eq=False)
class Traction:
    """Friction under all contacts from a time on, until the next.

    Attributes
    ----------
    name : str
        What the truth calls it: a terrain, or which wheels slip.
    from_s : float
        It holds from the first stamp at or after this time [s].
    friction : (..., 2, m) array
        Coefficient of each contact, rows left and right; leading axes as those of the drives.
    law : FrictionLaw
    lateral_share : float
        Traction across the tread's direction against that along it, by the same slip. At low
        speed on level terrain neither the coefficient nor the law moves the ICRs of wide turns,
        but this does: in the middle of four equal wheels (track B, wheelbase L) the effective
        width is B (1 + share (L / B)^2).
    """

    name: str
    from_s: float
    friction: FloatArray
    law: FrictionLaw
    lateral_share: float = 1.0

    def spread(self, stack: tuple[int, ...]) -> "Traction":
        """The same with one friction for each drive of a stack."""
        return replace(self, friction=np.broadcast_to(self.friction, (*stack, 2, self.contacts)))

    def __getitem__(self, index: int | tuple[int, ...]) -> "Traction":
        """That of one drive of a stack."""
        return replace(self, friction=self.friction[index])

    @property
    def contacts(self) -> int:
        """Contacts of a side."""
        return int(self.friction.shape[-1])


def switch_rows(traction: Sequence[Traction], stamps_s: FloatArray) -> IntArray:
    """Stamp from which each piece holds."""
    return np.searchsorted(stamps_s, [piece.from_s - 1e-9 for piece in traction])


def names_at(traction: Sequence[Traction], stamps_s: FloatArray) -> tuple[str, ...]:
    """Name of the piece in force at each stamp (N,)."""
    from_s = [piece.from_s - 1e-9 for piece in traction]
    rows = np.searchsorted(from_s, stamps_s, side="right") - 1
    return tuple(traction[row].name for row in rows)


def checked(
    traction: Sequence[Traction], vehicle: ContactVehicle, stack: tuple[int, ...], end_s: float
) -> tuple[Traction, ...]:
    """The pieces with one friction for each drive of a stack.

    Raises
    ------
    SimulationError
        If they do not begin at 0 and follow each other before the end, or do not fit the vehicle
        or the stack.
    """
    times = [piece.from_s for piece in traction]
    if times and (times[0] != 0 or np.min(np.diff(times), initial=1.0) <= 0 or times[-1] > end_s):
        raise SimulationError(
            f"traction from {times} s, expected times that begin at 0 and increase up to "
            f"{end_s:g} s, the end of the drive"
        )
    for piece in traction:
        _check_friction(piece, vehicle, stack)
    return tuple(piece.spread(stack) for piece in traction)


def _check_friction(piece: Traction, vehicle: ContactVehicle, stack: tuple[int, ...]) -> None:
    shape = (*stack, *vehicle.friction.shape)
    try:
        fits = np.broadcast_shapes(piece.friction.shape, shape) == shape
    except ValueError:
        fits = False
    if not fits or piece.friction.shape[-2:] != shape[-2:]:
        raise SimulationError(
            f"traction {piece.name!r}: friction of shape {piece.friction.shape}, expected {shape} "
            "or less of its leading axes"
        )
    if not (piece.friction > 0).all():
        raise SimulationError(
            f"traction {piece.name!r}: friction {piece.friction.min():g}, expected more than 0"
        )
    if not piece.lateral_share > 0:
        raise SimulationError(
            f"traction {piece.name!r}: lateral_share {piece.lateral_share:g}, expected more than 0"
        )


def switched(
    dynamics: ContactDynamics, state: ComplexArray, piece: Traction
) -> tuple[ContactDynamics, ComplexArray]:
    """The vehicle on other traction, with its state.

    Velocities do not jump. The shear displacement of the treads is kept where both laws have one:
    the tread was sheared by then, and only what its shear carries is new; the traction jumps with
    it. A law with a memory after one without begins with treads that are not sheared, as at rest.
    """
    friction = piece.friction.reshape(len(state), -1)
    after = dynamics.on(friction, piece.law, piece.lateral_share)
    memory = piece.law.states_per_contact * len(after.arms_m)
    if memory == state.shape[1] - MEMORY:
        return after, state
    fresh = np.zeros((len(state), MEMORY + memory), dtype=np.complex128)
    fresh[:, :MEMORY] = state[:, :MEMORY]
    return after, fresh
