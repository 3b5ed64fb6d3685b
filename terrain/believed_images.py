"""Whether a run may take its terrain from its images, by what the check of the recording found."""

from dataclasses import replace

from odometry.checks.finding import CheckReport
from terrain.run_options import RunOptions

# Findings by which images show other terrain than that ahead of the robot at their stamps: each
# label would be wrong, and some of them sure
ELSEWHERE = frozenset(
    {"images_unrelated", "images_unordered", "images_reversed", "images_upside_down"}
)


def believed(options: RunOptions, report: CheckReport) -> tuple[RunOptions, str]:
    """The options of a run, without vision where its images show other terrain.

    A published system (a preset) is what it is, and keeps its camera.

    Parameters
    ----------
    options : RunOptions
    report : CheckReport
        Of the run, its images checked as well.

    Returns
    -------
    RunOptions
    str
        Why vision is left out, or "".
    """
    found = [finding for finding in report.findings if finding.name in ELSEWHERE]
    if not found or not options.reads_images or options.preset is not None:
        return options, ""
    source = None if options.source == "camera" else options.source
    said = f"vision is left out, as with --no-vision: {found[0].cause}"
    return replace(options, vision=False, source=source), said
