"""`terrain-odometry identify`: the parameters of a model from recorded runs."""

import shlex
from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import MODEL_NAMES, OUTPUT, assignments, require_model, window_options
from terrain.cli.recordings import span_options
from terrain.cli.run_folders import run_folders
from terrain.cli.texts.identification_outputs import (
    claimed,
    draw,
    print_identification,
    require_determined,
    require_icr_form,
    warned,
    write_ros,
)

if TYPE_CHECKING:
    from odometry.parameters import ParameterSet
    from odometry.recording.run_span import Span
    from odometry.windows.config import WindowConfig


@click.command()
@run_folders
@click.option(
    "--model",
    required=True,
    metavar="NAME|SET.toml",
    help=f"One of {', '.join(MODEL_NAMES)}; or a parameter set, to identify its models again with "
    "its effects held.",
)
@click.option(
    "--out",
    required=True,
    metavar="SET.toml",
    type=OUTPUT,
    help="Parameter set to write (TOML).",
)
@click.option(
    "--picture",
    metavar="FILE.png",
    type=OUTPUT,
    help="Draw the ICRs of every turn over the robot, beside those of the model.",
)
@click.option(
    "--ros",
    metavar="FILE.yaml",
    type=OUTPUT,
    help="Write the same for ROS 2: diff_drive_controller, robot_localization, slip by terrain.",
)
@window_options
@span_options
@click.option(
    "--fix", multiple=True, metavar="NAME=VALUE", help="Hold a parameter at a value; repeat."
)
@click.option(
    "--free", multiple=True, metavar="NAME", help="Identify a parameter that is known, too; repeat."
)
@click.option("--terrain", metavar="NAME", help="Terrain of runs that name none.")
@click.option(
    "--loss",
    type=click.Choice(["huber", "squares", "linear"]),
    default="huber",
    show_default=True,
    help="huber weighs outliers down; squares takes all windows in full; linear is Baril 2020 "
    "eq. 13 with the identity covariance, metres as radians.",
)
@click.option(
    "--starts",
    type=click.IntRange(min=1),
    default=4,
    show_default=True,
    help="How many searches, each from other values.",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    help="Seed of the starts after the first.",
)
@click.option(
    "--profile",
    is_flag=True,
    help="Intervals from the profile of the loss, which need not be symmetric: some twenty fits "
    "for each parameter.",
)
def identify(
    folders: tuple[Path, ...],
    *,
    model: str,
    out: Path,
    picture: Path | None,
    ros: Path | None,
    windows: "WindowConfig",
    fix: tuple[str, ...],
    free: tuple[str, ...],
    terrain: str | None,
    loss: str,
    starts: int,
    seed: int,
    profile: bool,
    span: "Span",
) -> None:
    """Identify the parameters of a kinematic model from the run folders RUN.

    Runs are cut into windows of equal wheel travel; the parameters are those whose dead reckoning
    ends nearest to the measured poses. Of positions without yaw (GNSS) the shapes of longer
    stretches count. One table is written for each terrain that the runs name.
    Parameters that the runs do not determine are named, and nothing is written then.

    \b
    Example:
      terrain-odometry identify grass_1 grass_2 asphalt_1 --model icr --out set.toml
    """
    from odometry.identification.identify import identify as identify_runs
    from odometry.identification.profile import with_profiles
    from odometry.identification.start import SolverConfig
    from odometry.parameters import read_parameters, write_parameters
    from odometry.set_of_robot import other_width
    from terrain.cli.outputs import WHOLE, comment
    from terrain.cli.recordings import read_runs

    require_model(model)
    if ros is not None:
        require_icr_form(model)
    made = claimed(out, picture, ros)
    solver_config = SolverConfig(loss=loss, starts=starts, seed=seed)
    runs = read_runs(folders, span)
    taken = read_parameters(model) if Path(model).suffix == ".toml" else model
    if not isinstance(taken, str) and (other := other_width(taken, runs[0].robot)):
        click.echo(f"Note: {other}; what the set states of its robot is held", err=True)
    found = identify_runs(
        runs,
        taken,
        fixed=assignments(fix),
        released=free,
        terrain=terrain,
        window_config=windows,
        solver_config=solver_config,
        show_progress=True,
    )
    require_determined(found)
    if profile:
        found = with_profiles(found, solver_config)
    print_identification(found)
    identified, not_recommended = warned(found)
    write_parameters(out, identified, comment(made))
    WHOLE.append(out)
    click.echo(f"Wrote {out}")
    if picture is not None:
        draw(picture, runs, found, terrain)
    if ros is not None:
        write_ros(ros, runs, found, comment(made))
    click.echo(not_recommended or _next(identified, out, terrain))


def _next(identified: "ParameterSet", out: Path, terrain: str | None) -> str:
    """What to do with the parameter set."""
    from odometry.estimation.terrain_beliefs import ICR_FORM_MODELS

    named = f" --terrain {shlex.quote(terrain)}" if terrain else ""
    made = shlex.quote(str(out))
    said = (
        f"Next, on a run that is not among these: terrain-odometry compare RUN{named} "
        f"--model {made} --model differential_drive --out comparison"
    )
    if all(table.model in ICR_FORM_MODELS for table in identified.terrains.values()):
        said += f"\nor:   terrain-odometry run RUN{named} --parameters {made} --out results"
    return said
