"""Paths that are given to a check, and are no run folder."""

from itertools import islice
from pathlib import Path

from odometry.checks.finding import Finding, Level
from odometry.io.bag_names import import_command, is_named_bag

MOST_ENTRIES = 1000  # of a folder that are looked at
NEEDED = "a run folder holds run.toml and odometry.csv"


def no_run_folder(folder: Path) -> Finding | None:
    """What a path is instead of a run folder; None where it may be one."""
    if not folder.exists():
        return _finding(f"{folder}: there is no such folder", "The path is misspelt or was moved")
    if not folder.is_dir():
        nothing = _finding(
            f"{folder}: this is a file; expected a run folder", f"This is no run folder: {NEEDED}"
        )
        return _bag(folder) if is_named_bag(folder) else nothing
    if (folder / "run.toml").exists() or (folder / "odometry.csv").exists():
        return None  # what is missing is said by the error of reading
    return _without_run(folder, sorted(islice(folder.iterdir(), MOST_ENTRIES)))


def _without_run(folder: Path, entries: list[Path]) -> Finding:
    if any(map(is_named_bag, entries)):
        return _bag(folder)
    runs = [entry.name for entry in entries if (entry / "run.toml").is_file()]
    if runs:
        shown = ", ".join(runs[:3]) + (" ..." if len(runs) > 3 else "")
        return _finding(
            f"{folder}: this folder has no run.toml, and {len(runs)} in it have one ({shown})",
            "It holds run folders, and is none",
            f"Name these: {folder}/*/",
        )
    return _finding(f"{folder}: no run.toml, no odometry.csv", f"This is no run folder: {NEEDED}")


def _bag(path: Path) -> Finding:
    return _finding(
        f"{path}: this is a bag (a log of ROS)",
        f"A bag is no run folder: {NEEDED}",
        f"Import it: {import_command(path)}",
    )


def _finding(seen: str, cause: str, remedy: str = "Name a run folder") -> Finding:
    return Finding("no_run_folder", Level.REFUSED, seen, cause, remedy)
