"""`terrain-odometry feel`: which terrain a run feels like."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import OUTPUT, Positive, RunFolder
from terrain.cli.recordings import span_options
from terrain.cli.results import print_written

if TYPE_CHECKING:
    from odometry.run_span import Span

FILE = click.Path(exists=True, dir_okay=False, path_type=Path)


@click.command()
@click.argument("folder", metavar="RUN", type=RunFolder())
@click.option(
    "--model", required=True, metavar="FEEL", type=FILE, help="Model made by `identify-feel`."
)
@click.option("--out", required=True, metavar="DIR", type=OUTPUT, help="Folder for the results.")
@click.option(
    "--stretch",
    type=Positive(1e6),
    default=10.0,
    show_default=True,
    help="Over so much time evidence is put together [s].",
)
@click.option(
    "--sure",
    type=click.FloatRange(0.0, 1.0, min_open=True, max_open=True),
    default=0.6,
    show_default=True,
    help="Probability from which a terrain is named; below it is undetermined.",
)
@span_options
def feel(
    folder: Path, *, model: Path, out: Path, stretch: float, sure: float, span: "Span"
) -> None:
    """Tell which terrain the run folder RUN feels like, window by window.

    Writes feel.csv with the answers and the probability of each terrain, and one page. "unknown"
    is the answer where the run feels like none of the terrains of the model, "stationary" where
    the robot stands.

    \b
    Example:
      terrain-odometry feel my_run --model my_robot.feel --out felt
    """
    from odometry.feel.files import write_feel
    from odometry.feel.follow import FeelConfig, follow_feel
    from odometry.feel.model_file import read_feel_model
    from odometry.feel.words import sentences
    from odometry.report.feel_page import write_feel_report
    from terrain.cli.outputs import about, claim_folder
    from terrain.cli.recordings import read_run

    output = claim_folder(out)
    config = FeelConfig(stretch_s=stretch, sure=sure)
    felt = follow_feel(read_run(folder, span), read_feel_model(model), config)
    with output.writing() as part:
        write_feel(felt, part, about(output.made))
        write_feel_report(felt, part)
    for sentence in sentences(felt):
        click.echo(sentence)
    print_written(output.out)
    click.echo(f"Next: open {output.out / 'report.html'}")
