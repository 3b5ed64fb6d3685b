"""`terrain-odometry simulate`: a run from the contact simulator, without images."""

import shlex
from difflib import get_close_matches
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from terrain.cli.options import OUTPUT

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
    from odometry.simulation.skid_experiments import (
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
    from odometry.errors import SimulationError
    from odometry.installed import shipped_data

    if name in VEHICLES:
        return shipped_data() / "vehicles" / f"{name}.toml"
    if Path(name).is_file():
        return Path(name)
    near = get_close_matches(name, VEHICLES, n=1)
    meant = f"; did you mean {near[0]}?" if near else ""
    raise SimulationError(
        f"--vehicle {name}: neither a file nor one of {', '.join(VEHICLES)}{meant}"
    )


@click.command()
@click.option(
    "--out",
    required=True,
    metavar="RUN",
    type=OUTPUT,
    help="Run folder to make: missing, empty, or made by an earlier `simulate`.",
)
@click.option(
    "--vehicle",
    default="husky_like",
    show_default=True,
    metavar="NAME|FILE",
    help=f"{', '.join(VEHICLES)}, or a TOML file with [robot] and [contact].",
)
@click.option(
    "--drive",
    type=click.Choice(
        [
            "excitation",
            "spin",
            "figure_eight",
            "tour",
            "skidpad",
            "clothoid",
            "sinusoid",
            "outward_spiral",
        ]
    ),
    default="excitation",
    show_default=True,
    help="What is driven; a tour crosses three zones of slope, a spiral turns left or right by "
    "the seed.",
)
@click.option(
    "--duration",
    type=click.FloatRange(min=1, min_open=False),
    default=160.0,
    show_default=True,
    help="Approximate duration [s].",
)
@click.option(
    "--max-speed",
    type=click.FloatRange(min=0, min_open=True),
    default=1.0,
    show_default=True,
    help="Largest tread speed [m/s].",
)
@click.option("--slope", type=float, default=0.0, show_default=True, help="Slope [degrees].")
@click.option(
    "--slope-direction",
    type=float,
    default=90.0,
    show_default=True,
    help="Direction uphill, from world x counter-clockwise [degrees]; the robot starts along x.",
)
@click.option(
    "--friction",
    type=click.FloatRange(min=0, min_open=True),
    help="Mean friction coefficient.  [default: the vehicle's]",
)
@click.option(
    "--law",
    type=click.Choice(["coulomb", "shear"]),
    help="Friction law.  [default: the vehicle's]",
)
@click.option(
    "--traction",
    multiple=True,
    metavar="NAME[@SECONDS]",
    help="A terrain (asphalt, grass, crushed_concrete) or the wheels that slip (none, all, or e.g. "
    "front_left-rear_left), from a time on; repeat. The truth names it, and run.toml where there "
    "is one.",
)
@click.option(
    "--terrain", default="ground", show_default=True, metavar="TERRAIN", help="Name of the terrain."
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    help="Seed of all randomness.",
)
def simulate(
    *,
    out: Path,
    vehicle: str,
    drive: str,
    duration: float,
    max_speed: float,
    slope: float,
    slope_direction: float,
    friction: float | None,
    law: str | None,
    traction: tuple[str, ...],
    terrain: str,
    seed: int,
) -> None:
    """Make a run folder by simulating a skid-steer robot on frictional contacts.

    Wheels or track rollers slide under a rigid body with inertia, load transfer and gravity on
    slopes. The run has noisy odometry (tread speeds, attitude, yaw rate, accelerations), poses,
    and the truth. Where it drives on slopes, `identify --model contact` finds its friction to about
    a tenth, which its intervals do not hold: that model has Coulomb friction and no lag.

    \b
    Example:
      terrain-odometry simulate --out train --seed 1
      terrain-odometry simulate --out slope --vehicle j8 --drive tour --slope 5
      terrain-odometry simulate --out change --drive sinusoid --traction grass --traction asphalt@80
    """
    import numpy as np

    from odometry.simulation.contact.drive import simulate_contact
    from odometry.simulation.courses import STEP_S, make_course
    from odometry.simulation.record import ContactSensors, write_contact_run
    from terrain.cli.outputs import claim_folder

    if traction and (friction is not None or law):
        raise click.UsageError("--traction says friction and law; leave out --friction and --law")
    output = claim_folder(out)
    robot = robot_named(vehicle, friction, law)
    streams = np.random.SeedSequence(seed).spawn(2)
    course = make_course(
        drive,
        robot,
        duration_s=duration,
        max_speed_m_s=max_speed,
        slope_rad=radians(slope),
        uphill_rad=radians(slope_direction),
        rng=np.random.default_rng(streams[0]),
    )
    pieces = [traction_named(robot, one) for one in traction]
    truth = simulate_contact(
        robot, course.tread_speeds_m_s, STEP_S, ground=course.ground, traction=pieces
    )
    names = [piece.name for piece in pieces] or [terrain]
    named = names[0] if len(names) == 1 else None
    settings: dict[str, Any] = {"drive": drive, "max_speed_m_s": max_speed, "seed": seed}
    noise = np.random.default_rng(streams[1])
    with output.writing() as part:
        write_contact_run(part, truth, ContactSensors(), noise, terrain=named, settings=settings)
    name = robot.robot.get("name", vehicle)
    click.echo(
        f"Wrote the run {out}: {truth.stamps_s[-1]:.0f} s of {name}, drive {drive}, "
        f"slope {slope:g} degrees."
    )
    click.echo(_next(out, named))


def _next(out: Path, terrain: str | None) -> str:
    """What to do with the run; it has several tractions where it has no one terrain."""
    made = shlex.quote(str(out))
    if terrain is None:
        return (
            "Next: terrain-odometry identify-modes RUN... --out modes.toml, with a run of each "
            "traction (simulate --traction NAME, once each), then\n"
            f"      terrain-odometry modes {made} --models modes.toml --out modes"
        )
    return f"Next: terrain-odometry identify {made} --model icr --out my_robot.toml"
