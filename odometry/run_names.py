"""Several runs together."""

from collections.abc import Sequence

from odometry.errors import RunFolderError
from odometry.run import Robot, Run


def run_names(runs: Sequence[Run]) -> list[str]:
    """Names of the folders; where those of different folders are the same, their paths."""
    folders = {run.folder for run in runs}
    names = [folder.resolve().name for folder in folders]
    return [run.name if names.count(run.name) == 1 else str(run.folder) for run in runs]


def check_no_run_twice(runs: Sequence[Run]) -> None:
    """Raise RunFolderError if a folder is there twice: a model would be tested on its own data."""
    folders = [run.folder.resolve() for run in runs]
    for folder in folders:
        if folders.count(folder) > 1:
            raise RunFolderError(
                f"{folder} is given twice; expected each run once: none can be its own test"
            )


def robot_labels(robots: Sequence[Robot]) -> dict[tuple[str, float], str]:
    """A short name for every robot: the part before a bracket where that distinguishes them."""
    keys = list(dict.fromkeys((robot.name, robot.track_width) for robot in robots))
    full = {(name, width): name or f"robot {width:g} m wide" for name, width in keys}
    short = {key: name.split(" (")[0] for key, name in full.items()}
    longest = {key: f"{name}, track width {key[1]:g} m" for key, name in full.items()}
    choices = (short, full, longest)
    return next(labels for labels in choices if len(set(labels.values())) == len(keys))
