"""A skid-steer vehicle as contacts under a rigid body, and its TOML file."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import ComplexArray, FloatArray
from odometry.config import read_toml
from odometry.errors import SimulationError
from odometry.simulation.contact.friction import Coulomb, FrictionLaw, Shear

LARGEST = 1e6  # kg, m or kg m2 of a vehicle
SMALLEST = 1e-4  # of a friction coefficient, or a length [m] over which friction builds up


@dataclass(frozen=True, eq=False)
class ContactVehicle:
    """Rigid body on m contacts a side; SI units; origin at the centre of the contact rectangle.

    Attributes
    ----------
    robot : Mapping
        The table [robot]: name, track_width (between the middles of the treads), mass, ...
    yaw_inertia_kg_m2 : float
        About the vertical through the centre of mass.
    centre_of_mass_m : (float, float, float)
        x_cm, y_cm and its height above the ground.
    contact_x_m : (m,) array
        Where the contacts of a side are, forward of the origin: wheels, or rollers of a track.
    friction : (2, m) array
        Friction coefficient of each contact; rows left, right.
    law : FrictionLaw
    entry_m : (2, m) array
        Distance of each contact from where its tread meets the ground, driving forward (row 0)
        and backward (row 1). Half the length of a wheel's contact patch, in both; along a track
        the distance from its leading edge.
    settling_s : float
        Time constant in which the loads follow the forces (suspension).
    """

    robot: Mapping[str, Any]
    yaw_inertia_kg_m2: float
    centre_of_mass_m: tuple[float, float, float]
    contact_x_m: FloatArray
    friction: FloatArray
    law: FrictionLaw
    entry_m: FloatArray
    settling_s: float

    def __post_init__(self) -> None:
        contacts = len(self.contact_x_m)
        for name, value, low in (
            ("yaw_inertia", self.yaw_inertia_kg_m2, 0.0),
            ("settling_s", self.settling_s, 0.0),
            ("mass", self.mass_kg, 0.0),
            ("track_width", self.track_width_m, 0.0),
            ("distance from entry", np.min(self.entry_m), 0.0),
            ("height", self.centre_of_mass_m[2], -1e-9),
        ):
            if not low < value <= LARGEST:
                raise SimulationError(
                    f"{name} = {value}, expected more than {max(low, 0.0):g}, to {LARGEST:g}"
                )
        for name, array in (("friction", self.friction), ("entry_m", self.entry_m)):
            if array.shape != (2, contacts):
                raise SimulationError(
                    f"{contacts} contacts a side need {name} of shape (2, {contacts}), "
                    f"found {array.shape}"
                )
            if not ((array >= SMALLEST) & (array <= LARGEST)).all():
                raise SimulationError(
                    f"{name} = {array.tolist()}, expected {SMALLEST:g} to {LARGEST:g}"
                )
        if contacts < 2 or len(np.unique(self.contact_x_m)) < contacts:
            raise SimulationError(
                f"contacts = {self.contact_x_m.tolist()}, expected 2 or more different places"
            )

    @property
    def mass_kg(self) -> float:
        """From [robot]."""
        return float(self.robot["mass"])

    @property
    def track_width_m(self) -> float:
        """From [robot]."""
        return float(self.robot["track_width"])

    def with_friction(self, mean: float) -> "ContactVehicle":
        """The same vehicle where the contacts' friction has another mean, in the same shares."""
        return replace(self, friction=self.friction * mean / self.friction.mean())

    @property
    def places_m(self) -> ComplexArray:
        """Contacts (2 m,), those of the left side first, x + i y."""
        half = self.track_width_m / 2
        return np.concatenate([self.contact_x_m + 1j * half, self.contact_x_m - 1j * half])


def read_contact_vehicle(file: Path, changes: Mapping[str, Any] | None = None) -> ContactVehicle:
    """Read the tables [robot] and [contact] of a vehicle's TOML file.

    Parameters
    ----------
    file : Path
    changes : Mapping, optional
        Keys of [contact] to be taken instead of the file's.

    Raises
    ------
    ConfigError
        If the file is not TOML.
    SimulationError
        If a table or key is missing, unknown or not possible.
    """
    content = read_toml(Path(file))
    for name in ("robot", "contact"):
        if not isinstance(content.get(name), Mapping):
            raise SimulationError(f"{file}: the table [{name}] is missing; found: {list(content)}")
    try:
        return contact_vehicle(content["robot"], {**content["contact"], **(changes or {})})
    except KeyError as error:
        raise SimulationError(f"{file}: {error} is missing in [robot] or [contact]") from error
    except (SimulationError, TypeError, ValueError) as error:
        raise SimulationError(f"{file}: {error}") from error


def contact_vehicle(robot: Mapping[str, Any], contact: Mapping[str, Any]) -> ContactVehicle:
    """Make a vehicle of its tables.

    Parameters
    ----------
    robot : Mapping
        With track_width and mass.
    contact : Mapping
        yaw_inertia, x_cm, y_cm, height, places, settling; friction (a number) or friction_left
        and friction_right (one number for each contact); track_length (tracks) or patch_length
        (wheels); law: "coulomb", with rounding, or "shear", with modulus.
    """
    table = dict(contact)
    places = np.array(table.pop("places"), dtype=np.float64)
    if places.ndim != 1 or not len(places):
        raise SimulationError(f"places = {places.tolist()}, expected 2 or more different places")
    friction = _friction(table, len(places))
    law = _law(table, float(friction.mean()))
    vehicle = ContactVehicle(
        robot=dict(robot),
        yaw_inertia_kg_m2=float(table.pop("yaw_inertia")),
        centre_of_mass_m=(
            float(table.pop("x_cm")),
            float(table.pop("y_cm")),
            float(table.pop("height")),
        ),
        contact_x_m=places,
        friction=friction,
        law=law,
        entry_m=_entry(table, places),
        settling_s=float(table.pop("settling")),
    )
    if table:
        raise SimulationError(f"[contact]: unknown key {next(iter(table))!r}")
    return vehicle


def _friction(table: dict[str, Any], contacts: int) -> FloatArray:
    if "friction" in table:
        each = np.full((2, contacts), float(table.pop("friction")))
    else:
        each = np.array([table.pop("friction_left"), table.pop("friction_right")], np.float64)
    if not ((each >= SMALLEST) & (each <= LARGEST)).all():
        raise SimulationError(
            f"friction = {each.min()}, expected more than 0: {SMALLEST:g} to {LARGEST:g}"
        )
    return each


def _law(table: dict[str, Any], friction: float) -> FrictionLaw:
    name = table.pop("law")
    rounding, modulus = float(table.pop("rounding", 0.005)), float(table.pop("modulus", 0.005))
    if not all(SMALLEST <= one <= LARGEST for one in (rounding, modulus)):
        raise SimulationError(
            f"rounding = {rounding}, modulus = {modulus}, expected more than 0: {SMALLEST:g} to "
            f"{LARGEST:g}"
        )
    laws: dict[str, FrictionLaw] = {
        "coulomb": Coulomb(rounding),
        "shear": Shear.for_modulus(modulus, friction),
    }
    if name not in laws:
        raise SimulationError(f"law = {name!r}, expected one of {', '.join(laws)}")
    return laws[name]


def _entry(table: dict[str, Any], places: FloatArray) -> FloatArray:
    if "track_length" in table:
        half = float(table.pop("track_length")) / 2
        return np.stack([half - places, half + places])
    return np.full((2, len(places)), float(table.pop("patch_length")) / 2)
