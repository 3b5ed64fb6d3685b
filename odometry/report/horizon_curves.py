"""Errors against the horizon over which they are taken."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator

from odometry.arrays import FloatArray
from odometry.report.labels import draw_line
from odometry.report.palette import LineStyle


def plot_against_horizon(
    axes: Axes,
    curves: Mapping[str, tuple[FloatArray, FloatArray]],
    styles: Mapping[str, LineStyle],
) -> None:
    """Draw one statistic of the errors over evaluation horizons, as in Baril 2020 Fig. 4.

    Parameters
    ----------
    axes : Axes
        Both axes become logarithmic.
    curves : Mapping of name to (horizons_m, values)
        (H,) each.
    styles : Mapping of name to LineStyle
    """
    for name, (horizons_m, values) in curves.items():
        draw_line(axes, horizons_m, values, name, styles[name])
        axes.plot(horizons_m, values, "o", color=styles[name].colour, markersize=3)
    axes.set_xscale("log")
    axes.set_yscale("log")
    ticks = sorted({float(h) for horizons_m, _ in curves.values() for h in np.asarray(horizons_m)})
    axes.xaxis.set_major_locator(FixedLocator(ticks))
    axes.xaxis.set_minor_locator(NullLocator())
    plain = FuncFormatter(lambda value, _: f"{value:g}")
    axes.xaxis.set_major_formatter(plain)
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(plain)
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.grid(visible=True, axis="y")
