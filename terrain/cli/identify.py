"""`terrain-odometry identify`: the parameters of a model from recorded runs."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import MODEL_NAMES, OUTPUT, assignments, require_model, window_options
from terrain.cli.recordings import span_options

if TYPE_CHECKING:
    from odometry.identification.identification import Identification, Identified
    from odometry.run_span import Span
    from odometry.windows.config import WindowConfig


@click.command()
@click.argument(
    "folders",
    metavar="RUN...",
    nargs=-1,
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
)
@click.option(
    "--model",
    required=True,
    metavar="NAME|SET.toml",
    help=f"One of {', '.join(MODEL_NAMES)}; or a parameter set, to identify its models anew with "
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
@window_options
@span_options
@click.option("--fix", multiple=True, metavar="NAME=VALUE", help="Hold a parameter; repeat.")
@click.option("--free", multiple=True, metavar="NAME", help="Identify a known one too; repeat.")
@click.option("--terrain", metavar="NAME", help="Ground of runs that name none.")
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
    help="Searches from different values.",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    help="Seed of the further starts.",
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
    ends nearest to the measured poses. One table is written for each ground that the runs name.
    Parameters that the runs cannot tell are named, and nothing is written then.

    \b
    Example:
      terrain-odometry identify grass_1 grass_2 asphalt_1 --model icr --out set.toml
    """
    from odometry.estimation.icr_prior import ICR_FORM_MODELS
    from odometry.identification.config import SolverConfig
    from odometry.identification.identify import identify as identify_runs
    from odometry.identification.profile import with_profiles
    from odometry.outputs.output_file import is_set_of
    from odometry.parameters import read_parameters, write_parameters
    from odometry.windows.left_out import words
    from terrain.cli.outputs import claim_file, claim_picture, comment
    from terrain.cli.recordings import read_runs

    if out.suffix != ".toml":
        raise click.UsageError(f"--out {out}: expected a name that ends in .toml")
    require_model(model)
    made = claim_file(out, is_set_of("identify"))
    solver_config = SolverConfig(loss=loss, starts=starts, seed=seed)
    if picture is not None:
        if picture.suffix != ".png":
            raise click.UsageError(f"--picture {picture}: expected a name that ends in .png")
        claim_picture(picture)
    runs = read_runs(folders, span)
    found = identify_runs(
        runs,
        read_parameters(model) if Path(model).suffix == ".toml" else model,
        fixed=assignments(fix),
        released=free,
        terrain=terrain,
        window_config=windows,
        solver_config=solver_config,
        show_progress=True,
    )
    if profile:
        found = with_profiles(found, solver_config)
    for name, ground in found.grounds.items():
        _print_terrain(name, ground)
    if found.left_out:
        click.echo(f"Note: {words(found.left_out)}", err=True)
    _require_determined(found)
    identified = found.to_parameter_set()
    write_parameters(out, identified, comment(made))
    click.echo(f"Wrote {out}")
    if picture is not None:
        from odometry.outputs.output_file import picture_source
        from odometry.report.icr_picture import save_identified_icrs

        save_identified_icrs(picture, runs, found, terrain, source=picture_source("identify"))
        click.echo(f"Wrote {picture}")
    named = f" --terrain {terrain}" if terrain else ""
    click.echo(
        f"Next, on a run that is not among these: terrain-odometry compare RUN{named} "
        f"--model {out} --model differential_drive --out comparison"
    )
    if all(table.model in ICR_FORM_MODELS for table in identified.terrains.values()):
        click.echo(f"or:   terrain-odometry run RUN --parameters {out} --out results")


def _require_determined(found: "Identification") -> None:
    """Refuse a fit that is no answer; what the check warned of is the likeliest reason."""
    from odometry.checks.finding import Level
    from odometry.identification.errors import IdentificationError
    from terrain.cli.recordings import checks_made

    try:
        found.require_determined()
    except IdentificationError as error:
        causes = [
            f"\n  {report.folder}: {warning.cause}. {warning.remedy}."
            for report in checks_made()
            for warning in report.at(Level.WARNING)
        ]
        if not causes:
            raise
        raise IdentificationError(
            f"{error}\nMend first what the check warned of:{''.join(causes)}"
        ) from error


def _print_terrain(name: str, found: "Identified") -> None:
    """Print the report of one terrain; what to doubt goes to standard error."""
    from odometry.identification.plausibility import notes
    from odometry.identification.report import report

    click.echo("\n".join(report(name, found)))
    for words in (*notes(found.fit), *_assumed(found), *_no_gain(found)):
        click.echo(f"Note: {words}", err=True)


def _assumed(found: "Identified") -> list[str]:
    fit = found.fit
    names = [n for n in fit.values if n not in (*fit.names, *fit.by_trial, *found.given)]
    if not names:
        return []
    return [
        f"{', '.join(names)}: assumed from [robot] of run.toml or by rule of thumb; "
        "--fix NAME=VALUE says better"
    ]


def _no_gain(found: "Identified") -> list[str]:
    if found.held_out is None or (
        found.held_out.translation_per_m.mean() < found.ideal.translation_per_m.mean()
        and found.held_out.rotation_per_m.mean() < found.ideal.rotation_per_m.mean()
    ):
        return []
    return [
        "held out, it errs no less than no model at all: too little data, or an effect that this "
        "model does not have"
    ]
