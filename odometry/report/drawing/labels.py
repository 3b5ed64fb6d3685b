"""Lines of figures: labels beside them, fewer points where none is lost, nothing over outages."""

from collections.abc import Mapping
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from scipy.optimize import isotonic_regression

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.estimation.watches.pose_watch import OUTAGE_PERIODS, OUTAGE_S
from odometry.report.drawing.figure import LineStyle

LONG = 20_000  # points; shorter lines are drawn as they are
PARTS = 2500  # more than twice the pixels of a page's width


def thinned(*columns: FloatArray) -> tuple[FloatArray, ...]:
    """Columns (N,) of a line with the rows that it needs at the size of a page."""
    if len(columns[0]) <= LONG:
        return columns
    rows = thinned_rows(*columns)
    return tuple(column[rows] for column in columns)


def thinned_rows(*columns: FloatArray) -> slice | IntArray:
    """Rows of a line that it needs at the size of a page; all of a line of up to LONG.

    Of each of PARTS parts of a long line the first row stays, and the rows of the least and the
    greatest value of each column; the last row stays, and a break (NaN) in each part that has one.

    Parameters
    ----------
    columns : (N,) each
        Rising stamps, or the coordinates of places; NaN breaks the line.
    """
    count = len(columns[0])
    if count <= LONG:
        return slice(None)
    width = -(-count // PARTS)
    starts = np.arange(0, count, width)
    rows = [starts, np.array([count - 1])]
    for column in columns:
        padded = np.pad(column, (0, len(starts) * width - count), mode="edge")
        parts = padded.reshape(-1, width)
        broken = np.isnan(parts)
        least = np.where(broken, np.inf, parts).argmin(axis=1)
        greatest = np.where(broken, -np.inf, parts).argmax(axis=1)
        rows += [starts + of for of in (least, greatest, broken.argmax(axis=1))]
    return np.unique(np.minimum(np.concatenate(rows), count - 1))


def broken_at_outages(stamps_s: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Measured values with a row of NaN in the middle of each outage, where a line breaks.

    An outage is what the filter takes for one: longer than 2 s and than 10 usual periods.

    Parameters
    ----------
    stamps_s : (N,)
        Rising.
    values : (N,) or (N, K)

    Returns
    -------
    stamps_s : (N + outages,)
    values : (N + outages,) or (N + outages, K)
    """
    if len(stamps_s) < 2:
        return stamps_s, values
    longest_s = max(OUTAGE_S, OUTAGE_PERIODS * float(np.median(np.diff(stamps_s))))
    return broken_beyond(longest_s, stamps_s, values)


def broken_beyond(
    longest_s: float, stamps_s: FloatArray, values: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Rising stamps (N,) and values with a row of NaN in each gap that lasts longer."""
    rows = np.flatnonzero(np.diff(stamps_s) > longest_s) + 1
    middles_s = (stamps_s[rows - 1] + stamps_s[rows]) / 2
    return np.insert(stamps_s, rows, middles_s), np.insert(values, rows, np.nan, axis=0)


HALO = (withStroke(linewidth=2.5, foreground="white"),)
_LINE_PT = 12.0
_ASIDE_PT = 9.0
_LETTERS = 25  # of a line of a label
_WIDEST_PT = 5.0 * _LETTERS


def draw_line(axes: Axes, x: FloatArray, y: FloatArray, name: str, style: LineStyle) -> None:
    """Draw a line (N,) in its style; `name` is its label in matplotlib's sense."""
    axes.plot(
        *thinned(x, y),
        color=style.colour,
        linestyle=style.dashes,
        linewidth=style.width_pt,
        label=name,
    )


def last_point(x: FloatArray, y: FloatArray) -> tuple[float, float]:
    """Where a line ends."""
    return float(x[-1]), float(y[-1])


def spread(positions: FloatArray, heights: FloatArray, low: float = -np.inf) -> FloatArray:
    """Move labels as little as possible, in least squares, so that none overlap.

    Parameters
    ----------
    positions, heights : (N,)
        Middles and heights of the labels, in one unit.
    low : float
        No label reaches below.

    Returns
    -------
    (N,)
        New middles, in the order given; the order from low to high is kept: what is left of a
        position after the labels below it have been stacked must not decrease.
    """
    order = np.argsort(positions, kind="stable")
    sorted_heights = heights[order]
    stacked = np.cumsum(sorted_heights) - sorted_heights / 2
    placed = np.empty(len(positions))
    placed[order] = np.maximum(isotonic_regression(positions[order] - stacked).x, low) + stacked
    return placed


def label_points(
    axes: Axes, points: Mapping[str, tuple[float, float]], styles: Mapping[str, LineStyle]
) -> None:
    """Write each name to the right of its point, in the colour of its line.

    Parameters
    ----------
    axes : Axes
        With its final limits and place in the figure.
    points : Mapping of name to (x, y)
        In data units; where they crowd, labels are moved up or down into one column to their
        right, and a thin line leads there. None is written below the axes, where the tick labels
        are. Points to the left or right of the axes have no label.
    styles : Mapping of name to LineStyle
    """
    left, right = sorted(axes.get_xlim())
    points = {name: point for name, point in points.items() if left <= point[0] <= right}
    if not points:
        return
    axes.apply_aspect()
    points_per_pixel = 72.0 / axes.figure.dpi
    places_pt = axes.transData.transform(list(points.values())) * points_per_pixel
    texts = [fill(name, _LETTERS) for name in points]
    sizes_pt = np.array([_LINE_PT * (text.count("\n") + 1) for text in texts])
    labels_pt = np.empty_like(places_pt)
    for beside in _beside(places_pt[:, 0]):
        x_pt, y_pt = places_pt[beside].T
        label_y_pt = spread(y_pt, sizes_pt[beside], axes.bbox.y0 * points_per_pixel)
        column_x_pt = np.where(_crowded(label_y_pt, sizes_pt[beside]), x_pt.max(), x_pt)
        labels_pt[beside] = np.column_stack([column_x_pt + _ASIDE_PT, label_y_pt])
    moves_pt = labels_pt - places_pt
    for (name, point), text, move_pt in zip(points.items(), texts, moves_pt, strict=True):
        colour = styles[name].colour
        axes.annotate(
            text,
            xy=point,
            xytext=tuple(move_pt),
            textcoords="offset points",
            va="center",
            color=colour,
            fontsize=9,
            path_effects=HALO,
            annotation_clip=False,
            parse_math=False,
            arrowprops={
                "arrowstyle": "-",
                "color": colour,
                "linewidth": 0.6,
                "relpos": (0.0, 0.5),  # from the left edge of the text, not from its middle
                "shrinkB": 0.0,
            },
        )


def _beside(x_pt: FloatArray) -> list[IntArray]:
    """Indices of points whose labels may touch, from left to right; the others are too far off."""
    order = np.argsort(x_pt, kind="stable")
    far = np.diff(x_pt[order]) > _WIDEST_PT
    return np.split(order, np.flatnonzero(far) + 1)


def _crowded(middles: FloatArray, heights: FloatArray) -> BoolArray:
    """Which labels (N,) touch another one, above or below."""
    apart = np.abs(np.subtract.outer(middles, middles))
    touch = apart < np.add.outer(heights, heights) / 2 + 1.0
    return np.asarray(touch.sum(axis=1) > 1)
