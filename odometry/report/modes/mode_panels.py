"""Panels of modes over time: strips of names, probabilities, states."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.patches import Rectangle
from matplotlib.transforms import blended_transform_factory

from odometry.arrays import AnyArray, FloatArray
from odometry.evaluation.stretches import stretches
from odometry.modes.follow.track import ModeTrack
from odometry.modes.models.mode_set import NO_MODES, NONE_OF_THESE, UNDETERMINED
from odometry.recording.run import UNKNOWN
from odometry.report.drawing.figure import UNKNOWN_TINT, line_styles

MOST_LINES = 6  # more modes are rows of grey
MOST_DRAWN = 4000  # stamps
CHANGE_COLOUR = "#444444"
GREYS = LinearSegmentedColormap.from_list("probability", ["#FFFFFF", "#222222"])
HATCHES = {UNDETERMINED: "////", NONE_OF_THESE: "xxxx"}
EDGES = {UNDETERMINED: UNKNOWN_TINT, NONE_OF_THESE: "#222222"}
STATE_COLOUR, MEASURED_COLOUR, WHEEL_COLOUR = "#0072B2", "#B0B0B0", "#D55E00"


def drawn_rows(count: int) -> AnyArray:
    """Rows that are drawn of so many: all, or evenly chosen ones."""
    return np.unique(np.linspace(0, count - 1, min(count, MOST_DRAWN)).round().astype(int))


def draw_strips(
    axes: Axes,
    stamps_s: FloatArray,
    strips: Mapping[str, AnyArray],
    colours: Mapping[str, str],
) -> None:
    """One coloured strip for each row of names (N,): the first on top.

    Nothing is drawn where the name is "unknown", hatched where it names no mode.
    """
    for row, names in enumerate(strips.values()):
        for stretch in stretches(stamps_s, names.tolist()):
            if stretch.terrain == UNKNOWN:
                continue
            open_ = stretch.terrain in NO_MODES
            axes.add_patch(
                Rectangle(
                    (stretch.start_s, row - 0.4),
                    stretch.end_s - stretch.start_s,
                    0.8,
                    facecolor="white" if open_ else colours.get(stretch.terrain, UNKNOWN_TINT),
                    edgecolor=EDGES.get(stretch.terrain, "none"),
                    hatch=HATCHES.get(stretch.terrain),
                    linewidth=0.0,
                )
            )
    axes.set_yticks(range(len(strips)), list(strips), parse_math=False, fontsize=9)
    axes.set_ylim(len(strips) - 0.5, -0.5)
    axes.tick_params(axis="both", length=0)
    for side in ("left", "bottom"):
        axes.spines[side].set_visible(False)


def draw_probabilities(
    axes: Axes, track: ModeTrack, sure: float, colours: Mapping[str, str]
) -> None:
    """Probability of each mode: lines, or a row of grey each where there are many."""
    if len(track.names) <= MOST_LINES:
        _draw_lines(axes, track, sure, colours)
    else:
        _draw_rows(axes, track, colours)


def mark_mode_changes(panels: Sequence[Axes], stamps_s: FloatArray, labels: AnyArray) -> None:
    """Dashed lines where the true mode changes."""
    for stretch in stretches(stamps_s, labels.tolist())[1:]:
        for axes in panels:
            axes.axvline(
                stretch.start_s, color=CHANGE_COLOUR, linewidth=0.9, linestyle=(0, (4, 3)), zorder=4
            )


def draw_state(
    axes: Axes,
    stamps_s: FloatArray,
    estimate: tuple[FloatArray, FloatArray],
    measured: FloatArray,
    wheels: FloatArray | None = None,
) -> None:
    """A quantity (N,) with a band of 2 sigma, what was measured of it, and what wheels say."""
    rows = drawn_rows(len(stamps_s))
    mean, sigma = (values[rows] for values in estimate)
    dots = np.flatnonzero(np.isfinite(measured))
    dots = dots[drawn_rows(len(dots))] if len(dots) else dots
    axes.plot(
        stamps_s[dots],
        measured[dots],
        linestyle="none",
        marker=".",
        markersize=1.8,
        color=MEASURED_COLOUR,
        label="measured",
        rasterized=True,
    )
    if wheels is not None:
        axes.plot(
            stamps_s[rows],
            wheels[rows],
            color=WHEEL_COLOUR,
            linewidth=0.9,
            linestyle=(0, (4, 2)),
            label="mean of the treads",
        )
    band = (mean - 2 * sigma, mean + 2 * sigma)
    axes.fill_between(
        stamps_s[rows], *band, color=STATE_COLOUR, alpha=0.2, linewidth=0, label="2 sigma"
    )
    axes.plot(stamps_s[rows], mean, color=STATE_COLOUR, linewidth=1.3, label="estimate")
    beside = mean if wheels is None else wheels[rows]
    shown = np.concatenate([mean, measured[dots], beside])  # the first bands may be very broad
    room = max(0.1 * float(np.ptp(shown)), 0.02)
    axes.set_ylim(float(shown.min()) - room, float(shown.max()) + room)
    axes.grid(visible=True, axis="y")


def _draw_lines(axes: Axes, track: ModeTrack, sure: float, colours: Mapping[str, str]) -> None:
    rows, styles = drawn_rows(len(track.stamps_s)), line_styles(track.names)
    for name, column in zip(track.names, track.probabilities.T, strict=True):
        style = styles[name]
        axes.plot(
            track.stamps_s[rows],
            column[rows],
            color=colours[name],
            linestyle=style.dashes,
            linewidth=style.width_pt,
        )
    axes.axhline(sure, color="#AAAAAA", linewidth=0.8, zorder=0)
    axes.set_ylim(-0.03, 1.03)
    axes.set_yticks([0.0, 0.5, 1.0])
    axes.set_ylabel("probability")
    axes.grid(visible=True, axis="y")


def _draw_rows(axes: Axes, track: ModeTrack, colours: Mapping[str, str]) -> None:
    rows, count = drawn_rows(len(track.stamps_s)), len(track.names)
    edges = np.append(track.stamps_s[rows], track.stamps_s[-1])
    axes.pcolormesh(
        edges,
        np.arange(count + 1) - 0.5,
        track.probabilities[rows].T,
        cmap=GREYS,
        vmin=0.0,
        vmax=1.0,
        rasterized=True,
    )
    for stretch in stretches(track.stamps_s, track.labels.tolist()):
        if stretch.terrain in track.names:
            place = (stretch.start_s, track.names.index(stretch.terrain) - 0.5)
            axes.add_patch(
                Rectangle(
                    place,
                    stretch.end_s - stretch.start_s,
                    1.0,
                    fill=False,
                    edgecolor="#D55E00",
                    linewidth=1.4,
                    zorder=5,
                )
            )
    beside = blended_transform_factory(axes.transAxes, axes.transData)
    for row, name in enumerate(track.names):
        axes.add_patch(
            Rectangle(
                (-0.022, row - 0.35),
                0.015,
                0.7,
                transform=beside,
                facecolor=colours[name],
                clip_on=False,
            )
        )
    axes.set_yticks(range(count), track.names, parse_math=False, fontsize=8)
    axes.tick_params(axis="y", length=0, pad=12)
    axes.set_ylim(count - 0.5, -0.5)
