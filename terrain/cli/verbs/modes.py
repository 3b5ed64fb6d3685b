"""`terrain-odometry modes`: which terrain, or which slipping wheels, the motion supports."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import OUTPUT
from terrain.cli.recordings import span_options
from terrain.cli.results import print_written
from terrain.cli.run_folders import RunFolder

if TYPE_CHECKING:
    from odometry.feel.model import FeelModel
    from odometry.modes.follow.followed import Followed
    from odometry.modes.follow.track import ModesConfig
    from odometry.modes.models.mode_set import ModeSet
    from odometry.outputs.output_folder import OutputFolder
    from odometry.recording.run_span import Span

FILE = click.Path(exists=True, dir_okay=False, path_type=Path)
FOLDER = RunFolder()


@click.command()
@click.argument("folders", metavar="RUN...", nargs=-1, required=True, type=FOLDER)
@click.option(
    "--models",
    required=True,
    metavar="SET.toml",
    type=FILE,
    help="Set of modes made by `identify-modes`.",
)
@click.option("--out", required=True, metavar="DIR", type=OUTPUT, help="Folder for the results.")
@click.option(
    "--seen",
    metavar="TERRAIN.csv",
    type=FILE,
    help="Labels of vision for the one RUN: terrain.csv of `run`.",
)
@click.option(
    "--feel",
    metavar="MODEL",
    type=FILE,
    help="Model of `identify-feel`: what the robot feels is used beside its motion.",
)
@click.option(
    "--sure",
    type=click.FloatRange(0.5, 1.0, min_open=True, max_open=True),
    default=0.9,
    show_default=True,
    help="Probability from which a mode is named; below it is undetermined.",
)
@span_options
def modes(
    folders: tuple[Path, ...],
    *,
    models: Path,
    out: Path,
    seen: Path | None,
    feel: Path | None,
    sure: float,
    span: "Span",
) -> None:
    """Recognise the robot's mode in the run folders RUN, by motion alone.

    Writes the probability of each mode over time, the answers, and how soon and how often they
    were right where the run says what is true. "none of these" is the answer where no mode fits,
    with the signal that contradicts it. With --seen, the labels of vision are used too, and long
    disagreements of vision and motion are reported; with --feel, what the robot feels is used, too.
    Several runs get a folder each; one that cannot be used becomes a row of runs.csv that says why,
    and the exit code is then 1.

    \b
    Example:
      terrain-odometry modes my_run --models set.toml --out modes
      terrain-odometry modes my_run --models set.toml --seen results/terrain.csv --out modes
      terrain-odometry modes my_run --models set.toml --feel my_robot.feel --out modes
    """
    from odometry.feel.model_file import read_feel_model
    from odometry.modes.follow.track import ModesConfig
    from odometry.modes.models.mode_set_file import read_mode_set
    from terrain.cli.outputs import claim_folder

    if seen is not None and len(folders) > 1:
        raise click.UsageError(f"--seen is of one run; there are {len(folders)}")
    output = claim_folder(out)
    mode_set, config = read_mode_set(models), ModesConfig(sure=sure)
    of_feel = None if feel is None else read_feel_model(feel)
    if len(folders) == 1:
        _one(folders[0], mode_set, config, output, seen=seen, feel=of_feel, span=span)
    else:
        _several(folders, mode_set, config, output, feel=of_feel, span=span)


def _one(
    folder: Path,
    mode_set: "ModeSet",
    config: "ModesConfig",
    output: "OutputFolder",
    *,
    seen: Path | None,
    feel: "FeelModel | None",
    span: "Span",
) -> None:
    from odometry.modes.show.files import write_modes
    from odometry.modes.show.words import in_short, sentences
    from odometry.report.modes.modes_page import write_modes_report
    from terrain.cli.outputs import about
    from terrain.cli.recordings import checks_made

    result = _followed(folder, mode_set, config, seen=seen, feel=feel, span=span)
    with output.writing() as part:
        write_modes(result, part, about(output.made))
        write_modes_report(result, part, checks_made())
    for title, said in zip(("Answer", "How sure", "What to do"), in_short(result), strict=True):
        click.echo(f"{title}: {said}")
    detected, *others = sentences(result)
    for sentence in [detected, *others] if result.score(result.motion).detections else others:
        click.echo(sentence)  # without stretches to detect it has the shares of the answer again
    print_written(output.out)
    click.echo(f"Next: open {output.out / 'report.html'}")


def _several(
    folders: tuple[Path, ...],
    mode_set: "ModeSet",
    config: "ModesConfig",
    output: "OutputFolder",
    *,
    feel: "FeelModel | None",
    span: "Span",
) -> None:
    """A folder for each run, and runs.csv; a run that fails is a row."""
    from odometry.errors import OdometryError
    from odometry.modes.show.files import write_modes, write_runs
    from odometry.modes.show.words import in_short, sentences
    from odometry.report.modes.modes_page import write_modes_report
    from terrain.cli.outputs import about, folder_names
    from terrain.cli.recordings import checks_made

    rows: dict[str, Followed | str] = {}
    out = output.out
    with output.writing() as part:
        for name, folder in zip(folder_names(folders), folders, strict=True):
            try:
                result = _followed(folder, mode_set, config, seen=None, feel=feel, span=span)
            except OdometryError as error:
                rows[name] = str(error)
                click.echo(f"{name}: failed: {error}")
                continue
            write_modes(result, part / name, about(output.made, folder))
            write_modes_report(result, part / name, checks_made(folder))
            rows[name] = result
            click.echo(f"{name}: {sentences(result)[0]}")
            click.echo(f"  how sure: {in_short(result)[1]}")
        write_runs(rows, part / "runs.csv")
    done = [name for name, row in rows.items() if not isinstance(row, str)]
    click.echo(f"Wrote to {out}: runs.csv, and a folder of each run that was followed")
    if done:
        click.echo(f"Next: open {out / done[0] / 'report.html'}")
    if len(done) < len(rows):
        sys.exit(1)


def _followed(
    folder: Path,
    mode_set: "ModeSet",
    config: "ModesConfig",
    *,
    seen: Path | None,
    feel: "FeelModel | None",
    span: "Span",
) -> "Followed":
    from odometry.modes.follow.camera_prior import seen_terrains
    from odometry.modes.follow.followed import followed
    from odometry.modes.models.velocity import VelocityModes
    from terrain.cli.recordings import read_runs, with_turns, with_yaw_rates

    usable = with_yaw_rates if isinstance(mode_set.modes, VelocityModes) else with_turns
    (run,) = usable(read_runs([folder], span))
    terrains = () if seen is None else seen_terrains(seen, run)
    if seen is not None and not terrains:
        click.echo(
            f"Note: {seen}: vision named no terrain that {folder} gets to; the modes are "
            "recognised by motion alone",
            err=True,
        )
    return followed(run, mode_set, config, terrains, feel=feel, show_progress=True)
