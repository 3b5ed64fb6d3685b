"""A figure of terrain by feel over time: answers as strips, and probabilities."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from odometry.arrays import AnyArray
from odometry.feel.follow import SILENT, Felt
from odometry.modes.mode_set import NONE_OF_THESE
from odometry.report.figure import save_figure
from odometry.report.html import Picture
from odometry.report.mode_panels import GREYS, draw_strips, drawn_rows
from odometry.report.palette import mode_colours
from odometry.run import UNKNOWN

WIDTH_IN, STRIP_IN, ROW_IN, HEAD_IN = 7.0, 0.26, 0.24, 1.0

ALT = "Answers and the probability of each terrain over time."
CAPTION = (
    "Answers by the last stretch and by single windows, the terrain that the run names, and the "
    "probability of each terrain by the last stretch (black is certain). Hatched: unlike every "
    "terrain of the model. Blank: undetermined, stationary or not measured."
)


def feel_picture(felt: Felt, folder: Path) -> Picture:
    """Write `feel.png`."""
    names = felt.model.names
    strips = {"answer": _shown(felt.lasting_answers), "by window": _shown(felt.answers)}
    if (felt.windows.labels != UNKNOWN).any():
        strips["named"] = felt.windows.labels
    height_in = HEAD_IN + STRIP_IN * len(strips) + ROW_IN * len(names)

    def draw(figure: Figure) -> None:
        top, lower = figure.subplots(
            2,
            sharex=True,
            gridspec_kw={"height_ratios": [STRIP_IN * len(strips), ROW_IN * len(names)]},
        )
        draw_strips(top, felt.stamps_s, strips, mode_colours(names))
        rows = drawn_rows(len(felt.stamps_s))
        edges = np.append(felt.stamps_s[rows] - felt.model.design.window_s, felt.stamps_s[-1])
        lower.pcolormesh(
            edges,
            np.arange(len(names) + 1) - 0.5,
            felt.lasting_probabilities[rows].T,
            cmap=GREYS,
            vmin=0.0,
            vmax=1.0,
            rasterized=True,
        )
        lower.set_yticks(range(len(names)), names, parse_math=False, fontsize=9)
        lower.tick_params(axis="y", length=0)
        lower.set_ylim(len(names) - 0.5, -0.5)
        for axis_label, colour in zip(
            lower.get_yticklabels(), mode_colours(names).values(), strict=True
        ):
            axis_label.set_color(colour)
        lower.set_xlim(edges[0], edges[-1])
        lower.set_xlabel("time [s]")
        figure.tight_layout()

    file = save_figure(folder / "feel.png", (WIDTH_IN, height_in), draw)
    return Picture(file, ALT, CAPTION)


def _shown(answers: AnyArray) -> AnyArray:
    """Answers (W,) for a strip: blank where nothing is said, hatched where nothing fits."""
    shown = np.where(answers == UNKNOWN, NONE_OF_THESE, answers)
    return np.where(np.isin(answers.astype(str), SILENT), UNKNOWN, shown)
