"""Read and write run folders: the only door in."""

import os
import shlex
from collections.abc import Mapping
from itertools import islice
from pathlib import Path
from typing import Any

import tomli_w

from odometry.arrays import AnyArray
from odometry.errors import RunFolderError
from odometry.io.csv_table import read_csv_table, write_csv_table
from odometry.io.files import atomic_write, leads_out
from odometry.io.structured import read_toml
from odometry.tables.table import Table

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

    Columns and units are those of data/README.md (Run folder): seconds, metres, radians. A tread
    speed holds until the next stamp. Columns are not judged here: `check_recording` does that.

    Parameters
    ----------
    folder : Path
        Made if it is missing. Image files are the caller's to write.
    settings : Mapping
        The content of `run.toml`; `[robot]` with `track_width` [m] is required.
    tables : Mapping of name to columns
        "odometry" (required to read the folder), "pose", "velocity", "images", "truth", "imu";
        columns by name are arrays (N,).

    Raises
    ------
    RunFolderError
        If a table has another name, or columns that differ in length.

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
