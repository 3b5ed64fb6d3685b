"""`terrain-odometry identify-feel`: how terrains feel, from recorded runs."""

import shlex
from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import OUTPUT, Positive
from terrain.cli.recordings import span_options
from terrain.cli.results import print_table
from terrain.cli.run_folders import run_folders

if TYPE_CHECKING:
    from odometry.feel.model import FeelModel
    from odometry.recording.run_span import Span


@click.command(name="identify-feel")
@run_folders
@click.option("--out", required=True, metavar="FEEL", type=OUTPUT, help="Model to write.")
@click.option(
    "--window",
    "windows",
    type=Positive(5.0),
    multiple=True,
    default=(2.0,),
    show_default=True,
    help="Length of the windows, 1 to 5 s; repeat: runs held out say which is best.",
)
@click.option(
    "--seed",
    type=int,
    default=0,
    show_default=True,
    help="Seed by which runs are dealt into folds.",
)
@span_options
def identify_feel(
    folders: tuple[Path, ...], *, out: Path, windows: tuple[float, ...], seed: int, span: "Span"
) -> None:
    """Identify how the terrains that the run folders RUN name feel, for `feel` to recognise them.

    Uses what all runs have of imu.csv (vibration), the yaw rate and motor currents. Each terrain
    needs two runs or more: whole runs are held out, and the printed figures are theirs.

    \b
    Example:
      terrain-odometry identify-feel grass_* asphalt_* snow_* --out my_robot.feel
    """
    from odometry.feel.identify_feel import identify_feel as identify
    from odometry.feel.model_file import is_feel_model, write_feel_model
    from terrain.cli.outputs import claim_file
    from terrain.cli.recordings import read_runs

    made = claim_file(out, is_feel_model)
    model = identify(read_runs(folders, span), window_s=windows, seed=seed)
    _print(model)
    write_feel_model(out, model, made.to_table())
    click.echo(f"Wrote {out}")
    click.echo(f"Next: terrain-odometry feel RUN --model {shlex.quote(str(out))} --out felt")


def _print(model: "FeelModel") -> None:
    from odometry.feel.assessment.calibration_words import calibration_words
    from odometry.report.feel_page import LENGTHS, figures

    report = model.report
    click.echo(
        f"Whole {report['held_out']} held out, terrains weighted equally (interval of 5 to "
        "95 % over runs drawn anew; calibration error of probabilities; share refused as unknown):"
    )
    header = ("", "answers", "right", "interval", "calibration", "refused")
    rows = [
        (word, str(report[name]["answers"]), *figures(report[name]))
        for name, word in LENGTHS.items()
    ]
    print_table([header, *rows])
    for name, word in LENGTHS.items():
        words = calibration_words(report[name])
        if words:
            click.echo(f"By {word}, {words}.")
    click.echo(f"Chosen by runs held out: {report['chosen']}")
    click.echo("Windows by answer:")
    table = report["window"]["confusion"]
    lines = [
        (name, *(str(line.get(answer, 0)) for answer in model.names))
        for name, line in table.items()
    ]
    print_table([("true terrain", *model.names), *lines])
    click.echo("What each group of features brings (windows):")
    groups = report["window_by_groups"]
    print_table(
        [("features", "balanced accuracy"), *((name, f"{of:.3f}") for name, of in groups.items())]
    )
    for note in report["notes"]:
        click.echo(f"Note: {note}", err=True)
    click.echo(f"Columns that `feel` needs: {', '.join(model.design.columns)}")
