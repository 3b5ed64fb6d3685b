"""What is left of each signal where the nearest mode is taken, over time, with its bounds."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from odometry.arrays import FloatArray
from odometry.modes.followed import Followed
from odometry.modes.misfits import BOUND
from odometry.modes.words import SIGNALS
from odometry.report.figure import save_figure
from odometry.report.html import Picture
from odometry.report.mode_panels import STATE_COLOUR, drawn_rows

WIDTH_IN, PANEL_IN, AROUND_IN = 7.0, 1.15, 0.9
MOST = 10.0  # standard deviations that are drawn
MISFIT_COLOUR = "#D55E00"


def innovations_picture(followed: Followed, folder: Path) -> Picture | None:
    """A panel for each signal that was measured; None where nothing was tested."""
    track = followed.motion
    if track.fit is None:
        return None
    panels = _by_signal(followed, track.fit.best)
    if not panels:
        return None

    def draw(figure: Figure) -> None:
        every = np.ravel(figure.subplots(len(panels), 1, sharex=True))
        rows = drawn_rows(len(track.stamps_s))
        for axes, (name, left) in zip(every, panels.items(), strict=True):
            axes.axhspan(-BOUND, BOUND, color=STATE_COLOUR, alpha=0.15, linewidth=0)
            for one in followed.misfits:
                axes.axvspan(one.from_s, one.to_s, color=MISFIT_COLOUR, alpha=0.15, linewidth=0)
            shown = np.clip(left[rows], -MOST, MOST)
            axes.plot(track.stamps_s[rows], shown, color=STATE_COLOUR, linewidth=0.8)
            axes.set(ylim=(-1.1 * MOST, 1.1 * MOST), yticks=(-MOST, 0.0, MOST))
            axes.set_title(name, loc="left", pad=3.0, fontsize=9)
            axes.grid(visible=True, axis="y")
        every[-1].set(xlim=track.stamps_s[[0, -1]].tolist(), xlabel="time [s]")
        figure.supylabel("standard deviations", fontsize=9)
        figure.tight_layout()

    height_in = PANEL_IN * len(panels) + AROUND_IN
    return Picture(
        save_figure(folder / "innovations.png", (WIDTH_IN, height_in), draw),
        "What is left of each signal over time, in standard deviations, with bounds.",
        "What is left of each signal over half a second where the nearest mode is taken, in the "
        f"standard deviations that it has where that mode is true; at most {MOST:g} are drawn. "
        f"Blue band: {BOUND:g} of them, within which 95 % lie then. Orange: none of these.",
    )


def _by_signal(followed: Followed, best: FloatArray) -> dict[str, FloatArray]:
    """Lines (N, k) of each signal of which something was measured."""
    names = SIGNALS[followed.mode_set.modes.kind]
    found = {}
    for name in dict.fromkeys(names):
        columns = best[:, [place for place, own in enumerate(names) if own == name]]
        if np.isfinite(columns).any():
            found[name] = columns
    return found
