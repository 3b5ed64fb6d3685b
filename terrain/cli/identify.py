"""`terrain-odometry identify`: the parameters of a model from recorded runs."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import MODEL_NAMES, assignments, window_options
from terrain.cli.results import print_table

if TYPE_CHECKING:
    from odometry.identification.identification import Identified
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
    type=click.Path(dir_okay=False, path_type=Path),
    help="Parameter set to write (TOML).",
)
@window_options
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
def identify(
    folders: tuple[Path, ...],
    *,
    model: str,
    out: Path,
    windows: "WindowConfig",
    fix: tuple[str, ...],
    free: tuple[str, ...],
    terrain: str | None,
    loss: str,
    starts: int,
    seed: int,
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
    from odometry.io.files import check_writable
    from odometry.parameters import read_parameters, write_parameters
    from odometry.run import Run

    if out.suffix != ".toml":
        raise click.UsageError(f"--out {out}: expected a name that ends in .toml")
    check_writable(out.parent)
    found = identify_runs(
        [Run.read(folder) for folder in folders],
        read_parameters(model) if Path(model).suffix == ".toml" else model,
        fixed=assignments(fix),
        released=free,
        terrain=terrain,
        window_config=windows,
        solver_config=SolverConfig(loss=loss, starts=starts, seed=seed),
        show_progress=True,
    )
    for name, ground in found.grounds.items():
        _print_ground(name, ground)
    found.require_determined()
    identified = found.to_parameter_set()
    write_parameters(out, identified)
    click.echo(f"Wrote {out}")
    named = f" --terrain {terrain}" if terrain else ""
    click.echo(
        f"Next, on a run that is not among these: terrain-odometry compare RUN{named} "
        f"--model {out} --model differential_drive --out comparison"
    )
    if all(table.model in ICR_FORM_MODELS for table in identified.terrains.values()):
        click.echo(f"or:   terrain-odometry run RUN --parameters {out} --out results")


def _print_ground(name: str, ground: "Identified") -> None:
    """Print one ground: parameters, what the fit leaves, errors."""
    from odometry.effects.tables import effects_of

    fit, given = ground.fit, ground.given
    click.echo(
        f"[{name}] {len(fit.windows)} windows of {fit.windows.travel_m.mean():.2f} m; residuals "
        f"{fit.scale:.1f} times the poses' stated noise; "
        f"{fit.agreeing} of {fit.starts} starts agree"
    )
    for added in effects_of(fit.model):
        held = ", ".join(f"{key} = {value:.5g}" for key, value in added.by_name.items())
        click.echo(f"  held: {added.effect.name} ({added.effect.form}): {held}")
    rows = [("parameter", "value", "sigma", "95 % low", "high", "")]
    units = {parameter.name: parameter.unit for parameter in fit.model.parameters}
    for parameter, value in fit.values.items():
        sigma = fit.sigmas.get(parameter)
        spread = (
            ("given" if parameter in given else "assumed", "", "")
            if sigma is None
            else (f"{sigma:.3g}", f"{value - 1.96 * sigma:.5g}", f"{value + 1.96 * sigma:.5g}")
        )
        if parameter in fit.by_trial:
            spread = ("by trial", "", "")
        elif parameter in fit.open_names:
            spread = ("open", "", "")
        elif parameter in fit.at_bound:
            spread = ("at its bound", "", "")
        rows.append((parameter, f"{value:.5g}", *spread, units[parameter]))
    print_table(rows)
    assumed = [n for n in fit.values if n not in (*fit.sigmas, *fit.by_trial, *given)]
    if assumed:
        click.echo(
            f"Note: {', '.join(assumed)}: assumed from [robot] of run.toml or by rule of thumb; "
            "--fix NAME=VALUE says better",
            err=True,
        )
    if fit.agreeing == 1 < fit.starts:
        click.echo("Note: no two starts agree; the minimum may not be the least", err=True)
    for parameter in fit.at_bound:
        click.echo(f"Note: {parameter} ended at the edge of its search range", err=True)
    for parameter in fit.by_trial:
        click.echo(
            f"Note: {parameter} acts through a sign alone: a range of values fits equally well, "
            "and no interval can be stated",
            err=True,
        )
    _print_errors(ground)


def _print_errors(ground: "Identified") -> None:
    from math import degrees

    rows = [("mean error", "m per m", "deg per m")]
    for name, errors in (
        (f"held out, by {ground.held_out_by}", ground.held_out),
        ("ideal differential drive", ground.ideal),
    ):
        if errors is not None:
            rows.append(
                (
                    name,
                    f"{errors.translation_per_m.mean():.4f}",
                    f"{degrees(errors.rotation_per_m.mean()):.3f}",
                )
            )
    print_table(rows)
    if ground.held_out and (
        ground.held_out.translation_per_m.mean() >= ground.ideal.translation_per_m.mean()
        or ground.held_out.rotation_per_m.mean() >= ground.ideal.rotation_per_m.mean()
    ):
        click.echo(
            "Note: held out, it errs no less than no model at all: too little data, or an effect "
            "that this model does not have",
            err=True,
        )
