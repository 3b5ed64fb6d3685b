"""Signals of a recording as its check reads them, each drawn on given axes."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.findings.finding import CheckReport
from odometry.report.drawing.figure import LINE_STYLES, REFERENCE_STYLE, TERRAIN_TINTS, LineStyle
from odometry.report.drawing.labels import HALO
from odometry.windows.recorded.spans import within

Marks = Mapping[str, FloatArray]

ORDINARY_WIDTH = 1.8  # effective width in track widths where none can be estimated
NARROWEST = 0.004  # of the time axis: so that the mark of a single sample is visible
ROOM = 1.15  # of the limits, above what all but one sample in 200 reach
BEYOND = 3.0  # times that, from which single samples do not set the limits
ARROWS = 36
FEW_POSES = 500  # below, each is a point
FAR_M = 1e4  # from the origin: positions are drawn less the first one
_LEFT, _RIGHT, _GYROSCOPE = LINE_STYLES[0], LINE_STYLES[1], LINE_STYLES[2]
_THIN = LineStyle(REFERENCE_STYLE.colour, "solid", 1.2)


def marks_of(report: CheckReport) -> dict[str, FloatArray]:
    """Spans of run time (R, 2) by the names of the findings that have a place in time."""
    found: dict[str, list[tuple[float, float]]] = {}
    for finding in report.findings:
        if finding.spans_s:
            found.setdefault(finding.name, []).extend(finding.spans_s)
    return {name: np.array(spans) for name, spans in found.items()}


def mark_colours(marks: Marks) -> dict[str, str]:
    """A tint for each name; dark lines stay readable on it."""
    return {name: TERRAIN_TINTS[i % len(TERRAIN_TINTS)] for i, name in enumerate(marks)}


def plot_tread_speeds(axes: Axes, evidence: Evidence, marks: Marks) -> None:
    """Draw both tread speeds [m/s] over run time [s], with what is odd marked."""
    time_s = evidence.stamps_s - evidence.stamps_s[0]
    speeds = evidence.run.odometry.stack("v_left", "v_right")
    for values, name, style in zip(speeds.T, ("left", "right"), (_LEFT, _RIGHT), strict=True):
        axes.plot(time_s, values, color=style.colour, linewidth=1.0, drawstyle="steps-post",
                  linestyle=style.dashes, label=f"{name} tread")  # fmt: skip
    axes.set_ylabel("tread speed [m/s]")
    _time_axis(axes, evidence, marks)
    colours = mark_colours(marks)
    _legend(axes, [Patch(color=colour, label=name) for name, colour in colours.items()])
    _limits(axes, [speeds.ravel()])


def plot_yaw_rates(axes: Axes, evidence: Evidence, marks: Marks) -> None:
    """Draw the yaw rates [rad/s] of treads, gyroscope and poses over run time [s].

    Means over the windows of the check (half a second, or between poses).
    """
    uniform, motion = evidence.uniform, evidence.motion
    width_m, how = effective_width_m(evidence)
    lines = {
        f"treads (effective width {width_m:.3g} m, {how})": (
            uniform,
            uniform.difference_m / width_m,
            _LEFT,
        )
    }
    if evidence.yaw_rate is not None:
        lines["gyroscope"] = (uniform, uniform.gyroscope_rad, _GYROSCOPE)
    if evidence.yaw_measured:
        name = "poses (yaw read as degrees)" if evidence.yaw_in_degrees else "poses"
        lines[name] = (motion, motion.turn_rad, _THIN)
    drawn = []
    for name, (of, turn_rad, style) in lines.items():
        middle_s, rates = _broken(of, turn_rad / of.lasts_s)
        axes.plot(middle_s - evidence.stamps_s[0], rates, color=style.colour, label=name,
                  linestyle=style.dashes, linewidth=style.width_pt, marker=".",
                  markersize=2.5)  # fmt: skip
        drawn.append(rates)
    axes.set_ylabel("yaw rate [rad/s]")
    axes.set_xlabel("run time [s]")
    _time_axis(axes, evidence, marks)
    _legend(axes, [])
    _limits(axes, drawn)


def plot_measured_path(axes: Axes, evidence: Evidence, marks: Marks) -> None:
    """Draw the measured positions [m], arrows along the measured yaw, and marks on the path."""
    pose, used = evidence.run.pose, evidence.positions_measured
    if pose is None or used is None:
        axes.text(0.5, 0.5, "no measured poses", ha="center", va="center", color="#555555",
                  transform=axes.transAxes)  # fmt: skip
        axes.set_axis_off()
        return
    stamps_s, positions = pose.stamps_s[used], pose.stack("x", "y")[used]
    origin = positions[0] if np.abs(positions).max() > FAR_M else np.zeros(2)
    x, y = (positions - origin).T
    marker = "." if len(x) < FEW_POSES else ""
    axes.plot(x, y, color=_THIN.colour, linewidth=1.0, marker=marker, markersize=2.5)
    for name, colour in mark_colours(marks).items():
        spans_s = marks[name] + [-0.05, 0.05] + evidence.stamps_s[0]
        inside = within(stamps_s, spans_s)
        axes.plot(x[inside], y[inside], "o", color=colour, markersize=8.0, zorder=1, label=name)
    if evidence.yaw_measured:
        yaw = np.radians(pose["yaw"][used]) if evidence.yaw_in_degrees else pose["yaw"][used]
        some = np.flatnonzero(np.isfinite(yaw))
        some = some[np.linspace(0, len(some) - 1, min(ARROWS, len(some))).astype(np.int64)]
        axes.quiver(x[some], y[some], np.cos(yaw[some]), np.sin(yaw[some]), color=_LEFT.colour,
                    units="inches", width=0.016, scale_units="inches", scale=4.5,
                    zorder=3)  # fmt: skip
    axes.plot(x[0], y[0], "o", color="black", markersize=5.0)
    axes.annotate("start", (float(x[0]), float(y[0])), (0.0, 8.0), textcoords="offset points",
                  ha="center", fontsize=9, path_effects=HALO)  # fmt: skip
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.08)
    axes.grid(visible=True)
    axes.xaxis.set_major_locator(MaxNLocator(6))
    axes.yaxis.set_major_locator(MaxNLocator(6))
    less = [f" - {value:.0f}" if value else "" for value in origin]
    axes.set(xlabel=f"x{less[0]} [m]", ylabel=f"y{less[1]} [m]")
    arrows = "; arrows: measured yaw" if evidence.yaw_measured else ", without yaw"
    axes.set_title(f"path of pose.csv{arrows}", fontsize=9.5, loc="left")


def effective_width_m(evidence: Evidence) -> tuple[float, str]:
    """Width [m] by which the treads turn the robot, and how it is known."""
    for found, by in (
        (evidence.pose_turn_by_difference, "estimated from the poses"),
        (evidence.gyroscope_by_difference, "estimated from the gyroscope"),
    ):
        if found is not None and found.certain():
            return 1 / abs(found.slope), by
    return ORDINARY_WIDTH * evidence.run.robot.track_width, "1.8 track widths"


def _time_axis(axes: Axes, evidence: Evidence, marks: Marks) -> None:
    """Shade what is odd."""
    axes.set_xlim(0.0, max(evidence.duration_s, 1e-9))
    least_s = NARROWEST * evidence.duration_s
    colours = mark_colours(marks)
    for name, spans_s in marks.items():
        for begin_s, end_s in spans_s:
            wider_s = max(0.0, least_s - (end_s - begin_s)) / 2
            axes.axvspan(begin_s - wider_s, end_s + wider_s, color=colours[name], alpha=0.7,
                         linewidth=0, zorder=0.5, gid=name)  # fmt: skip
    axes.grid(visible=True, axis="y")
    axes.yaxis.set_major_locator(MaxNLocator(5))


def _legend(axes: Axes, patches: list[Patch]) -> None:
    """Name lines and marks above the axes, where a legend hides nothing."""
    axes.legend(
        handles=[*axes.lines, *patches],
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=6,
        frameon=False,
        fontsize=9,
        borderaxespad=0.2,
        handlelength=2.2,
        columnspacing=1.4,
    )


def _limits(axes: Axes, lines: list[FloatArray]) -> None:
    """Limits by ordinary values: single wild samples leave the axes, and an arrow says so."""
    values = np.concatenate(lines)
    values = values[np.isfinite(values)]
    if not len(values):
        return
    ordinary = max(float(np.quantile(np.abs(values), 0.995)), 1e-6)
    low, high = float(values.min()), float(values.max())
    top = high if high <= BEYOND * ordinary else ordinary
    bottom = low if low >= -BEYOND * ordinary else -ordinary
    room = (ROOM - 1) * max(top - bottom, 1e-6)
    axes.set_ylim(bottom - room, top + room)
    for value, end, place, where in ((high, top, 0.98, "top"), (low, bottom, 0.02, "bottom")):
        if value != end:
            arrow = "\N{UPWARDS ARROW}" if where == "top" else "\N{DOWNWARDS ARROW}"
            axes.text(0.995, place, f"{arrow} {value:.4g}", transform=axes.transAxes, ha="right",
                      va=where, fontsize=9, path_effects=HALO)  # fmt: skip


def _broken(motion: Motion, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Middles of windows and values, with NaN where the next window does not follow at once."""
    middle_s = (motion.start_s + motion.end_s) / 2
    apart = np.flatnonzero(motion.start_s[1:] > motion.end_s[:-1] + 1e-6) + 1
    return np.insert(middle_s, apart, np.nan), np.insert(values, apart, np.nan)
