"""Traction of Salvi 2024: three terrains, and the 16 combinations of four slipping wheels."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from odometry.simulation.contact.friction import Shear
from odometry.simulation.contact.traction import Traction
from odometry.simulation.contact.vehicle import ContactVehicle
from odometry.simulation.errors import SimulationError


@dataclass(frozen=True)
class SkidGround:
    """Friction, shear deformation modulus [m], and share of the traction sideways."""

    friction: float
    modulus_m: float
    lateral_share: float


GROUNDS: Mapping[str, SkidGround] = {
    "asphalt": SkidGround(0.8, 0.001, 1.0),
    "grass": SkidGround(0.55, 0.006, 0.85),
    "crushed_concrete": SkidGround(0.35, 0.015, 0.6),
}
"""Friction as asked for; the rest is chosen by what is known of such terrains.

Moduli: under rubber on hard floors a millimetre and less (Yu, Chuy, Collins and Hollis 2010), 6 mm
in clay at its maximum compaction, 10 mm in firm and 25 mm in loose sand (Wong, Theory of Ground
Vehicles). Shares: four equal wheels placed as a Husky's have 1.87 tracks of effective width at a
share of 1, which is the 1.875 shipped with it, and 1.52 at 0.6, near the 1.525 that a user measured
(husky/husky issue 193); Baril 2020, Table I, finds 0.69 of the width of concrete on snow. Grass
lies between by assumption.
"""

WHEELS = ("front_left", "front_right", "rear_left", "rear_right")
WHEEL_MODES = tuple(
    frozenset(chosen) for count in range(5) for chosen in combinations(WHEELS, count)
)
GRIP, SLIPPERY = 0.6, 0.3  # friction of a bare wheel and of a covered one


def wheel_mode_name(slipping: Collection[str]) -> str:
    """`none`, `all`, or the slipping wheels in the order of WHEELS joined by `-`."""
    unknown = set(slipping) - set(WHEELS)
    if unknown:
        raise SimulationError(f"no wheel {min(unknown)!r}; there are {', '.join(WHEELS)}")
    if not slipping:
        return "none"
    if len(slipping) == len(WHEELS):
        return "all"
    return "-".join(wheel for wheel in WHEELS if wheel in slipping)


def wheel_traction(
    vehicle: ContactVehicle, slipping: Collection[str], from_s: float = 0.0
) -> Traction:
    """SLIPPERY under the wheels that slip, GRIP under the others; the vehicle's own law.

    Wheels in front are the contacts forward of the origin.
    """
    name = wheel_mode_name(slipping)
    ends = np.where(vehicle.contact_x_m > 0, "front", "rear")
    friction = [
        [SLIPPERY if f"{end}_{side}" in slipping else GRIP for end in ends]
        for side in ("left", "right")
    ]
    return Traction(name, from_s, np.array(friction), vehicle.law)


def ground_traction(vehicle: ContactVehicle, terrain: str, from_s: float = 0.0) -> Traction:
    """One of GROUNDS under all contacts."""
    if terrain not in GROUNDS:
        raise SimulationError(f"no terrain {terrain!r}; there are {', '.join(GROUNDS)}")
    ground = GROUNDS[terrain]
    friction = np.full(vehicle.friction.shape, ground.friction)
    law = Shear.for_modulus(ground.modulus_m, ground.friction)
    return Traction(terrain, from_s, friction, law, ground.lateral_share)
