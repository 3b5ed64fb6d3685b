"""The robot and the tractions of `simulate`, by the names of its options."""

from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from odometry.simulation.contact.traction import Traction
    from odometry.simulation.contact.vehicle import ContactVehicle

# Those of data/vehicles that have places of contact.
VEHICLES = ("auriga_alpha", "husky_like", "j8", "lazaro", "warthog_like")


def robot_named(vehicle: str, friction: float | None, law: str | None) -> "ContactVehicle":
    """The vehicle, with another mean friction and law where they are given."""
    from odometry.simulation.contact.vehicle import read_contact_vehicle

    robot = read_contact_vehicle(_vehicle_file(vehicle), {"law": law} if law else {})
    return robot if friction is None else robot.with_friction(friction)


def traction_named(robot: "ContactVehicle", text: str) -> "Traction":
    """The terrain or the slipping wheels of NAME[@SECONDS]."""
    from odometry.simulation.skid_traction import (
        GROUNDS,
        WHEEL_MODES,
        ground_traction,
        wheel_mode_name,
        wheel_traction,
    )

    name, _, start = text.partition("@")
    try:
        from_s = float(start or 0.0)
    except ValueError:
        raise click.UsageError(f"--traction {text}: {start!r} is no number of seconds") from None
    if name in GROUNDS:
        return ground_traction(robot, name, from_s)
    wheels = {wheel_mode_name(mode): mode for mode in WHEEL_MODES}
    if name not in wheels:
        raise click.UsageError(
            f"--traction {text}: expected one of {', '.join((*GROUNDS, *wheels))}"
        )
    return wheel_traction(robot, wheels[name], from_s)


def _vehicle_file(name: str) -> Path:
    """The shipped file of that name, else `name` itself as a path."""
    from odometry.shipped import shipped_data
    from odometry.simulation.errors import SimulationError

    if name in VEHICLES:
        return shipped_data() / "vehicles" / f"{name}.toml"
    if Path(name).is_file():
        return Path(name)
    near = get_close_matches(name, VEHICLES, n=1)
    meant = f"; did you mean {near[0]}?" if near else ""
    raise SimulationError(
        f"--vehicle {name}: neither a file nor one of {', '.join(VEHICLES)}{meant}"
    )
