"""What a killed run leaves: files and folders under temporary names, with the process in them."""

import os
import re
import shutil
from collections.abc import Callable
from pathlib import Path

from odometry.errors import OutputError

TEMPORARY = re.compile(r"\.(.+)\.(\d{1,9})\.part(\.\w+)?")
STAGE = "unfinished"  # .unfinished.PID.part: the folder in which an output is made


def stage_name() -> str:
    """Name of the temporary folder of this process."""
    return f".{STAGE}.{os.getpid()}.part"


def remove_stages(folder: Path) -> None:
    """Remove the temporary folders of processes that are gone.

    Raises
    ------
    OutputError
        If another process is writing there.
    """
    for stage in folder.glob(f".{STAGE}.*.part"):
        found = TEMPORARY.fullmatch(stage.name)
        if found is None or stage.is_symlink() or not stage.is_dir():
            continue
        if _is_alive(int(found[2])):
            raise OutputError(
                f"{folder}: process {found[2]} is writing there; wait for it, or delete {stage} "
                "if it is another program"
            )
        shutil.rmtree(stage, ignore_errors=True)


def remove_foreign_stages(folder: Path) -> None:
    """Remove every temporary folder: for an owner who knows that no process writes there.

    A process number says nothing of a process of another machine.
    """
    for stage in folder.glob(f".{STAGE}.*.part"):
        if stage.is_dir() and not stage.is_symlink():
            shutil.rmtree(stage, ignore_errors=True)


def remove_temporaries(folder: Path, is_own: Callable[[str], bool]) -> None:
    """Remove temporary files in a folder, of processes that are gone and files that are ours.

    Parameters
    ----------
    folder : Path
    is_own : callable
        Whether the file that the temporary one was to become, by its name, is ours.
    """
    for file in folder.glob(".*.part*"):
        found = TEMPORARY.fullmatch(file.name)
        if found is None or file.is_symlink() or not file.is_file():
            continue
        if is_own(f"{found[1]}{found[3] or ''}") and not _is_alive(int(found[2])):
            file.unlink(missing_ok=True)


def is_temporary(name: str) -> bool:
    """Whether a file or folder has a name that only a killed run leaves."""
    return TEMPORARY.fullmatch(name) is not None


def _is_alive(process: int) -> bool:
    """Whether another process of this number runs; this one has nothing to leave yet."""
    if process == os.getpid():
        return False
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return True
