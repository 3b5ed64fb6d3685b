"""Distributions of errors over several orders of magnitude, one row a model."""

from collections.abc import Mapping
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from scipy.stats import gaussian_kde

from odometry.arrays import FloatArray
from odometry.report.palette import LineStyle

FLOOR = 1e-3  # of the largest error; smaller ones are drawn there
HALF_HEIGHT = 0.42  # of a violin, in rows
POINTS = 200  # of a curve
MANY = 100.0  # ratio of the ends of an axis from which only powers of ten are named
ONLY_DOTS = 5  # errors for which no curve is drawn


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
