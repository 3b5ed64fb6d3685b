"""`terrain-odometry feel`: which terrain runs feel like."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import OUTPUT, Positive, run_folders
from terrain.cli.recordings import span_options
from terrain.cli.results import print_table, print_written

if TYPE_CHECKING:
    from odometry.feel.follow import Felt
    from odometry.run_span import Span

FILE = click.Path(exists=True, dir_okay=False, path_type=Path)
HEADER = ("run", "answer", "probability", "unknown", "windows")


@click.command()
@run_folders
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
    folders: tuple[Path, ...],
    *,
    model: Path,
    out: Path,
    stretch: float,
    sure: float,
    span: "Span",
) -> None:
    """Recognise the terrain of the run folders RUN by what the robot feels, window by window.

    Writes feel.csv with the answers and the probability of each terrain, and one page. "unknown"
    is the answer where the run feels like none of the terrains of the model, "stationary" where
    the robot stands. Several runs get a folder each, and one table, runs.csv.

    \b
    Example:
      terrain-odometry feel my_run --model my_robot.feel --out felt
    """
    from odometry.feel.felt import FeelConfig
    from odometry.feel.files import write_feel, write_feel_runs
    from odometry.feel.follow import follow_feel
    from odometry.feel.model_file import read_feel_model
    from odometry.report.feel_page import write_feel_report
    from terrain.cli.outputs import about, claim_folder, folder_names
    from terrain.cli.recordings import read_run

    output = claim_folder(out)
    config = FeelConfig(stretch_s=stretch, sure=sure)
    read = read_feel_model(model)
    names = folder_names(folders)
    felt = [follow_feel(read_run(folder, span), read, config) for folder in folders]
    with output.writing() as part:
        for name, one in zip(names, felt, strict=True):
            place = part / name if len(felt) > 1 else part
            write_feel(one, place, about(output.made))
            write_feel_report(one, place)
        if len(felt) > 1:
            write_feel_runs(felt, names, part / "runs.csv")
    _print(felt, names)
    print_written(output.out)
    page = output.out / (names[0] if len(felt) > 1 else "") / "report.html"
    click.echo(f"Next: open {page}")


def _print(felt: "Sequence[Felt]", names: Sequence[str]) -> None:
    from odometry.feel.files import sentences

    if len(felt) == 1:
        for sentence in sentences(felt[0]):
            click.echo(sentence)
        return
    rows = []
    for name, one in zip(names, felt, strict=True):
        answer, probability, unknown = one.answer_of_run
        windows = str(int(one.windows.felt.sum()))
        rows.append((name, answer, f"{probability:.2f}", f"{unknown:.2f}", windows))
    print_table([HEADER, *rows])
