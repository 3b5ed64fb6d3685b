"""`terrain-odometry run`: the main job."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import OUTPUT, RunFolder
from terrain.cli.recordings import span_options

if TYPE_CHECKING:
    from odometry.run_span import Span

SOURCES = ("camera", "labels", "modes", "none")
PRESETS = ("chen2023",)
FILE = click.Path(exists=True, dir_okay=False, path_type=Path)
FOLDER = RunFolder()


@click.command()
@click.argument("run_folder", metavar="RUN", type=FOLDER)
@click.option("--out", required=True, metavar="DIR", type=OUTPUT, help="Folder for the results.")
@click.option("--model", type=FILE, help="Classifier made by `train`; without it, no vision.")
@click.option("--parameters", type=FILE, help="Parameter set: ICRs by terrain (TOML).")
@click.option("--no-vision", is_flag=True, help="Keep one terrain in force throughout.")
@click.option(
    "--source",
    type=click.Choice(SOURCES),
    help="What tells the terrain: the images (needs --model), the run's own column `terrain`, the "
    "motion (needs --modes), or nothing.  [default: camera with --model, else none]",
)
@click.option(
    "--modes", metavar="SET.toml", type=FILE, help="Set of modes made by `identify-modes`."
)
@click.option(
    "--preset",
    type=click.Choice(PRESETS),
    help="A published system whole; what contradicts it is an error.",
)
@click.option("--terrain", metavar="NAME", help="In force until the first switch.")
@click.option("--config", type=FILE, help="Settings (TOML): [filter] [region] [switch] ...")
@click.option("--per-tread", is_flag=True, help="Classify the terrain under each tread apart.")
@span_options
@click.option("--detect-jumps", is_flag=True, help="Watch the innovations for jumps of the ICRs.")
def run(
    run_folder: Path,
    *,
    out: Path,
    model: Path | None,
    parameters: Path | None,
    no_vision: bool,
    source: str | None,
    modes: Path | None,
    preset: str | None,
    terrain: str | None,
    config: Path | None,
    per_tread: bool,
    detect_jumps: bool,
    span: "Span",
) -> None:
    """Replay the run folder RUN and write terrain-aware odometry.

    Reads images, tread speeds and poses in time order, classifies the terrain ahead, switches the
    ICRs when the robot gets there, and writes trajectories, ICRs, terrain, figures and one page.
    With --source the terrain comes from elsewhere: `labels` shows what true labels would give.

    \b
    Example:
      terrain-odometry run my_run --model terrain.model --parameters set.toml --out results
    """
    from dataclasses import replace

    from terrain.cli.hints import hints
    from terrain.cli.learned_advice import learned_advice
    from terrain.cli.outputs import about, claim_folder
    from terrain.cli.recordings import checks_made, read_run
    from terrain.cli.results import print_changes, print_errors, print_sightings, print_written
    from terrain.config import Config
    from terrain.main_job import run_odometry
    from terrain.report.page import write_report
    from terrain.result_table import sighting_counts
    from terrain.results import write_results
    from terrain.run_presets import run_preset
    from terrain.sources import source_name

    settings = run_preset(preset).config if preset else Config()
    if config:
        settings = Config.read(config, settings)
    if per_tread:
        settings = replace(settings, region=replace(settings.region, per_tread=True))
    if detect_jumps:
        settings = replace(settings, filter=replace(settings.filter, detect_jumps=True))
    told_by = source_name(source, vision=not no_vision, has_model=model is not None)
    reads_images = told_by == "camera"
    output = claim_folder(out, reads_images=reads_images)
    result = run_odometry(
        read_run(run_folder, span, images=reads_images),
        model=model,
        parameters=parameters,
        vision=not no_vision,
        terrain=terrain,
        config=settings,
        source=told_by,
        modes=modes,
        preset=preset,
        show_progress=True,
    )
    looks = reads_images or (source is None and not no_vision)
    for hint in hints(result, vision=looks, named=terrain):
        click.echo(f"Note: {hint}", err=True)
    with output.writing() as part:
        write_results(result, part, about(output.made))
        write_report(result, part)
    print_errors({result.run.name: result})
    print_sightings(sighting_counts(result))
    print_changes(result)
    for name, effects in result.effects.items():
        click.echo(f"Effects on {name}, in every trajectory but the ideal: {', '.join(effects)}")
    print_written(out)
    click.echo(f"Next: open {out / 'report.html'}")
    odd = any(report.misleads for report in checks_made())
    advice = learned_advice(result, run_folder, out, has_warnings=odd, preset=preset)
    if advice:
        click.echo(advice)
