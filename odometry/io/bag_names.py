"""Paths that are bags by their names: logs of ROS, which an import turns into run folders."""

import shlex
from itertools import islice
from pathlib import Path

SUFFIXES = (".bag", ".mcap", ".db3", ".active")
PACKED = (".zstd", ".zst")
MOST_ENTRIES = 1000  # of a folder that are listed


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
