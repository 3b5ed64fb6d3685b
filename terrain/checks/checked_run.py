"""A run as every verb reads it: cut to a span, checked, and refused where it cannot be used."""

from pathlib import Path

from odometry.checks.finding import CheckReport, Level
from odometry.checks.recording import check_recording
from odometry.errors import RunFolderError
from odometry.run import Run
from odometry.run_span import Span, cut_run
from terrain.checks.recording import check_run


def checked_run(folder: Path, span: Span, *, images: bool = False) -> tuple[Run, CheckReport]:
    """Read one run folder, cut to the span, and check it.

    Parameters
    ----------
    folder : Path
    span : Span
    images : bool
        Whether the camera and its images are checked as well.

    Raises
    ------
    RunFolderError
        If it is not as the format says, cannot be used as it is, or nothing of it lies in the
        span.
    """
    run = cut_run(Run.read(folder), span)
    report = check_run(run) if images else check_recording(run)
    refused = report.at(Level.REFUSED)
    if refused:
        raise RunFolderError(f"{folder}: {refused[0].line.removeprefix('refused: ')}")
    return run, report
