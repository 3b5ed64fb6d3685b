"""Read and write run folders: the only door in; trajectories from elsewhere as their poses."""

import os
import shlex
from collections.abc import Mapping
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import RunFolderError, TrajectoryError
from odometry.io.csv_table import read_csv_table, write_csv_table
from odometry.io.files import atomic_write, leads_out
from odometry.io.structured import read_toml
from odometry.table import Table
from odometry.trajectory import SpatialTrajectory

# file: (is it required, columns it must have, columns with a number in every row)
FILES = {
    "odometry": (True, ("t", "v_left", "v_right"), ("t", "v_left", "v_right")),
    "pose": (False, ("t", "x", "y", "yaw"), ("t",)),
    "velocity": (False, ("t", "vx", "vy", "wz"), ("t",)),
    "images": (False, ("t", "file"), ("t",)),
    "truth": (False, ("t", "x", "y", "yaw"), ("t", "x", "y", "yaw")),
    "imu": (False, ("t",), ("t",)),
}

SUFFIXES = (".bag", ".mcap", ".db3", ".active")
PACKED = (".zstd", ".zst")
MOST_ENTRIES = 1000  # of a folder that are listed
ZONE_S, MOST_ZONE_S = 900.0, 14 * 3600.0  # time zones differ by whole quarters of an hour
LEVEL = 0.2  # height of a path over its extent: below, z points up


def read_settings(folder: Path) -> dict[str, Any]:
    """Read `run.toml` whole; tables that the format does not name are kept.

    Raises
    ------
    RunFolderError
        If the folder or the file is missing, it is a bag, or as `odometry.io.structured.read_toml`.
    """
    if bag_at(folder):
        raise RunFolderError(this_is_a_bag(folder))
    if not folder.is_dir():
        seen = "this is a file" if folder.exists() else "there is no such folder"
        raise RunFolderError(f"{folder}: {seen}; expected a run folder")
    file = folder / "run.toml"
    if not file.exists():
        raise RunFolderError(f"{file}: missing; a run folder needs run.toml")
    return read_toml(file, RunFolderError)


def read_tables(folder: Path) -> dict[str, Table]:
    """Read and check the CSV files that are there, by their names without suffix.

    Raises
    ------
    RunFolderError
        If `odometry.csv` is missing, or a file is not as the format says.
    """
    tables = {}
    for name, (needed, required, complete) in FILES.items():
        file = folder / f"{name}.csv"
        if file.exists():
            tables[name] = read_csv_table(file, required, complete)
        elif needed:
            raise RunFolderError(f"{file}: missing; a run folder needs it")
    if "images" in tables:
        _check_image_files(folder, tables["images"])
    return tables


def write_run_folder(
    folder: Path, settings: Mapping[str, Any], tables: Mapping[str, Mapping[str, AnyArray]]
) -> None:
    """Write `run.toml` and one CSV file a table.

    Parameters
    ----------
    folder : Path
        Made if it is missing. Image files are the caller's to write.
    settings : Mapping
        The content of `run.toml`; `[robot]` with `track_width` is required.
    tables : Mapping of name to columns
        Names of `FILES`; columns are arrays of one length, the first is `t`.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from pathlib import Path
    >>> import numpy as np
    >>> import odometry
    >>> ahead = {"t": np.array([0.0, 1.0]), "v_left": np.full(2, 0.5), "v_right": np.full(2, 0.5)}
    >>> settings = {"robot": {"track_width": 0.4}}
    >>> with TemporaryDirectory() as folder:
    ...     odometry.write_run_folder(Path(folder), settings, {"odometry": ahead})
    ...     print(len(odometry.Run.read(folder).odometry))
    2
    """
    unknown = sorted(set(tables) - set(FILES))
    if unknown:
        raise RunFolderError(f"{folder}: no such table {unknown[0]!r}; known: {', '.join(FILES)}")
    for name, columns in tables.items():
        write_csv_table(Path(folder) / f"{name}.csv", columns)
    with atomic_write(Path(folder) / "run.toml") as part:
        part.write_text(tomli_w.dumps(settings), encoding="utf-8")


def _check_image_files(folder: Path, images: Table) -> None:
    for line, name in zip(images.lines, map(str, images["file"]), strict=True):
        where = f"{images.file}: row {line}, column 'file'"
        if Path(name).is_absolute():
            raise RunFolderError(f"{where}: {name!r} is absolute; expected a path in the folder")
        if leads_out(folder, name):
            raise RunFolderError(f"{where}: {name!r} leads out of the folder {folder}")
        if not os.path.isfile(folder / name):  # noqa: PTH113 - Path.is_file raises on long names
            raise RunFolderError(f"{where}: {name!r} is not a file in {folder}")


