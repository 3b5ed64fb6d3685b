"""`terrain-odometry run`: the main job, and its options, which `batch` shares."""

import sys
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from terrain.cli.options import OUTPUT
from terrain.cli.recordings import span_options
from terrain.cli.run_folders import RunFolder

if TYPE_CHECKING:
    from odometry.recording.run_span import Span
    from terrain.run_options import RunOptions

SOURCES = ("camera", "labels", "modes", "feel", "none")
PRESETS = ("chen2023",)
FILE = click.Path(exists=True, dir_okay=False, path_type=Path)


def run_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add the options of a replay; the command gets them as `options`, a `RunOptions`."""

    @click.option("--model", type=FILE, help="Classifier made by `train`; without it, no vision.")
    @click.option("--parameters", type=FILE, help="Parameter set: ICRs by terrain (TOML).")
    @click.option("--no-vision", is_flag=True, help="Keep one terrain in force throughout.")
    @click.option(
        "--source",
        type=click.Choice(SOURCES),
        help="Source of the terrain: the images (needs --model), the run's own column `terrain`, "
        "the motion (needs --modes), what the robot feels (needs --feel), or nothing.  [default: "
        "camera with --model, else feel with --feel, else none]",
    )
    @click.option(
        "--modes", metavar="SET.toml", type=FILE, help="Set of modes made by `identify-modes`."
    )
    @click.option(
        "--feel",
        metavar="FEEL",
        type=FILE,
        help="Model made by `identify-feel`: a source of its own, or one more beside the camera.",
    )
    @click.option(
        "--preset",
        type=click.Choice(PRESETS),
        help="A published system as printed; an option that contradicts it is an error.",
    )
    @click.option(
        "--terrain",
        metavar="NAME",
        help="Terrain in force until the first switch.  [default: that of run.toml, else unknown]",
    )
    @click.option("--config", type=FILE, help="Settings (TOML): [filter] [region] [switch] ...")
    @click.option(
        "--per-tread", is_flag=True, help="Classify the terrain under each tread by itself."
    )
    @click.option(
        "--own-statistics",
        is_flag=True,
        help="Standardise features by the images of the run as they arrive: for a camera unlike "
        "that of training which sees several terrains.",
    )
    @click.option(
        "--same-camera",
        is_flag=True,
        help="The camera is that of training: keep names that are doubted only because the model "
        "would not notice another one.",
    )
    @span_options
    @click.option(
        "--detect-jumps", is_flag=True, help="Watch the innovations for jumps of the ICRs."
    )
    @wraps(command)
    def with_options(
        *,
        model: Path | None,
        parameters: Path | None,
        no_vision: bool,
        source: str | None,
        modes: Path | None,
        feel: Path | None,
        preset: str | None,
        terrain: str | None,
        config: Path | None,
        per_tread: bool,
        own_statistics: bool,
        same_camera: bool,
        detect_jumps: bool,
        span: "Span",
        **others: Any,
    ) -> None:
        from dataclasses import replace

        say_that_it_begins()
        from terrain.config import Config
        from terrain.run_options import RunOptions
        from terrain.run_presets import run_preset

        settings = run_preset(preset).config if preset else Config()
        if config:
            settings = Config.read(config, settings)
        if per_tread:
            settings = replace(settings, region=replace(settings.region, per_tread=True))
        if own_statistics:
            settings = replace(
                settings, classifier=replace(settings.classifier, own_statistics=True)
            )
        if same_camera:
            settings = replace(settings, classifier=replace(settings.classifier, same_camera=True))
        if detect_jumps:
            settings = replace(settings, filter=replace(settings.filter, detect_jumps=True))
        options = RunOptions(
            settings,
            model=model,
            parameters=parameters,
            modes=modes,
            feel=feel,
            vision=not no_vision,
            terrain=terrain,
            source=source,
            preset=preset,
            span=span,
        )
        command(options=options, **others)

    return with_options


def say_that_it_begins() -> None:
    """On a terminal, before the libraries are loaded: that alone takes seconds."""
    if sys.stderr.isatty():
        click.echo("Loading libraries, reading the run ...", err=True)


@click.command()
@click.argument("run_folder", metavar="RUN", type=RunFolder())
@click.option("--out", required=True, metavar="DIR", type=OUTPUT, help="Folder for the results.")
@run_options
def run(run_folder: Path, *, out: Path, options: "RunOptions") -> None:
    """Replay the run folder RUN and write terrain-aware odometry.

    Reads images, tread speeds and poses in time order, classifies the terrain ahead, switches the
    ICRs when the robot gets there, and writes trajectories, ICRs, terrain, figures and one page.
    With --source the terrain comes from elsewhere: `labels` shows what true labels would give.
    Images that the check finds to be of another drive, in another order or upside down are left
    out, as with --no-vision, and so are parts of images that show the robot itself.

    \b
    Example:
      terrain-odometry run my_run --model terrain.model --parameters set.toml --out results
    """
    from terrain.cli.outputs import claim_folder
    from terrain.cli.recordings import checks_made, read_run
    from terrain.cli.results import (
        learned_advice,
        print_changes,
        print_errors,
        print_image_labels,
        print_written,
    )
    from terrain.result.new_terrain import contradiction_lines
    from terrain.result.result_table import image_label_counts
    from terrain.result.run_notes import event_lines, run_notes
    from terrain.results import write_run

    output = claim_folder(out, reads_images=options.reads_images)
    recording = read_run(run_folder, options.span, images=options.reads_images)
    recording, options, left_out = options.believed(recording, checks_made()[-1])
    if left_out:
        click.echo(f"Warning: {run_folder}: {left_out}", err=True)
    result = options.replay(recording, show_progress=True)
    if options.wants_images and result.watcher is None and recording.images is not None:
        click.echo("Note: the run has images, but there is no vision without --model", err=True)
    for note in [*run_notes(result), *event_lines(result)]:
        click.echo(f"Note: {note}", err=True)
    write_run(result, output, checks_made())
    print_errors({result.run.name: result})
    print_image_labels(image_label_counts(result))
    print_changes(result)
    for line in contradiction_lines(result):
        click.echo(line)
    for name, effects in result.effects.items():
        click.echo(f"Effects on {name}, in every trajectory but the ideal: {', '.join(effects)}")
    print_written(out)
    click.echo(f"Next: open {out / 'report.html'}")
    odd = any(report.misleads for report in checks_made())
    advice = learned_advice(result, run_folder, out, has_warnings=odd, preset=options.preset)
    if advice:
        click.echo(advice)
