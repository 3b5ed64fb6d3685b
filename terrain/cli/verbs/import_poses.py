"""`import --pose FILE`, `--truth FILE`: trajectories of other programs in a run folder."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import wraps
from pathlib import Path
from typing import Any

import click

from terrain.cli.options import trajectory_options

FILE = click.Path(exists=True, dir_okay=False, path_type=Path)
PLACE = (
    "pose.csv: taken as the poses of the robot's centre. If they are those of an antenna, camera, "
    "lidar or marker, write its place, [sensors] pose = [x, y, z], to run.toml: a fit cannot tell "
    "it from x_icr"
)


@dataclass(frozen=True)
class PoseFiles:
    """Trajectories to be added to a run.

    Attributes
    ----------
    files : dict of str to Path
        By the table that they become: pose, truth.
    times : Path or None
        Stamps of KITTI files.
    axes : str
        "robot", "optical", or "" for those of the format.
    """

    files: dict[str, Path]
    times: Path | None = None
    axes: str = ""


def pose_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add --pose, --truth, --times and --axes; the command gets them as `poses`."""

    @click.option(
        "--pose",
        type=FILE,
        help="Poses of another program (TUM, KITTI, EuRoC), or latitude and longitude (CSV, "
        "RTKLIB, NMEA), as pose.csv.",
    )
    @click.option("--truth", type=FILE, help="The same as truth.csv: for scoring alone.")
    @trajectory_options
    @wraps(command)
    def with_poses(
        *,
        pose: Path | None,
        truth: Path | None,
        times: Path | None,
        axes: str,
        **others: Any,
    ) -> None:
        named = {"pose": pose, "truth": truth}
        files = {name: file for name, file in named.items() if file is not None}
        if not files and (times or axes):
            raise click.UsageError("--times and --axes are of --pose or --truth: name one")
        command(poses=PoseFiles(files, times, axes), **others)

    return with_poses


def without_reference(options: dict[str, Any], poses: PoseFiles) -> dict[str, Any]:
    """Options of a bag whose reference a file of --pose replaces."""
    if "pose" not in poses.files:
        return options
    if options["reference"] not in {None, "none"}:
        raise click.UsageError("--pose and --reference both become pose.csv: name one")
    return options | {"reference": "none"}


def write_poses(folder: Path, poses: PoseFiles) -> list[str]:
    """Write the tables into a run folder that has its odometry; what was written, a line each.

    Raises
    ------
    OdometryError
        If a file cannot be read, or has no stamp in common with the odometry.
    """
    from odometry.fixes.origin import write_origin
    from odometry.io.csv_table import write_csv_table
    from odometry.io.run_folder import read_settings, read_tables
    from odometry.io.trajectory_poses import poses_within
    from terrain.cli.verbs.pose_tables import read_pose_table

    odometry = read_tables(folder)["odometry"]
    settings = read_settings(folder)
    times, axes = poses.times, poses.axes
    tables = {
        name: read_pose_table(name, file, settings, odometry, times=times, axes=axes)
        for name, file in poses.files.items()
    }
    counts = {name: poses_within(each.columns["t"], odometry) for name, each in tables.items()}
    lines = []
    for name, table in tables.items():
        write_csv_table(folder / f"{name}.csv", table.columns)
        lines.append(
            f"  {name}.csv: {len(table.columns['t'])} rows from {poses.files[name]}, "
            f"{counts[name]} of them within the odometry"
        )
        lines += [f"  {note}" for note in table.notes]
        if table.origin is not None:
            lines.append(f"  {write_origin(folder, table.origin)}")
        if name == "pose" and "pose" not in settings.get("sensors", {}):
            lines.append(f"  {PLACE}")
        for said in table.said:
            click.echo(said, err=True)
    return lines


def add_to_run(folders: tuple[Path, ...], out: Path | None, poses: PoseFiles) -> Path:
    """Add poses to the run folder that is there; a table that it has is not replaced.

    Raises
    ------
    OutputError
        If the folder has such a table already.
    OdometryError
        As `write_poses`.
    """
    from odometry.errors import OutputError
    from odometry.outputs.manifest import check_finished
    from terrain.cli.outputs import WHOLE

    if len(folders) > 1 or out is not None:
        raise click.UsageError("poses are added to one run folder, in its place: leave out --out")
    (folder,) = folders
    check_finished(folder)
    for name in poses.files:
        if (folder / f"{name}.csv").exists():
            raise OutputError(f"{folder / name}.csv is there already; move it, or delete it")
    lines = write_poses(folder, poses)
    _say_in_manifest(folder, poses)
    WHOLE.append(folder)
    click.echo("\n".join([f"Added to the run {folder}:", *lines]))
    return folder


def _say_in_manifest(folder: Path, poses: PoseFiles) -> None:
    """Add the tables to what made the folder, where the program made it."""
    from odometry.outputs.manifest import read_manifest
    from odometry.outputs.provenance import Input

    manifest = read_manifest(folder)
    if manifest is None:
        return
    added = [
        {
            "file": f"{name}.csv",
            "path": str(file),
            "sha256": Input.of(f"--{name}", file).sha256(with_images=False),
        }
        for name, file in poses.files.items()
    ]
    before = list(manifest.made.get("added", []))
    names = dict.fromkeys([*manifest.files, *(f"{name}.csv" for name in poses.files)])
    made = dict(manifest.made) | {"added": before + added}
    replace(manifest, files=tuple(names), made=made).write(folder)
