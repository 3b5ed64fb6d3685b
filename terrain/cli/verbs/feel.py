"""`terrain-odometry feel`: which terrain runs feel like."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import OUTPUT, Positive
from terrain.cli.recordings import span_options
from terrain.cli.results import print_table, print_written
from terrain.cli.run_folders import run_folders

if TYPE_CHECKING:
    from collections.abc import Mapping

    from odometry.feel.labels.felt import FeelConfig
    from odometry.feel.labels.follow import Felt
    from odometry.feel.model import FeelModel
    from odometry.outputs.output_folder import OutputFolder
    from odometry.recording.run_span import Span

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
    help="Time over which evidence is put together [s].",
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
    the robot stands. Several runs get a folder each; one that cannot be used becomes a row of
    runs.csv that says why, and the exit code is then 1.

    \b
    Example:
      terrain-odometry feel my_run --model my_robot.feel --out felt
    """
    from odometry.feel.labels.felt import FeelConfig
    from odometry.feel.model_file import read_feel_model
    from terrain.cli.outputs import claim_folder

    output = claim_folder(out)
    config = FeelConfig(stretch_s=stretch, sure=sure)
    read = read_feel_model(model)
    if len(folders) == 1:
        _one(folders[0], read, config, output, span)
    else:
        _several(folders, read, config, output, span)


def _one(
    folder: Path, model: "FeelModel", config: "FeelConfig", output: "OutputFolder", span: "Span"
) -> None:
    from odometry.feel.labels.files import sentences, write_feel
    from odometry.feel.labels.follow import follow_feel
    from odometry.report.feel_page import write_feel_report
    from terrain.cli.outputs import about
    from terrain.cli.recordings import checks_made, read_runs

    felt = follow_feel(read_runs([folder], span)[0], model, config)
    with output.writing() as part:
        write_feel(felt, part, about(output.made))
        write_feel_report(felt, part, checks_made())
    for sentence in sentences(felt):
        click.echo(sentence)
    print_written(output.out)
    click.echo(f"Next: open {output.out / 'report.html'}")


def _several(
    folders: tuple[Path, ...],
    model: "FeelModel",
    config: "FeelConfig",
    output: "OutputFolder",
    span: "Span",
) -> None:
    """A folder for each run, and runs.csv; a run that fails is a row."""
    from odometry.errors import OdometryError
    from odometry.feel.labels.files import write_feel, write_feel_runs
    from odometry.feel.labels.follow import Felt, follow_feel
    from odometry.report.feel_page import write_feel_report
    from terrain.cli.outputs import about, folder_names
    from terrain.cli.recordings import checks_made, read_runs

    rows: dict[str, Felt | str] = {}
    with output.writing() as part:
        for name, folder in zip(folder_names(folders), folders, strict=True):
            try:
                felt = follow_feel(read_runs([folder], span)[0], model, config)
            except OdometryError as error:
                rows[name] = str(error)
                click.echo(f"{name}: failed: {error}")
                continue
            write_feel(felt, part / name, about(output.made, folder))
            write_feel_report(felt, part / name, checks_made(folder))
            rows[name] = felt
        write_feel_runs(rows, model.names, part / "runs.csv")
    done = {name: row for name, row in rows.items() if isinstance(row, Felt)}
    _print(done)
    print_written(output.out)
    if done:
        click.echo(f"Next: open {output.out / next(iter(done)) / 'report.html'}")
    if len(done) < len(rows):
        sys.exit(1)


def _print(felt: "Mapping[str, Felt]") -> None:
    rows = []
    for name, one in felt.items():
        answer, probability, unknown = one.answer_of_run
        windows = str(int(one.windows.felt.sum()))
        rows.append((name, answer, f"{probability:.2f}", f"{unknown:.2f}", windows))
    print_table([HEADER, *rows])