def pose_columns(trajectory: SpatialTrajectory) -> dict[str, AnyArray]:
    """Columns of pose.csv by name: t, x, y, yaw, z, roll, pitch."""
    x, y, z = trajectory.positions_m.T
    roll, pitch, yaw = trajectory.roll_pitch_yaw.T
    return {
        "t": trajectory.stamps_s,
        "x": x,
        "y": y,
        "yaw": yaw,
        "z": z,
        "roll": roll,
        "pitch": pitch,
    }


def poses_within(stamps_s: FloatArray, odometry: Table) -> int:
    """How many poses, of stamps (N,), lie within the odometry of a run.

    Raises
    ------
    TrajectoryError
        If none does: other clocks, or another run.
    """
    first_s, last_s = odometry.stamps_s[[0, -1]]
    within = int(np.sum((stamps_s >= first_s) & (stamps_s <= last_s)))
    if not within:
        raise TrajectoryError(
            f"the poses are of {stamps_s[0]:.3f} to {stamps_s[-1]:.3f} s, {odometry.file} of "
            f"{first_s:.3f} to {last_s:.3f} s; expected stamps of one clock"
            f"{_another_zone(stamps_s, odometry.stamps_s)}"
        )
    return within


def _another_zone(stamps_s: FloatArray, of_odometry_s: FloatArray) -> str:
    """What is said where stamps (N,) begin near those of the odometry but for a time zone."""
    ahead_s = float(stamps_s[0] - of_odometry_s[0])
    quarters = round(ahead_s / ZONE_S)
    if not 0 < abs(quarters) * ZONE_S <= MOST_ZONE_S:
        return ""
    moved_s = stamps_s - quarters * ZONE_S
    if moved_s[0] > of_odometry_s[-1] or moved_s[-1] < of_odometry_s[0]:
        return ""
    hours = quarters * ZONE_S / 3600
    return (
        f". They share time where the poses are moved by {-hours:+g} hours: are they in another "
        "time zone than the odometry?"
    )


def travel_axis(trajectory: SpatialTrajectory) -> int:
    """Axis of the body (0 is x) along which it moves most; 0 where nothing moves."""
    moved = np.diff(trajectory.positions_m, axis=0)
    body = np.einsum("nji,nj->ni", trajectory.poses[:-1, :3, :3], moved)
    return int(np.argmax(np.sum(body**2, axis=0)))


def doubt_of_axes(trajectory: SpatialTrajectory) -> str:
    """Why a trajectory seems not to have robot axes; empty where it seems to.

    A skid-steer robot moves most along x of its body.
    """
    if (axis := travel_axis(trajectory)) == 0:
        return ""
    doubt = f"the body moves most along its {'xyz'[axis]} axis; expected x forward."
    extent_m = np.ptp(trajectory.positions_m, axis=0)
    if axis == 1 or extent_m[2] < LEVEL * extent_m[:2].max():
        body = "a sensor whose own axes are turned"
        if axis != 1:
            body = "a camera's optical frame (z along the viewing direction) in a map whose z is up"
        return f"{doubt} Poses of {body}: write those of the robot's base frame"
    return f"{doubt} Poses of a camera (z along the viewing direction, y down) need --axes optical"


def is_named_bag(path: Path) -> bool:
    """Whether a file is named as a bag."""
    plain = path.with_suffix("") if path.suffix.lower() in PACKED else path
    return plain.suffix.lower() in SUFFIXES


def bag_at(path: Path) -> bool:
    """Whether a path is a bag, or a folder that holds one and no run."""
    if not path.is_dir():
        return path.is_file() and is_named_bag(path)
    if (path / "run.toml").exists() or (path / "odometry.csv").exists():
        return False
    return any(map(is_named_bag, islice(path.iterdir(), MOST_ENTRIES)))


def this_is_a_bag(path: Path) -> str:
    """What is said of a bag where a run folder is expected."""
    return f"{path}: this is a bag (a log of ROS), no run folder. Import it: {import_command(path)}"


def import_command(path: Path) -> str:
    """The command that makes a run folder of a bag."""
    name = path.resolve().name.split(".")[0] or "my"
    return f"terrain-odometry import {shlex.quote(str(path))} --out {shlex.quote(f'{name}_run')}"
