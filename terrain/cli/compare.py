"""`terrain-odometry compare`: held-out errors of several models, side by side."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.comparison_text import print_comparison
from terrain.cli.options import (
    MODEL_NAMES,
    OUTPUT,
    RunFolder,
    require_model,
    run_folders,
    window_options,
)
from terrain.cli.recordings import span_options
from terrain.cli.results import print_written

if TYPE_CHECKING:
    from odometry.comparison.result import Comparison
    from odometry.run_span import Span
    from odometry.windows.config import WindowConfig

FOLDER = RunFolder()


@click.command()
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
    "if not given); repeat. Says which of these errs least over which evaluation horizon; each "
    "costs as many fits as the comparison.",
)
@click.option("--terrain", metavar="NAME", help="Terrain of runs that name none.")
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    help="Of further starts of an identification, and of the bootstrap.",
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
    from odometry.identification.config import SolverConfig
    from odometry.report.comparison_page import write_comparison_report
    from terrain.cli.outputs import about, claim_folder
    from terrain.cli.recordings import read_runs

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
        write_comparison_report(comparison, part)
    for note in comparison.notes:
        click.echo(f"Note: {note}", err=True)
    for reason in comparison.left_out.values():
        click.echo(f"Note: left out: {reason}", err=True)
    print_comparison(comparison)
    print_written(out)
    click.echo(f"Next: open {out / 'report.html'}")


def _require_a_row(comparison: "Comparison") -> None:
    """Raise ComparisonError, with the reasons, where no model was evaluated."""
    from odometry.comparison.errors import ComparisonError

    summaries = [s for place in comparison.places for s in comparison.summaries_at(place)]
    if any(summary.windows for summary in summaries):
        return
    failed = (f"{s.model}: {reason}" for s in summaries for reason in s.reasons)
    reasons = dict.fromkeys([*comparison.left_out.values(), *failed])
    raise ComparisonError("\n  ".join(["there is nothing to compare", *reasons]))
