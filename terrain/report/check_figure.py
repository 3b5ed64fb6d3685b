"""The figure of a check: treads, yaw rates, measured path, and the terrain in one image."""

from pathlib import Path
from textwrap import wrap

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import CheckReport, Level
from odometry.outputs.output_file import picture_source
from odometry.recording.run import Run
from odometry.report.check_plots import (
    marks_of,
    plot_measured_path,
    plot_tread_speeds,
    plot_yaw_rates,
)
from odometry.report.drawing.figure import save_figure
from terrain.checks.drawn_images import shown_image
from terrain.report.ground_plots import plot_ground

_WIDTH_IN = 10.0
_SIGNALS_IN, _PLACES_IN = 5.4, 3.6  # height of the panels over time, and of path and image
_LINE_IN = 0.17
_LETTERS = 138  # of a line of findings
_SHOWN = 8  # findings
_LEFT, _RIGHT = 0.085, 0.985


def write_check_figure(report: CheckReport, file: Path) -> Path | None:
    """Draw a recording and what its check found.

    Parameters
    ----------
    report : CheckReport
        Of the run folder that it names.
    file : Path
        Ends in .png.

    Returns
    -------
    Path or None
        `file`; None where the recording is refused, and nothing can be drawn.
    """
    if report.at(Level.REFUSED):
        return None
    run = Run.read(report.folder)
    evidence, marks, shown = Evidence(run), marks_of(report), shown_image(run)
    lines = _finding_lines(report)
    has_path = evidence.positions_measured is not None
    below_in = _PLACES_IN if has_path or shown is not None else 0.0
    height_in = 0.45 + _LINE_IN * len(lines) + _SIGNALS_IN + below_in

    def draw(figure: Figure) -> None:
        def axes(left: float, bottom_in: float, right: float, panel_in: float) -> Axes:
            place = (left, bottom_in / height_in, right - left, panel_in / height_in)
            return figure.add_axes(place)

        _write_findings(figure, _title(report), lines)
        plot_tread_speeds(axes(_LEFT, below_in + 2.95, _RIGHT, 1.95), evidence, marks)
        plot_yaw_rates(axes(_LEFT, below_in + 0.5, _RIGHT, 1.75), evidence, marks)
        if below_in:
            middle = 0.48 if shown is not None else _RIGHT
            plot_measured_path(axes(_LEFT, 0.5, middle, 2.8), evidence, marks)
        if shown is not None:
            plot_ground(axes(0.53, 0.5, _RIGHT, 2.8), run.robot, shown)

    return save_figure(file, (_WIDTH_IN, height_in), draw, source=picture_source("check"))


def _write_findings(figure: Figure, title: str, lines: list[str]) -> None:
    height_in = figure.get_figheight()
    figure.text(_LEFT, 1 - 0.22 / height_in, title, fontsize=12, fontweight="bold",
                va="center", parse_math=False)  # fmt: skip
    for number, line in enumerate(lines):
        figure.text(_LEFT, 1 - (0.5 + _LINE_IN * number) / height_in, line, fontsize=8.5,
                    va="center", parse_math=False)  # fmt: skip


def _title(report: CheckReport) -> str:
    counts = [f"{len(report.at(level))} {level}s" for level in (Level.WARNING, Level.NOTE)]
    found = " and ".join(word[:-1] if word.startswith("1 ") else word for word in counts)
    return f"{report.name}: {found if report.findings else 'no findings'}"


def _finding_lines(report: CheckReport) -> list[str]:
    lines = []
    for finding in report.findings[:_SHOWN]:
        first, *more = wrap(f"{finding.name} ({finding.level}): {finding.seen}", _LETTERS)
        lines += [first, *(f"    {line}" for line in more)]
    if len(report.findings) > _SHOWN:
        lines.append(f"... and {len(report.findings) - _SHOWN} more")
    return lines
