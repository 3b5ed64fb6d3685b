"""Figures of a gap: before and after, over time, and the evidence of the candidates."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from odometry.arrays import FloatArray
from odometry.gap.answer.result import GapResult
from odometry.gap.prepare.statistic import Gap, squared_errors
from odometry.gap.show.quantities import of_two_figures
from odometry.report.drawing.figure import LINE_STYLES, LineStyle, save_figure
from odometry.report.drawing.html import Picture
from odometry.report.drawing.labels import broken_beyond
from odometry.windows.dense.dense import DenseWindows

WIDTH_IN = 7.0
BEFORE, AFTER = LINE_STYLES[1], LINE_STYLES[0]
STAGES = {"before": BEFORE, "after": AFTER}
FLOOR = "#999999"
RUNS = 4  # that are drawn of each kind
ROOM = 1.15  # to the right of the last interval, for its number
ROLLING_S = 10.0
CANDIDATES = 14
LINEAR_TO = 10.0  # of evidence: from there on it is very strong


def closing_picture(result: GapResult, folder: Path) -> Picture:
    """The gap before and after with 95 % intervals, beside the noise floor."""
    measured, held_out = result.closings
    closings = {"held out": held_out, "measured": measured}
    measure = held_out.before.measure

    def draw(figure: Figure) -> None:
        axes = figure.add_axes((0.2, 0.24, 0.76, 0.68))
        floor = held_out.noise_floor
        axes.axvspan(floor.low, floor.high, color=FLOOR, alpha=0.3, linewidth=0)
        axes.axvline(floor.value, color=FLOOR, linewidth=1.2)
        labels = []
        for number, (name, closing) in enumerate(closings.items()):
            gaps = {"before": closing.before, "after": closing.after}
            for place, stage in enumerate(result.stages):
                row = number * (len(result.stages) + 0.4) + place
                _draw_gap(axes, row, gaps[stage], STAGES[stage])
                labels.append((row, f"{name}: {stage}"))
        axes.set_yticks([row for row, _ in labels], [label for _, label in labels])
        axes.set_ylim(labels[-1][0] + 0.6, -0.7)
        ends = [gap.high for c in closings.values() for gap in (c.before, c.after, c.noise_floor)]
        axes.set_xlim(0.0, ROOM * max(ends))
        axes.grid(visible=True, axis="x")
        axes.set_xlabel(f"RMS {measure.error} [{measure.unit}]")
        axes.annotate(
            "noise floor",
            (floor.value, 1.0),
            (0.0, 3.0),
            xycoords=axes.get_xaxis_transform(),
            textcoords="offset points",
            ha="center",
            fontsize=9,
            color="#555555",
        )

    stages = (
        "before and after the effects were added (and the model moved within what its calibration "
        "leaves open)"
        if result.effects
        else "of the model as calibrated (before) and moved within what its calibration leaves "
        "open (after); no effect was added"
    )
    return Picture(
        save_figure(folder / "gap_closing.png", (WIDTH_IN, 2.6), draw),
        "The gap before and after, with the noise floor.",
        f"RMS {measure.error} over windows of {result.horizon_s:g} s {stages}. Bars and grey band: "
        "95 % intervals by a bootstrap of pieces of the runs.",
    )


def time_picture(result: GapResult, folder: Path) -> Picture:
    """The gap over run time, one panel a run."""
    scenes = [("measured", s) for s in result.measured_scenes[:RUNS]]
    scenes += [("held out", s) for s in result.holdout_scenes[:RUNS]]
    height_in = 0.95 + 1.5 * len(scenes)

    def draw(figure: Figure) -> None:
        panels = figure.subplots(len(scenes), 1, squeeze=False)[:, 0]
        for axes, (kind, scene) in zip(panels, scenes, strict=True):
            _draw_over_time(axes, result, scene)
            axes.set_title(f"{kind}: {scene.run.name}", loc="left", parse_math=False)
        highest = max(axes.get_ylim()[1] for axes in panels)
        for axes in panels:
            axes.set_ylim(0.0, highest)
        panels[-1].set_xlabel("run time [s]")
        measure = result.closings[1].before.measure
        figure.supylabel(f"RMS {measure.error} [{measure.unit}]", fontsize=10)
        lines, names = panels[0].get_legend_handles_labels()
        figure.legend(lines, names, loc="lower left", ncols=3, frameon=False, fontsize=9)
        figure.subplots_adjust(
            left=0.12, right=0.98, bottom=0.8 / height_in, top=1 - 0.35 / height_in, hspace=0.55
        )

    return Picture(
        save_figure(folder / "gap_time.png", (WIDTH_IN, height_in), draw),
        "The gap over the time of each run, before and after.",
        f"The gap over run time: RMS over the windows within {ROLLING_S:g} s; grey: the noise "
        "floor.",
    )


def evidence_picture(result: GapResult, folder: Path) -> Picture | None:
    """The evidence of each candidate for the first effect; None without candidates."""
    finite = [rival for rival in result.rivals if np.isfinite(rival.evidence)]
    best = sorted(finite, key=lambda rival: -rival.evidence)
    rivals = [one for place, one in enumerate(best) if place < CANDIDATES or one.added]
    if not rivals:
        return None
    height_in = 0.8 + 0.27 * len(rivals)

    def draw(figure: Figure) -> None:
        axes = figure.add_axes((0.4, 0.5 / height_in, 0.5, 1 - 0.65 / height_in))
        for row, rival in enumerate(rivals):
            colour = AFTER.colour if rival.added else "#AAAAAA"
            axes.barh(row, rival.evidence, height=0.65, color=colour)
            axes.annotate(
                f"{round(rival.evidence)}",
                (max(rival.evidence, 0.0), row),
                (4.0, 0.0),
                textcoords="offset points",
                va="center",
                fontsize=8.5,
            )
        names = [f"{rival.name} ({rival.form_in_words})" for rival in rivals]
        axes.set_yticks(range(len(rivals)), names, parse_math=False, fontsize=9)
        axes.set_ylim(len(rivals) - 0.4, -0.6)
        axes.axvline(0.0, color="#555555", linewidth=0.8)
        axes.set_xscale("symlog", linthresh=LINEAR_TO)
        axes.grid(visible=True, axis="x")
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.set_xlabel("evidence (logarithmic beyond ten)")

    return Picture(
        save_figure(folder / "gap_evidence.png", (WIDTH_IN, height_in), draw),
        f"Evidence of the candidates {', '.join(rival.name for rival in rivals)}.",
        "Evidence of each candidate for the first effect: twice the log-likelihood gained on "
        "windows not fitted, less the penalty for its parameters."
        + (" Blue: added." if any(rival.added for rival in rivals) else " None of them was added."),
    )


def rolling_rms(time_s: FloatArray, squares: FloatArray, span_s: float) -> FloatArray:
    """Root mean square (K,) of squares (K,) at times within half a span of each time (K,)."""
    near = np.abs(time_s[:, None] - time_s) <= span_s / 2
    return np.asarray(np.sqrt(near @ squares / near.sum(axis=1)))


def _draw_gap(axes: Axes, row: float, gap: Gap, style: LineStyle) -> None:
    axes.plot([gap.low, gap.high], [row, row], color=style.colour, linewidth=2.2)
    axes.plot(gap.value, row, "o", color=style.colour, markersize=6)
    axes.annotate(
        of_two_figures(gap),
        (gap.high, row),
        (6.0, 0.0),
        textcoords="offset points",
        va="center",
        fontsize=9,
        color=style.colour,
    )


def _draw_over_time(axes: Axes, result: GapResult, scene: DenseWindows) -> None:
    floor = result.closings[1].noise_floor
    axes.axhspan(floor.low, floor.high, color=FLOOR, alpha=0.3, linewidth=0)
    axes.axhline(floor.value, color=FLOOR, linewidth=1.0, label="noise floor")
    for name, (base, effects) in result.stages.items():
        style = STAGES[name]
        squares = squared_errors(base, effects, scene, floor.measure)
        rms = rolling_rms(scene.start_s, squares, ROLLING_S)
        axes.plot(
            *broken_beyond(ROLLING_S / 2, scene.start_s, rms),
            marker=".",
            markersize=3,
            color=style.colour,
            linestyle=style.dashes,
            linewidth=1.6,
            label=name,
        )
    axes.set_ylim(bottom=0.0)
    axes.margins(x=0.0)
    axes.grid(visible=True, axis="y")
