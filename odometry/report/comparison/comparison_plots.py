"""Plots of the comparison page, each drawn on given axes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator
from scipy.stats import gaussian_kde

from odometry.arrays import FloatArray
from odometry.report.drawing.figure import LineStyle
from odometry.report.drawing.labels import draw_line

FLOOR = 1e-3  # of the largest error; smaller ones are drawn there
HALF_HEIGHT = 0.42  # of a violin, in rows
POINTS = 200  # of a curve
MANY = 100.0  # ratio of the ends of an axis from which only powers of ten are named
ONLY_DOTS = 5  # errors for which no curve is drawn
BINS = 16
LEAST_WINDOWS = 4  # of a bin whose quartiles are drawn


def plot_violins(
    axes: Axes, errors: Mapping[str, FloatArray], styles: Mapping[str, LineStyle], unit: str
) -> None:
    """Draw distributions with medians and quartile boxes, as in Baril 2020 Fig. 5 and 6.

    Parameters
    ----------
    axes : Axes
        Gets a logarithmic x axis: the ideal model may err a hundred times more than the best.
    errors : Mapping of name to (K,)
        In `unit`, not negative. The curve is a kernel density of their logarithms.
    styles : Mapping of name to LineStyle
    unit : str
        Written below the axis.
    """
    shown = {name: np.asarray(values) for name, values in errors.items() if len(values)}
    largest = max((values.max() for values in shown.values()), default=0.0) or 1.0
    for row, (name, values) in enumerate(shown.items()):
        logs = np.log10(np.maximum(values, FLOOR * largest))
        colour = styles[name].colour
        _draw_curve(axes, row, logs, colour)
        low, middle, high = np.percentile(values, [25, 50, 75])
        axes.barh(
            row, high - low, left=low, height=0.24, facecolor="#BBBBBB", edgecolor=colour, zorder=3
        )
        axes.plot([middle, middle], [row - 0.2, row + 0.2], color="black", linewidth=2, zorder=4)
    axes.set_xscale("log")
    axes.set_yticks(range(len(shown)), [fill(name, 25) for name in shown], parse_math=False)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.grid(visible=True, axis="x")
    axes.set_xlabel(unit)
    low, high = axes.get_xlim()
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 3.0) if high < MANY * low else (1.0,)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _draw_curve(axes: Axes, row: int, logs: FloatArray, colour: str) -> None:
    if len(logs) < ONLY_DOTS or np.ptp(logs) < 1e-9:
        axes.plot(10**logs, np.full(len(logs), row), ".", color=colour, zorder=2)
        return
    places = np.linspace(logs.min(), logs.max(), POINTS)
    density = gaussian_kde(logs)(places)
    height = HALF_HEIGHT * density / density.max()
    axes.fill_between(
        10**places, row - height, row + height, facecolor=colour, alpha=0.45, edgecolor=colour
    )


def plot_against_horizon(
    axes: Axes,
    curves: Mapping[str, tuple[FloatArray, FloatArray]],
    styles: Mapping[str, LineStyle],
) -> None:
    """Draw one statistic of the errors over evaluation horizons, as in Baril 2020 Fig. 4.

    Parameters
    ----------
    axes : Axes
        Both axes become logarithmic, that of values where one is above zero.
    curves : Mapping of name to (horizons_m, values)
        (H,) each.
    styles : Mapping of name to LineStyle
    """
    for name, (horizons_m, values) in curves.items():
        draw_line(axes, horizons_m, values, name, styles[name])
        axes.plot(horizons_m, values, "o", color=styles[name].colour, markersize=3)
    axes.set_xscale("log")
    if any((np.asarray(values) > 0).any() for _, values in curves.values()):
        axes.set_yscale("log")
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    ticks = sorted({float(h) for horizons_m, _ in curves.values() for h in np.asarray(horizons_m)})
    axes.xaxis.set_major_locator(FixedLocator(ticks))
    axes.xaxis.set_minor_locator(NullLocator())
    plain = FuncFormatter(lambda value, _: f"{value:g}")
    axes.xaxis.set_major_formatter(plain)
    axes.yaxis.set_major_formatter(plain)
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.grid(visible=True, axis="y")


@dataclass(frozen=True)
class CommandedRotation:
    """Measured turns by commanded difference, bins of enough windows in order.

    Attributes
    ----------
    differences_m_s : (B,)
        Mean v_right - v_left of the windows of each bin.
    quartiles_deg_per_m : (B, 3)
    """

    differences_m_s: FloatArray
    quartiles_deg_per_m: FloatArray


def commanded_rotation(
    differences_m_s: FloatArray, turns_deg_per_m: FloatArray, edges_m_s: FloatArray
) -> CommandedRotation:
    """Quartiles of turns (K,) over bins of the commanded difference (K,)."""
    bins = np.digitize(differences_m_s, edges_m_s)
    kept = [b for b in range(1, len(edges_m_s)) if np.sum(bins == b) >= LEAST_WINDOWS]
    return CommandedRotation(
        np.array([differences_m_s[bins == b].mean() for b in kept]),
        np.array([np.percentile(turns_deg_per_m[bins == b], [25, 50, 75]) for b in kept]).reshape(
            -1, 3
        ),
    )


def difference_edges(differences_m_s: FloatArray) -> FloatArray:
    """Edges of `BINS` equal bins that hold all differences (K,)."""
    low, high = float(differences_m_s.min()), float(differences_m_s.max())
    return np.linspace(low - 1e-6, high + 1e-6, BINS + 1)


def plot_commanded_rotation(
    axes: Axes, found: CommandedRotation, others: Sequence[CommandedRotation], style: LineStyle
) -> None:
    """Draw the median with a band from quartile to quartile, as in Baril 2020 Fig. 7.

    Parameters
    ----------
    axes : Axes
    found : CommandedRotation
        On one terrain.
    others : sequence of CommandedRotation
        On other terrains: their medians are thin grey lines.
    style : LineStyle
    """
    for other in others:
        medians = other.quartiles_deg_per_m[:, 1]
        axes.plot(other.differences_m_s, medians, color="#BBBBBB", linewidth=0.9, zorder=1)
    low, middle, high = found.quartiles_deg_per_m.T
    axes.fill_between(found.differences_m_s, low, high, color=style.colour, alpha=0.25, linewidth=0)
    axes.plot(found.differences_m_s, middle, ".-", color=style.colour, linewidth=1.8)
    axes.axhline(0.0, color="#999999", linewidth=0.7, zorder=0.5)
    axes.axvline(0.0, color="#999999", linewidth=0.7, zorder=0.5)
    axes.grid(visible=True)
