"""ICRs and errors, each figure drawn on given axes; names are never read as formulas."""

from collections.abc import Mapping, Sequence
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from odometry.arrays import FloatArray
from odometry.evaluation.stretches import Stretch
from odometry.report.drawing.figure import LineStyle
from odometry.report.drawing.labels import draw_line, label_points, last_point, thinned

LOGARITHMIC_FROM = 8.0  # times the smallest median
SHOWN_BELOW = 100.0  # parts of the smallest median, down to which whiskers are drawn
MANY_TICKS_FROM = 100.0  # times the left end of a logarithmic axis


def plot_icr(
    axes: Axes,
    name: str,
    estimates: Mapping[str, tuple[FloatArray, FloatArray, FloatArray]],
    truth: tuple[FloatArray, FloatArray] | None,
    styles: Mapping[str, LineStyle],
) -> None:
    """Draw one ICR coordinate over time, as in Fig. 9 of Chen 2023, with bands of 2 sigma.

    Parameters
    ----------
    axes : Axes
        At its final place in the figure.
    name : str
        Of the coordinate.
    estimates : Mapping of name to (stamps_s, values, sigmas), each (N,)
        Seconds and metres. The limits follow the values: the first bands may be very broad.
    truth : (stamps_s, values) or None
        Drawn dashed.
    styles : Mapping of name to LineStyle
        With one for "truth".
    """
    for label, (stamps_s, values, sigmas) in estimates.items():
        style = styles[label]
        at_s, below, above = thinned(stamps_s, values - 2 * sigmas, values + 2 * sigmas)
        axes.fill_between(at_s, below, above, color=style.colour, alpha=0.16, linewidth=0)
        draw_line(axes, stamps_s, values, label, style)
    lines = {label: (stamps_s, values) for label, (stamps_s, values, _) in estimates.items()}
    if truth is not None:
        lines["truth"] = truth
        axes.plot(
            *thinned(*truth), color=styles["truth"].colour, linestyle=(0, (4, 2)), label="truth"
        )
    values = np.concatenate([line[1] for line in lines.values()])
    low, high = float(np.min(values)), float(np.max(values))
    room = max(0.25 * (high - low), 0.01)
    axes.set_ylim(low - room, high + room)
    axes.set_ylabel(f"{name} [m]")
    axes.yaxis.set_major_locator(MaxNLocator(5))
    axes.grid(visible=True, axis="y")
    label_points(axes, {label: last_point(*line) for label, line in lines.items()}, styles)


def mark_changes(axes: Axes, stretches: Sequence[Stretch], *, names: bool = False) -> None:
    """Draw a vertical line where the terrain in force changes.

    Parameters
    ----------
    axes : Axes
        With time on the x axis.
    stretches : sequence of Stretch
        Of the terrain in force.
    names : bool
        Write the name of each terrain above the axes, where its stretch has room for it; the axes
        have their limits.
    """
    for stretch in stretches[1:]:
        axes.axvline(stretch.start_s, color="#777777", linewidth=0.9, linestyle="dotted", zorder=1)
    axes.get_xlim()  # brings the transform up to date
    for stretch in stretches if names else ():
        name = axes.annotate(
            stretch.terrain,
            (stretch.start_s, 1.0),
            (2.0, 3.0),
            xycoords=axes.get_xaxis_transform(),
            textcoords="offset points",
            fontsize=9,
            color="#444444",
            annotation_clip=False,
            parse_math=False,
        )
        ends_px = axes.transData.transform((stretch.end_s, 0.0))[0]
        if stretch is not stretches[-1] and name.get_window_extent().x1 > ends_px:
            name.remove()


def plot_position_errors(
    axes: Axes,
    errors: Mapping[str, tuple[FloatArray, FloatArray]],
    styles: Mapping[str, LineStyle],
) -> None:
    """Draw the distance from the reference over time, as in Fig. 8(b) of Chen 2023.

    Parameters
    ----------
    axes : Axes
        At its final place in the figure.
    errors : Mapping of name to (stamps_s, distances_m)
    styles : Mapping of name to LineStyle
    """
    for name, (stamps_s, distances_m) in errors.items():
        draw_line(axes, stamps_s, distances_m, name, styles[name])
    axes.margins(x=0.0)
    axes.set_ylim(bottom=0.0)
    axes.grid(visible=True, axis="y")
    axes.set(xlabel="time [s]", ylabel="position error [m]")
    label_points(axes, {name: last_point(*line) for name, line in errors.items()}, styles)


def plot_error_distribution(
    axes: Axes, errors: Mapping[str, FloatArray], styles: Mapping[str, LineStyle], unit: str
) -> None:
    """Draw the errors of all horizons as boxes: quartiles, whiskers from 5 to 95 %, the mean.

    Parameters
    ----------
    axes : Axes
    errors : Mapping of name to (K,)
        In `unit`; names without an error are left out.
    styles : Mapping of name to LineStyle
    unit : str
        Written below the axis, which is logarithmic where medians differ so much that the small
        ones could not be compared; an arrow at its left end is a whisker that goes on.
    """
    shown = {name: values for name, values in errors.items() if len(values)}
    for place, (name, values) in enumerate(shown.items()):
        colour = styles[name].colour
        axes.boxplot(
            values,
            positions=[place],
            orientation="horizontal",
            widths=0.5,
            whis=(5, 95),
            showfliers=False,
            showmeans=True,
            patch_artist=True,
            boxprops={"facecolor": colour, "alpha": 0.35, "edgecolor": colour},
            medianprops={"color": colour, "linewidth": 2.0},
            whiskerprops={"color": colour},
            capprops={"color": colour},
            meanprops={"marker": "D", "markerfacecolor": "white", "markeredgecolor": colour},
            manage_ticks=False,
        )
    axes.set_yticks(range(len(shown)), [fill(name, 25) for name in shown], parse_math=False)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.grid(visible=True, axis="x")
    medians = [float(np.median(values)) for values in shown.values()]
    if medians and max(medians) > LOGARITHMIC_FROM * min(medians) > 0:
        lowest = [float(np.quantile(values, 0.05)) for values in shown.values()]
        shown_from = max(0.8 * min(lowest), min(medians) / SHOWN_BELOW)
        axes.set_xscale("log")
        axes.set_xlim(left=shown_from)
        for place, (name, low) in enumerate(zip(shown, lowest, strict=True)):
            if low < shown_from:
                beside = axes.get_yaxis_transform()
                axes.plot(
                    0.0, place, "<", color=styles[name].colour, transform=beside, clip_on=False
                )
        least, most = axes.get_xlim()
        steps = (1.0, 2.0, 5.0) if most < MANY_TICKS_FROM * least else (1.0,)
        axes.xaxis.set_major_locator(LogLocator(subs=steps))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.xaxis.set_minor_locator(LogLocator(subs=range(2, 10)))
        axes.xaxis.set_minor_formatter(NullFormatter())
        unit += "\n(logarithmic)"
    else:
        axes.set_xlim(left=0.0)
    axes.set_xlabel(unit)
