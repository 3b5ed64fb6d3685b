"""The verb that cuts labelled patches from recordings."""

import shlex
from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import OUTPUT, Positive
from terrain.cli.recordings import span_options
from terrain.cli.run_folders import RunFolder

if TYPE_CHECKING:
    from odometry.recording.run_span import Span

SOURCES = ("truth.csv", "odometry.csv", "images.csv", "run.toml")


@click.command()
@click.argument(
    "runs",
    metavar="RUN...",
    type=RunFolder(),
    nargs=-1,
    required=True,
)
@click.option("--out", required=True, metavar="PATCHES", type=OUTPUT, help="Folder to make.")
@click.option(
    "--span",
    "spans",
    multiple=True,
    metavar="[RUN:]FROM:TO=TERRAIN",
    help="Terrain under the robot from one second of run time to another; repeat. With several "
    "runs each begins with the name of its run.",
)
@click.option(
    "--labels",
    "source",
    type=click.Choice(SOURCES),
    help="The file whose terrain counts.  [default: spans, else the first of these that names one]",
)
@click.option(
    "--by-feel",
    metavar="FEEL",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Model made by `identify-feel`: terrain by feel labels the images that showed it before.",
)
@click.option(
    "--sure",
    type=click.FloatRange(0.0, 1.0, min_open=True, max_open=True),
    help="With --by-feel: lowest probability of a terrain that labels an image.  [default: 0.8]",
)
@click.option(
    "--parameters",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Parameter set: ICRs by terrain, for runs without gyroscope and poses.",
)
@click.option(
    "--patch-size",
    type=click.IntRange(min=8),
    metavar="PX",
    help="Side of a patch.  [default: 0.6 of the robot's width, at most 128]",
)
@click.option(
    "--metres-per-pixel",
    type=Positive(1000.0),
    help="Scale of the patches.  [default: what the camera resolves of the nearest squares]",
)
@click.option(
    "--per-place",
    type=click.IntRange(min=1),
    default=24,
    show_default=True,
    help="Patches of a terrain at one place, at the most.",
)
@click.option(
    "--place",
    "place_m",
    type=Positive(1000.0),
    default=2.0,
    show_default=True,
    help="Distance between places [m]; five sides of a patch if that is more.",
)
@span_options
def label(
    *,
    runs: tuple[Path, ...],
    out: Path,
    spans: tuple[str, ...],
    source: str | None,
    by_feel: Path | None,
    sure: float | None,
    parameters: Path | None,
    patch_size: int | None,
    metres_per_pixel: float | None,
    per_place: int,
    place_m: float,
    span: "Span",
) -> None:
    """Cut labelled patches from recordings, for `train`.

    A patch is a square that an image shows and that the robot then drove over, in the view from
    above. Its label is the terrain that is given while the footprint was over it: by --span, by a
    column `terrain`, or by [run] terrain. A square astride two terrains is left out. Patches of
    one place share a photo_id, so that `train` holds them back together.

    Look at contact_sheet_<terrain>.png. Move a wrong patch to the folder of another class, or
    delete it: `train` follows, and the next `label` into the same folder keeps it so.

    \b
    Example:
      terrain-odometry label my_run --span 0:20=grass --span 25:60=gravel --out my_patches
    """
    from dataclasses import replace

    from odometry.feel.model_file import read_feel_model
    from odometry.parameters import read_parameters
    from terrain.believed import run_to_label
    from terrain.cli.outputs import claim_folder
    from terrain.cli.recordings import checks_made, read_run
    from terrain.cli.texts.label_text import spans_by_run, summary
    from terrain.labelling.corrections import read_corrections
    from terrain.labelling.felt_terrain import SURE, given_by_feel
    from terrain.labelling.given_terrain import given_by_spans, given_terrain
    from terrain.labelling.label_runs import label_runs
    from terrain.labelling.patch_files import write_labelled_patches
    from terrain.labelling.scale import LabelConfig

    if sum(map(bool, (spans, source, by_feel))) > 1:
        raise click.UsageError("--span, --labels and --by-feel: give one of them")
    if sure is not None and by_feel is None:
        raise click.UsageError("--sure goes with --by-feel")
    config = LabelConfig(patch_size, metres_per_pixel, per_place, place_m)
    by_run = spans_by_run(spans, runs)
    output = claim_folder(out, reads_images=True)
    corrections = read_corrections(out)
    read = []
    for folder in runs:
        whole = read_run(folder, span, images=True)
        read.append(run_to_label(whole, checks_made()[-1]))
    if by_feel is not None:
        model = read_feel_model(by_feel)
        given = [given_by_feel(run, model, sure or SURE) for run in read]
    elif spans:
        given = [
            given_by_spans(run, by_run[run.folder], run.odometry.stamps_s[0] - span.from_s)
            for run in read
        ]
    else:
        given = [given_terrain(run, source) for run in read]
    labelled = label_runs(
        read,
        given,
        config,
        parameters=read_parameters(parameters) if parameters else None,
        corrections=corrections,
        show_progress=True,
    )
    output = replace(output, earlier=(*output.earlier, *corrections.paths))
    with output.writing() as part:
        unusable = write_labelled_patches(part, labelled, corrections, show_progress=True)
    for file, reason in unusable.items():
        click.echo(f"left out: {file}: {reason}", err=True)
    click.echo(summary(labelled, given))
    if corrections.moved or corrections.removed:
        moved = sum(each.label != each.of.label for each in labelled.chosen)
        click.echo(f"Corrections kept: {moved} moved, {len(corrections.removed)} removed.")
    click.echo(f"\nWrote {out}. Look at {out}/contact_sheet_*.png; move or delete wrong patches.")
    click.echo(f"Next: terrain-odometry train {shlex.quote(str(out))} --out terrain.model")
