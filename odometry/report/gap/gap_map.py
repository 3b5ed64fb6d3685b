"""The gap over the two variables that predict it most, before and after."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.gap.answer.result import GapResult
from odometry.gap.locate.region_words import noun_of, shown_unit
from odometry.gap.locate.variables import LABEL, Variable, window_variables
from odometry.gap.prepare.statistic import squared_errors
from odometry.report.drawing.figure import save_figure
from odometry.report.drawing.html import Picture

WIDTH_IN, HEIGHT_IN = 7.0, 3.3
BINS = 7
TAILS = 0.02  # of the windows on either side go into the outer bins


@dataclass(frozen=True)
class Scale:
    """One axis of a map: bins of a variable.

    Attributes
    ----------
    title : str
    edges : (B + 1,)
    bins : (K,)
        That each window falls in.
    labels : tuple of str
        Of each bin, where the variable is one of names.
    """

    title: str
    edges: FloatArray
    bins: IntArray
    labels: tuple[str, ...] = ()


def scale_of(variable: Variable) -> Scale:
    """Equal bins of a number or an angle, or one for each label."""
    title = noun_of(variable.name)
    if variable.kind == LABEL:
        names, bins = np.unique(variable.values, return_inverse=True)
        edges = np.arange(len(names) + 1, dtype=np.float64) - 0.5
        return Scale(title, edges, bins.astype(np.int64), tuple(str(name) for name in names))
    unit, factor = shown_unit(variable.name)
    values = factor * variable.values
    low, high = np.quantile(values, [TAILS, 1 - TAILS])
    if high <= low:
        low, high = float(values.min()), float(values.max())
    edges = np.linspace(float(low), float(high), BINS + 1, dtype=np.float64)
    bins = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, BINS - 1)
    return Scale(f"{title} [{unit}]" if unit else title, edges, bins.astype(np.int64))


def binned_rms(squares: FloatArray, across: Scale, up: Scale) -> FloatArray:
    """Root mean squares (B up, B across) of squares (K,); NaN where no window falls."""
    shape = (len(up.edges) - 1, len(across.edges) - 1)
    places = np.ravel_multi_index((up.bins, across.bins), shape)
    size = shape[0] * shape[1]
    counts = np.bincount(places, minlength=size)
    sums = np.bincount(places, weights=squares, minlength=size)
    means = np.where(counts > 0, sums / np.maximum(counts, 1), np.nan)
    return np.asarray(np.sqrt(means).reshape(shape))


def map_picture(result: GapResult, folder: Path) -> Picture | None:
    """Residual maps on what was held out; None where two variables did not vary there."""
    base, scenes = result.calibration.base, result.holdout_scenes
    varied = {v.name: v for v in window_variables(base, (), scenes)}
    chosen = [varied[name] for name in result.location.strongest if name in varied]
    if len(chosen) < 2:
        return None
    across, up = scale_of(chosen[0]), scale_of(chosen[1])
    maps = {
        name: binned_rms(
            np.concatenate([squared_errors(model, added, scene) for scene in scenes]), across, up
        )
        for name, (model, added) in result.stages.items()
    }
    floor_m = result.holdout.noise_floor.value
    highest = max(float(np.nanmax(of)) for of in maps.values())
    norm = LogNorm(floor_m / 2, max(2 * floor_m, highest), clip=True)

    def draw(figure: Figure) -> None:
        for number, (name, values) in enumerate(maps.items()):
            axes = figure.add_axes((0.11 + 0.4 * number, 0.17, 0.36, 0.7))
            mesh = _draw_map(axes, values, across, up, norm)
            axes.set_title(name, loc="left")
            axes.set_ylabel("" if number else up.title)
            axes.tick_params(labelleft=not number)
        bar = figure.add_axes((0.89, 0.17, 0.018, 0.7))
        figure.colorbar(mesh, cax=bar)
        bar.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        bar.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        bar.yaxis.set_minor_formatter(NullFormatter())
        bar.set_title("RMS [m]", fontsize=9, loc="left", pad=6)

    return Picture(
        save_figure(folder / "gap_map.png", (WIDTH_IN, HEIGHT_IN), draw),
        f"RMS gap over {chosen[0].name} and {chosen[1].name}: {', '.join(maps)}.",
        f"The gap on held-out data over two variables, {' and '.join(maps)}, with one logarithmic "
        "scale of colours from half the noise floor up; white where there was no window. "
        + _said(result, chosen),
    )


def _said(result: GapResult, chosen: Sequence[Variable]) -> str:
    """Which of the variables of the map predict the gap."""
    discovered = {one.name for one in result.location.predictors if one.discovered}
    known = [noun_of(one.name) for one in chosen if one.name in discovered]
    if not known:
        return "Neither predicts it beyond chance."
    others = "" if len(known) > 1 else " alone"
    return f"Beyond chance it is predicted by {' and '.join(known)}{others}."


def _draw_map(axes: Axes, values: FloatArray, across: Scale, up: Scale, norm: LogNorm) -> QuadMesh:
    shown: AnyArray = np.ma.masked_invalid(values)
    mesh = axes.pcolormesh(across.edges, up.edges, shown, norm=norm, cmap="cividis")
    axes.set_xlabel(across.title)
    axes.xaxis.set_major_locator(MaxNLocator(5, prune="both"))
    axes.yaxis.set_major_locator(MaxNLocator(5, prune="both"))
    if across.labels:
        axes.set_xticks(range(len(across.labels)), across.labels, parse_math=False)
    if up.labels:
        axes.set_yticks(range(len(up.labels)), up.labels, parse_math=False)
    return mesh
