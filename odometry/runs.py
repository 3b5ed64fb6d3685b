"""Several runs together."""

from collections.abc import Sequence

from odometry.errors import RunFolderError
from odometry.run import Run


def run_names(runs: Sequence[Run]) -> list[str]:
    """Names of the folders; where those of different folders are alike, their paths."""
    folders = {run.folder for run in runs}
    names = [folder.resolve().name for folder in folders]
    return [run.name if names.count(run.name) == 1 else str(run.folder) for run in runs]


def check_no_run_twice(runs: Sequence[Run]) -> None:
    """Raise RunFolderError if a folder is there twice: a model would be judged by its own data."""
    folders = [run.folder.resolve() for run in runs]
    for folder in folders:
        if folders.count(folder) > 1:
            raise RunFolderError(f"{folder} is given twice; expected each run once")
