"""`terrain-odometry run`: the main job."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import OUTPUT, RunFolder
from terrain.cli.run_options import run_options

if TYPE_CHECKING:
    from terrain.run_options import RunOptions


@click.command()
@click.argument("run_folder", metavar="RUN", type=RunFolder())
@click.option("--out", required=True, metavar="DIR", type=OUTPUT, help="Folder for the results.")
@run_options
def run(run_folder: Path, *, out: Path, options: "RunOptions") -> None:
    """Replay the run folder RUN and write terrain-aware odometry.

    Reads images, tread speeds and poses in time order, classifies the terrain ahead, switches the
    ICRs when the robot gets there, and writes trajectories, ICRs, terrain, figures and one page.
    With --source the terrain comes from elsewhere: `labels` shows what true labels would give.

    \b
    Example:
      terrain-odometry run my_run --model terrain.model --parameters set.toml --out results
    """
    from terrain.cli.hints import hints, learned_advice
    from terrain.cli.outputs import claim_folder
    from terrain.cli.recordings import checks_made, read_run
    from terrain.cli.results import print_changes, print_errors, print_image_labels, print_written
    from terrain.new_terrain import contradiction_lines
    from terrain.result_table import image_label_counts
    from terrain.results import write_run

    output = claim_folder(out, reads_images=options.reads_images)
    recording = read_run(run_folder, options.span, images=options.reads_images)
    result = options.replay(recording, show_progress=True)
    for hint in hints(result, vision=options.wants_images, named=options.terrain):
        click.echo(f"Note: {hint}", err=True)
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
