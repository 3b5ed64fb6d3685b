"""`terrain-odometry export`: results in the formats of the programs that use them."""

import importlib
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import OUTPUT, Positive

if TYPE_CHECKING:
    from collections.abc import Callable

    from odometry.export.source import ExportSource

# Format: what it is, and the file of odometry.export that writes it
FORMATS = {
    "ros": ("ros.yaml: diff_drive_controller, robot_localization, slip by terrain", "ros_file"),
    "tum": ("odometer and estimate: stamp x y z qx qy qz qw", "trajectory_formats"),
    "kitti": ("the same: poses and times, optical axes", "trajectory_formats"),
    "euroc": ("the same: nanoseconds, quaternion w first", "trajectory_formats"),
    "mcap": ("results.mcap: odometer, estimate and terrain, for viewers (extra bags)", "mcap"),
    "map": ("terrain.geojson, or terrain_cells.csv without an origin", "terrain_map"),
    "parquet": ("the tables, for pandas (extra tables)", "parquet"),
}
LIST = "\n".join(f"  {name:8} {about}" for name, (about, _) in FORMATS.items())


@click.command(epilog=f"\b\nFormats:\n{LIST}")
@click.argument("source", metavar="SOURCE", type=click.Path(exists=True, path_type=Path))
@click.option(
    "--to",
    "formats",
    multiple=True,
    required=True,
    type=click.Choice(list(FORMATS)),
    help="Format; repeat.",
)
@click.option("--out", required=True, metavar="DIR", type=OUTPUT, help="Folder for the files.")
@click.option(
    "--terrain", default="", metavar="NAME", help="Whose numbers the controller of ros.yaml gets."
)
@click.option(
    "--track-width",
    "track_width_m",
    type=Positive(1e3),
    metavar="METRES",
    help="Wheel separation, where the source does not say it.",
)
@click.option(
    "--cell",
    "cell_m",
    type=Positive(1e3),
    default=0.5,
    show_default=True,
    metavar="METRES",
    help="Side of the cells of a map.",
)
def export(
    source: Path,
    *,
    formats: tuple[str, ...],
    out: Path,
    terrain: str,
    track_width_m: float | None,
    cell_m: float,
) -> None:
    """Write a parameter set, or a folder that `run` wrote, in formats of other programs.

    SOURCE is a set (TOML), of which `ros` can be made, or a folder of results. Each number of
    ros.yaml has its 95 % interval beside it; what such numbers cannot say is said there, too.

    \b
    Example:
      terrain-odometry export results --to ros --to mcap --terrain grass --out exported
    """
    from odometry.export.ros_yaml import printable
    from odometry.export.source import read_export_source
    from odometry.recording.run import Robot
    from odometry.set_of_robot import set_notes
    from terrain.cli.outputs import claim_folder
    from terrain.cli.results import print_written

    output = claim_folder(out)
    exported = read_export_source(
        source,
        terrain=terrain,
        track_width_m=track_width_m,
        cell_m=cell_m,
        comment=output.made.to_comment(),
    )
    for one in exported.edited:
        click.echo(f"Warning: {one}; it is exported as it is now", err=True)
    if "ros" in formats and exported.track_width_m is not None:
        notes = set_notes(exported.parameters, Robot(exported.track_width_m))
        for note in notes:
            click.echo(f"Warning: {note}", err=True)
        lines = "".join(f"# {printable(note)}\n" for note in notes)
        exported = replace(exported, comment=exported.comment + lines)
    with output.writing() as part:
        for name in dict.fromkeys(formats):
            _writer(name)(exported, part)
    print_written(out)
    if "ros" in formats:
        click.echo(f"Next: copy the sections of {out / 'ros.yaml'} into the node's parameters")


def _writer(name: str) -> "Callable[[ExportSource, Path], None]":
    module = importlib.import_module(f"odometry.export.{FORMATS[name][1]}")
    write: Callable[..., None] = module.write
    return partial(write, named=name) if FORMATS[name][1] == "trajectory_formats" else write
