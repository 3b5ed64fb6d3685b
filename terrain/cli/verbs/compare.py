"""`terrain-odometry compare`: held-out errors of several models, side by side."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import MODEL_NAMES, OUTPUT, require_model, window_options
from terrain.cli.recordings import span_options
from terrain.cli.results import print_table, print_written
from terrain.cli.run_folders import RunFolder, RunsFirst, run_folders

if TYPE_CHECKING:
    from odometry.comparison.result import Comparison
    from odometry.comparison.summary import Place
    from odometry.recording.run_span import Span
    from odometry.windows.config import WindowConfig


def print_comparison(comparison: "Comparison") -> None:
    """Print errors, splits, what the errors say at each place, and training horizons."""
    _print_errors(comparison)
    _print_splits(comparison)
    for place in comparison.places:
        _print_place(comparison, place)
    _print_training_horizons(comparison)


def _print_training_horizons(comparison: "Comparison") -> None:
    """Print which training horizons suit which evaluation horizon, a line a model and quantity."""
    from odometry.comparison.summary import QUANTITIES
    from odometry.comparison.training_horizons import horizon_sentence

    for robot, terrain in comparison.robots_and_terrains:
        for model, errors in comparison.horizon_errors_of(robot, terrain).items():
            for quantity in QUANTITIES:
                said = horizon_sentence(model, errors, quantity)
                click.echo(f"{robot} on {terrain}: {said}")


def _print_errors(comparison: "Comparison") -> None:
    """Print one row a place and model."""
    from odometry.comparison.summary import NOT_IDENTIFIED

    rows: list[tuple[str, ...]] = [
        (
            *("robot", "terrain", "over", "model", "windows"),
            *("m per m: mean", "median", "degrees per m: mean", "median", ""),
        )
    ]
    for place in comparison.places:
        for summary in comparison.summaries_at(place):
            errors = (
                statistic.get(quantity)
                for quantity in ("translation", "rotation")
                for statistic in (summary.means, summary.medians)
            )
            cells = ["-" if error is None else f"{error:.4f}" for error in errors]
            remark = "see below" if comparison.remarks_at(place, summary) else ""
            if not summary.ranked:
                remark = NOT_IDENTIFIED if summary.complete else "not ranked, see below"
            over = f"{place.horizon_m:g} m"
            where = (place.robot, place.terrain, over, summary.model, str(summary.windows))
            rows.append((*where, *cells, remark))
    click.echo("Held-out errors, per metre of wheel travel:")
    print_table(rows)


def _print_splits(comparison: "Comparison") -> None:
    """Print on which runs the models were identified for which others, where any were."""
    from odometry.comparison.candidates import AS_GIVEN

    predictors = [p for each in comparison.split_models for p in each.predictors.values()]
    if not any(p.covariance_order and AS_GIVEN not in p.notes for p in predictors):
        return
    click.echo("Held out, and the runs on which the models were identified:")
    for models in comparison.split_models:
        split = models.split
        held_out = ", ".join(part.name for part in split.held_out)
        click.echo(f"  {split.robot} on {split.terrain}: {held_out}, by {split.training_names}")


def _print_place(comparison: "Comparison", place: "Place") -> None:
    """Print what the errors of one place say, and what to know of them."""
    from odometry.windows.recorded.record import words

    click.echo(f"{place.title}:")
    for sentence in comparison.sentences_at(place):
        click.echo(f"  {sentence}")
    for summary in comparison.summaries_at(place):
        for remark in comparison.remarks_at(place, summary):
            if remark not in summary.reasons:  # the sentences have them
                click.echo(f"  Note: {summary.model}: {remark}")
    left_out = comparison.windows_left_out_at(place)
    if left_out:
        click.echo(f"  Note: in these runs {words(left_out)}")


FOLDER = RunFolder()


@click.command(cls=RunsFirst)
@run_folders
@click.option(
    "--model",
    "models",
    multiple=True,
    default=("differential_drive", "icr_symmetric", "icr"),
    show_default=True,
    metavar="NAME",
    help=f"{', '.join(MODEL_NAMES)}, or a parameter set (.toml) to take as it is; repeat.",
)
@click.option("--out", required=True, metavar="DIR", type=OUTPUT, help="Folder for the results.")
@click.option(
    "--train", multiple=True, metavar="RUN", type=FOLDER, help="Identify on this run; repeat."
)
@window_options
@span_options
@click.option(
    "--evaluation-horizon",
    "horizons_m",
    multiple=True,
    type=float,
    default=(2.0,),
    show_default=True,
    metavar="H",
    help="Wheel travel over which errors are taken [m]; repeat.",
)
@click.option(
    "--training-horizon",
    "training_horizons_m",
    multiple=True,
    type=float,
    metavar="H",
    help="Identify over windows of this wheel travel [m] as well as over those of --horizon (2 m "
    "if not given); repeat. Says which of these has the smallest error over which evaluation "
    "horizon; each costs as many fits as the comparison.",
)
@click.option("--terrain", metavar="NAME", help="Terrain of runs that name none.")
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    help="Seed of the starts of identifications after the first, and of the bootstrap.",
)
def compare(
    folders: tuple[Path, ...],
    *,
    models: tuple[str, ...],
    out: Path,
    train: tuple[Path, ...],
    windows: "WindowConfig",
    horizons_m: tuple[float, ...],
    training_horizons_m: tuple[float, ...],
    terrain: str | None,
    seed: int,
    span: "Span",
) -> None:
    """Compare kinematic models on the run folders RUN, by robot and terrain.

    No window is evaluated with a model that was identified on it. With --train, models are
    identified on those runs. Else each run is held out in turn, or in ten groups where there are
    more, and models are identified on the other runs of the same robot and terrain; where a
    terrain has one run, each half of it is held out in turn.

    \b
    Example:
      terrain-odometry compare grass_1 grass_2 --model icr --model icr_symmetric --out comparison
    """
    from odometry.comparison.compare import compare as compare_models
    from odometry.comparison.config import ComparisonConfig
    from odometry.comparison.files import write_comparison
    from odometry.identification.start import SolverConfig
    from odometry.report.comparison.comparison_page import write_comparison_report
    from terrain.cli.outputs import about, claim_folder
    from terrain.cli.recordings import checks_made, read_runs

    config = ComparisonConfig(
        training=windows,
        solver=SolverConfig(seed=seed),
        horizons_m=horizons_m,
        training_horizons_m=training_horizons_m,
        seed=seed,
    )
    for model in models:
        require_model(model)
    output = claim_folder(out)
    comparison = compare_models(
        read_runs(folders, span),
        models,
        train=read_runs(train, span),
        terrain=terrain,
        config=config,
        show_progress=True,
    )
    _require_a_row(comparison)
    with output.writing() as part:
        write_comparison(comparison, part, about(output.made))
        write_comparison_report(comparison, part, checks_made())
    for note in comparison.notes:
        click.echo(f"Note: {note}", err=True)
    for reason in comparison.left_out.values():
        click.echo(f"Note: left out: {reason}", err=True)
    print_comparison(comparison)
    print_written(out)
    click.echo(f"Next: open {out / 'report.html'}")


def _require_a_row(comparison: "Comparison") -> None:
    """Raise ComparisonError, with the reasons, where no model was evaluated."""
    from odometry.errors import ComparisonError

    summaries = [s for place in comparison.places for s in comparison.summaries_at(place)]
    if any(summary.windows for summary in summaries):
        return
    failed = (f"{s.model}: {reason}" for s in summaries for reason in s.reasons)
    reasons = dict.fromkeys([*comparison.left_out.values(), *failed])
    raise ComparisonError("\n  ".join(["there is nothing to compare", *reasons]))
