"""What of a run may be used, by what the check found: images, and measured velocities."""

import warnings
from dataclasses import replace

import numpy as np

from odometry.checks.findings.finding import CheckReport, Level
from odometry.checks.velocity.velocity import VELOCITY_FAULTS
from odometry.recording.run import Run
from terrain.checks.fixed_parts import ROBOT_IN_IMAGES
from terrain.errors import PatchError

# Findings by which images show other terrain than that ahead of the robot at their stamps: each
# label would be wrong, and some of them sure; or are black but for a few grey levels
ELSEWHERE = frozenset(
    {
        *("images_unrelated", "images_unordered", "images_reversed", "images_upside_down"),
        *("images_12_bit", "images_few_bits"),
    }
)
# ... and by which some of them do, or show nothing
OF_STRETCHES = frozenset({"images_frozen", "images_blank", "images_lost_details"})


def believed(run: Run, report: CheckReport) -> tuple[Run, str]:
    """A run with no more of its images than show the terrain ahead; or why they show another.

    Parameters
    ----------
    run : Run
    report : CheckReport
        Of the run, its images checked as well.

    Returns
    -------
    Run
        Its [camera] with outlines of what shows the robot.
    str
        Why images show other terrain than that ahead, or "".
    """
    cause = shows_elsewhere(report)
    return (run, cause) if cause else (_beside_robot(run, report), "")


def shows_elsewhere(report: CheckReport) -> str:
    """Why images show other terrain than that ahead of the robot, or ""."""
    return next((found.cause for found in report.findings if found.name in ELSEWHERE), "")


def without_wrong_velocity(run: Run, report: CheckReport) -> tuple[Run, str]:
    """A run without velocity.csv where the check warns of it; and why, or ""."""
    for finding in report.at(Level.WARNING):
        if finding.name in VELOCITY_FAULTS:
            return replace(run, velocity=None), f"velocity.csv is left out: {finding.cause}"
    return run, ""


def as_checked(run: Run, report: CheckReport, source: str, *, has_feel: bool) -> tuple[Run, str]:
    """A run and its source of terrain, by name, by what the check found; it is warned of."""
    for finding in report.at(Level.WARNING):
        warnings.warn(f"{run.folder}: {finding.line.partition(': ')[2]}", stacklevel=3)
    run, _ = without_wrong_velocity(run, report)
    if source != "camera":
        return run, source
    run, cause = believed(run, report)
    if not cause:
        return run, source
    warnings.warn(f"{run.folder}: vision is left out, as with vision=False: {cause}", stacklevel=3)
    return run, "feel" if has_feel else "none"


def run_to_label(run: Run, report: CheckReport) -> Run:
    """A run without the images, and parts of them, that do not show the terrain ahead.

    Raises
    ------
    PatchError
        If all images show other terrain, or none is left.
    """
    if cause := shows_elsewhere(report):
        raise PatchError(f"{run.folder}: no patch can be labelled by these images: {cause}")
    if run.images is None:
        return run
    times_s = run.images.stamps_s - run.odometry.stamps_s[0]
    kept = np.ones(len(times_s), dtype=bool)
    for finding in report.findings:
        for from_s, to_s in finding.spans_s if finding.name in OF_STRETCHES else ():
            kept &= (times_s < from_s) | (times_s > to_s)
    if not kept.any():
        raise PatchError(
            f"{run.folder}: no image is left: the camera was frozen or covered all the time"
        )
    kept_images = run.images.rows(np.flatnonzero(kept))
    return _beside_robot(replace(run, images=kept_images), report)


def _beside_robot(run: Run, report: CheckReport) -> Run:
    """The run, its [camera] with outlines of what shows the robot."""
    mends = [finding.mend for finding in report.findings if finding.name == ROBOT_IN_IMAGES]
    for mend in mends:
        run = mend(run) if mend is not None else run
    return run
