"""Figures of modes, like those of Salvi 2024: probabilities and states over time, and the path."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from odometry.arrays import AnyArray
from odometry.modes.follow.followed import MOTION, MOTION_AND_CAMERA, MOTION_AND_FEEL, Followed
from odometry.modes.models.mode_set import NO_MODES
from odometry.recording.run import UNKNOWN
from odometry.report.drawing.figure import mode_colours, save_figure
from odometry.report.drawing.html import Picture
from odometry.report.modes.mode_panels import (
    EDGES,
    HATCHES,
    MEASURED_COLOUR,
    MOST_LINES,
    draw_probabilities,
    draw_state,
    draw_strips,
    drawn_rows,
    mark_mode_changes,
)

WIDTH_IN = 7.0
STRIP_IN, LINES_IN, ROW_IN, STATE_IN, GAP_IN = 0.24, 1.45, 0.19, 1.25, 0.32
LEGEND_ROW_IN, COLUMNS = 0.22, 4
LEFT_IN, LETTER_IN = 0.77, 0.052
ANSWERS = {MOTION: "answer", MOTION_AND_FEEL: "with feel", MOTION_AND_CAMERA: "with camera"}


def modes_picture(followed: Followed, folder: Path) -> Picture:
    """Names as strips, the probability of each mode, and of velocity modes the state, over time."""
    strips = _strips(followed)
    count = len(followed.mode_set.names)
    few = count <= MOST_LINES
    heights = [STRIP_IN * len(strips)]
    heights += [LINES_IN if few else ROW_IN * count] * len(followed.tracks)
    with_states = followed.mode_set.modes.kind == "velocity"
    heights += [STATE_IN, STATE_IN] if with_states else []
    top = LEGEND_ROW_IN * (1 + (count + 1) // COLUMNS if few else 1) + 0.2
    longest = 0 if few else max(map(len, followed.mode_set.names))
    left = max(LEFT_IN, LETTER_IN * longest + 0.3) / WIDTH_IN

    def draw(figure: Figure) -> None:
        panels = _panels(figure, heights, top, left)
        colours = mode_colours(followed.mode_set.names)
        draw_strips(panels[0], followed.motion.stamps_s, strips, colours)
        last = 1 + len(followed.tracks)
        for axes, (name, track) in zip(panels[1:last], followed.tracks.items(), strict=True):
            draw_probabilities(axes, track, followed.config.sure, colours)
            if len(followed.tracks) > 1:
                axes.set_title(name, loc="left", pad=3.0, fontsize=9)
        if with_states:
            _draw_velocity(panels[last:], followed)
        mark_mode_changes(panels, followed.motion.stamps_s, followed.motion.labels)
        panels[0].set_xlim(*followed.motion.stamps_s[[0, -1]].tolist())
        panels[-1].tick_params(labelbottom=True)
        panels[-1].set_xlabel("time [s]")
        _legend(figure, panels[1].lines[:count] if few else [], followed.mode_set.names)

    height_in = top + sum(heights) + GAP_IN * (len(heights) - 1) + 0.5
    return Picture(
        save_figure(folder / "modes.png", (WIDTH_IN, height_in), draw),
        "The true mode, the answer, and the probability of each mode over time.",
        _caption(followed, with_states=with_states),
    )


def path_picture(followed: Followed, folder: Path) -> Picture | None:
    """The estimated path in the colours of the answers; None where the state is no pose."""
    if followed.mode_set.modes.kind != "traction":
        return None
    track = followed.last_track
    answers = followed.answers(track)
    present = [name for name in (*track.names, *NO_MODES) if name in answers]

    def draw(figure: Figure) -> None:
        axes = figure.add_axes((0.1, 0.13, 0.56, 0.82))
        measured = followed.signals.measured[:, :2]
        measured = measured[np.isfinite(measured).all(axis=1)]
        measured = measured[drawn_rows(len(measured))]
        axes.plot(*measured.T, ".", color=MEASURED_COLOUR, markersize=3.0)
        rows = drawn_rows(len(answers))
        x, y = track.means[rows, :2].T
        colours = mode_colours(track.names) | EDGES
        ends = np.stack([np.column_stack([x, y])[:-1], np.column_stack([x, y])[1:]], axis=1)
        named = [colours[name] for name in answers[rows[1:]]]
        axes.add_collection(LineCollection(list(ends), colors=named, linewidths=2.2))
        for row in np.flatnonzero(track.labels[1:] != track.labels[:-1]) + 1:
            axes.plot(*track.means[row, :2], "D", color="white", markeredgecolor="black")
        axes.plot(x[0], y[0], "o", color="white", markeredgecolor="black", markersize=7)
        axes.set_aspect("equal", adjustable="datalim")
        axes.set(xlabel="x [m]", ylabel="y [m]")
        axes.grid(visible=True)
        handles = [Line2D([], [], color=colours[name], linewidth=2.2) for name in present]
        handles += [
            Line2D([], [], marker=mark, color="none", markeredgecolor=edge, markerfacecolor=face)
            for mark, edge, face in (
                (".", MEASURED_COLOUR, MEASURED_COLOUR),
                ("o", "black", "white"),
                ("D", "black", "white"),
            )
        ]
        words = [*present, "measured", "start", "true mode changes"]
        legend = figure.legend(
            handles, words, loc="center left", bbox_to_anchor=(0.68, 0.5), frameon=False
        )
        for text in legend.get_texts():
            text.set_parse_math(False)

    return Picture(
        save_figure(folder / "path.png", (WIDTH_IN, 4.6), draw),
        "The estimated path, coloured by the answer.",
        "The path as estimated, in the colour of the answer at each moment.",
    )


def _strips(followed: Followed) -> dict[str, AnyArray]:
    strips = {}
    if (followed.motion.labels != UNKNOWN).any():
        strips["true"] = followed.motion.labels
    if followed.seen:
        strips["camera"] = followed.seen_labels
    answers = {ANSWERS[name]: followed.answers(track) for name, track in followed.tracks.items()}
    return strips | answers


def _panels(figure: Figure, heights: list[float], top: float, left: float) -> list[Axes]:
    """Axes below one another of given heights [in], on one axis of time."""
    height_in = figure.get_figheight()
    panels: list[Axes] = []
    y_in = height_in - top
    for own in heights:
        y_in -= own
        box = (left, y_in / height_in, 0.97 - left, own / height_in)
        panels.append(figure.add_axes(box, sharex=panels[0] if panels else None))
        panels[-1].tick_params(labelbottom=False)
        y_in -= GAP_IN
    return panels


def _draw_velocity(panels: list[Axes], followed: Followed) -> None:
    track, signals = followed.last_track, followed.signals
    wheels = signals.tread_speeds_m_s.mean(axis=1)
    speed, rate = panels
    estimates = list(zip(track.means.T, track.sigmas.T, strict=True))
    draw_state(speed, track.stamps_s, estimates[0], signals.measured[:, 0], wheels)
    draw_state(rate, track.stamps_s, estimates[1], signals.measured[:, 1])
    speed.set_ylabel("V [m/s]")
    rate.set_ylabel("omega [rad/s]")
    speed.legend(
        loc="lower right",
        bbox_to_anchor=(1.0, 0.97),
        ncols=4,
        frameon=False,
        fontsize=8.5,
        borderaxespad=0.0,
    )


def _legend(figure: Figure, lines: Sequence[Line2D], names: Sequence[str]) -> None:
    """Colour and dashes of each mode, where they are few; rows of many bear their names."""
    hatched = [
        Patch(facecolor="white", edgecolor=EDGES[name], hatch=HATCHES[name], linewidth=0.0)
        for name in NO_MODES
    ]
    legend = figure.legend(
        [*lines, *hatched],
        [*names[: len(lines)], *NO_MODES],
        loc="upper center",
        ncols=COLUMNS,
        frameon=False,
        fontsize=9,
        borderaxespad=0.2,
        handlelength=2.6,
    )
    for text in legend.get_texts():
        text.set_parse_math(False)


def _caption(followed: Followed, *, with_states: bool) -> str:
    sure = f"{100 * followed.config.sure:.0f} %"
    said = "Dashed: where the true mode changes. "
    if len(followed.mode_set.names) > MOST_LINES:
        said += "Dark: probable; framed: the true mode. "
    said += f"A mode is the answer from a probability of {sure} on, where it fits."
    return said + (" V and omega: the estimate over all modes." if with_states else "")
