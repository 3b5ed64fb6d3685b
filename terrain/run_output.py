"""The folder of one replayed run, whole: numbers, figures and page."""

from collections.abc import Sequence

from odometry.checks.finding import CheckReport
from odometry.outputs.made import about_result
from odometry.outputs.output_folder import OutputFolder
from terrain.report import page
from terrain.results import write_results
from terrain.run_result import RunResult


def write_run(result: RunResult, output: OutputFolder, reports: Sequence[CheckReport]) -> None:
    """Write all of one run into the folder that was claimed for it.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    with output.writing() as part:
        write_results(result, part, about_result(output.made, reports))
        page.write_report(result, part)
