"""What of its images a run may take its terrain from, by what the check of the recording found."""

from dataclasses import replace

import numpy as np

from odometry.checks.findings.finding import CheckReport
from odometry.run import Run
from terrain.checks.fixed_parts import ROBOT_IN_IMAGES
from terrain.errors import PatchError
from terrain.run_options import RunOptions

# Findings by which images show other terrain than that ahead of the robot at their stamps: each
# label would be wrong, and some of them sure
ELSEWHERE = frozenset(
    {"images_unrelated", "images_unordered", "images_reversed", "images_upside_down"}
)
# ... and by which some of them do, or show nothing
OF_STRETCHES = frozenset({"images_frozen", "images_blank", "images_lost_details"})


def believed(run: Run, options: RunOptions, report: CheckReport) -> tuple[Run, RunOptions, str]:
    """A run and its options, with no more of its images than show the terrain ahead.

    Without vision where images show other terrain, and beside the parts of them that show the robot
    itself. A published system (a preset) is what it is, and keeps its camera.

    Parameters
    ----------
    run : Run
    options : RunOptions
    report : CheckReport
        Of the run, its images checked as well.

    Returns
    -------
    Run
    RunOptions
    str
        Why vision is left out, or "".
    """
    if options.preset is not None or not options.reads_images:
        return run, options, ""
    found = [finding for finding in report.findings if finding.name in ELSEWHERE]
    if not found:
        return _beside_robot(run, report), options, ""
    source = None if options.source == "camera" else options.source
    said = f"vision is left out, as with --no-vision: {found[0].cause}"
    return run, replace(options, vision=False, source=source), said


def run_to_label(run: Run, report: CheckReport) -> Run:
    """A run without the images, and parts of them, that do not show the terrain ahead.

    Raises
    ------
    PatchError
        If all images show other terrain, or none is left.
    """
    for finding in report.findings:
        if finding.name in ELSEWHERE:
            raise PatchError(
                f"{run.folder}: no patch can be labelled by these images: {finding.cause}"
            )
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
