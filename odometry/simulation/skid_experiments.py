"""The experiments of Salvi 2024 in the contact simulator: terrains and slipping wheels that change.

Large traction changes are of the terrain, small ones of the wheels that slip. A drive has no
randomness of its own; many noisy runs can be recorded of one drive.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TypeVar

import numpy as np

from odometry.errors import SimulationError
from odometry.recording.run import Run
from odometry.simulation.contact.drive import ContactDrive, simulate_contact
from odometry.simulation.contact.friction import Shear
from odometry.simulation.contact.traction import Traction
from odometry.simulation.contact.vehicle import ContactVehicle
from odometry.simulation.courses import STEP_S, Course, make_course
from odometry.simulation.record import ContactSensors, contact_run

Mode = TypeVar("Mode")
SENSORS = ContactSensors(
    pose_rate_hz=10.0,
    sigma_position_m=0.02,
    sigma_yaw_rad=float(np.deg2rad(0.5)),
    sigma_gyro_rad_s=0.02,
)
CALIBRATION = ("skidpad", "clothoid", "sinusoid")


def terrain_experiment(
    vehicle: ContactVehicle,
    sequence: Sequence[tuple[str, float]],
    course: Course,
    rng: np.random.Generator,
    sensors: ContactSensors = SENSORS,
) -> Run:
    """A run over terrains one after another; the truth alone names them.

    Parameters
    ----------
    vehicle : ContactVehicle
    sequence : sequence of (terrain, duration_s)
        Names of GROUNDS. The last one holds to the end of the course.
    course : Course
    rng : numpy.random.Generator
        For the noise of the sensors.
    sensors : ContactSensors
    """
    pieces = [ground_traction(vehicle, name, at) for name, at in _starts(sequence)]
    return _recorded(vehicle, pieces, course, rng, sensors)


def wheel_experiment(
    vehicle: ContactVehicle,
    sequence: Sequence[tuple[Collection[str], float]],
    course: Course,
    rng: np.random.Generator,
    sensors: ContactSensors = SENSORS,
) -> Run:
    """As `terrain_experiment`, of (slipping wheels, duration_s)."""
    pieces = [wheel_traction(vehicle, wheels, at) for wheels, at in _starts(sequence)]
    return _recorded(vehicle, pieces, course, rng, sensors)


def calibration_courses(
    vehicle: ContactVehicle, max_speed_m_s: float, duration_s: float = 60.0
) -> tuple[Course, ...]:
    """Skidpad, clothoid and sinusoid on level terrain (Salvi 2024, section III)."""
    return tuple(
        make_course(
            name,
            vehicle,
            duration_s=duration_s,
            max_speed_m_s=max_speed_m_s,
            slope_rad=0.0,
            uphill_rad=0.0,
            rng=np.random.default_rng(0),  # none of the three is random
        )
        for name in CALIBRATION
    )


def drives_on(
    vehicle: ContactVehicle, modes: Sequence[Traction], course: Course
) -> tuple[ContactDrive, ...]:
    """The same course on each mode; those of one law are driven all at once."""
    kinds = [(mode.law, mode.lateral_share) for mode in modes]
    drives: dict[int, ContactDrive] = {}
    for kind in dict.fromkeys(kinds):
        rows = [row for row, own in enumerate(kinds) if own == kind]
        frictions = np.stack([modes[row].friction for row in rows])
        speeds = np.broadcast_to(
            course.tread_speeds_m_s, (len(rows), *course.tread_speeds_m_s.shape)
        )
        together = replace(modes[rows[0]], friction=frictions)
        stack = simulate_contact(vehicle, speeds, STEP_S, ground=course.ground, traction=[together])
        drives |= {
            row: replace(stack[place], traction=(modes[row],)) for place, row in enumerate(rows)
        }
    return tuple(drives[row] for row in range(len(modes)))


def calibration_runs(
    vehicle: ContactVehicle,
    modes: Sequence[Traction],
    courses: Sequence[Course],
    rng: np.random.Generator,
    sensors: ContactSensors = SENSORS,
) -> dict[str, tuple[Run, ...]]:
    """Runs of every mode on every course, by the name of the mode, which each run states."""
    by_course = [drives_on(vehicle, modes, course) for course in courses]
    return {
        mode.name: tuple(
            contact_run(f"{mode.name}_{number}", drives[row], sensors, rng, terrain=mode.name)
            for number, drives in enumerate(by_course)
        )
        for row, mode in enumerate(modes)
    }


def _starts(sequence: Sequence[tuple[Mode, float]]) -> list[tuple[Mode, float]]:
    """Each mode with the time at which it begins."""
    ends = np.cumsum([duration for _, duration in sequence]).tolist()
    return list(zip([mode for mode, _ in sequence], [0.0, *ends[:-1]], strict=True))


def _recorded(
    vehicle: ContactVehicle,
    pieces: Sequence[Traction],
    course: Course,
    rng: np.random.Generator,
    sensors: ContactSensors,
) -> Run:
    drive = simulate_contact(
        vehicle, course.tread_speeds_m_s, STEP_S, ground=course.ground, traction=pieces
    )
    return contact_run("experiment", drive, sensors, rng, terrain=None)


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
"""Friction as given; the rest is chosen by what is known of such terrains.

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
