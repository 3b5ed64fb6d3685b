"""Paths over terrain, drawn on given axes; names are never read as formulas."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.ticker import MaxNLocator

from odometry.evaluation.stretches import Stretch
from odometry.report.drawing.figure import LineStyle
from odometry.report.drawing.labels import (
    HALO,
    broken_at_outages,
    draw_line,
    label_points,
    last_point,
    thinned,
)
from odometry.trajectory import Trajectory


def plot_ground(
    axes: Axes, path: Trajectory, stretches: Sequence[Stretch], tints: Mapping[str, str]
) -> None:
    """Draw the terrain along a path as a broad band; the longest stretch of each is named.

    The band breaks where the path has no pose for long.

    Parameters
    ----------
    axes : Axes
        With the paths, which lie above the band and set the limits.
    path : Trajectory
    stretches : sequence of Stretch
    tints : Mapping of terrain to colour
    """
    stamps_s, places = broken_at_outages(path.stamps_s, path.poses[:, :2])
    longest = {s.terrain: s for s in sorted(stretches, key=lambda s: s.end_s - s.start_s)}
    for stretch in stretches:
        points = places[(stamps_s >= stretch.start_s) & (stamps_s <= stretch.end_s)]
        known = points[np.isfinite(points).all(axis=1)]
        if not len(known):
            continue
        colour = tints[stretch.terrain]
        band = LineCollection(
            [np.column_stack(thinned(*points.T))],
            colors=[colour],
            linewidths=15.0,
            capstyle="butt",
            zorder=0.5,
        )
        axes.add_collection(band, autolim=False)
        if stretch is longest[stretch.terrain]:
            middle = (float(known[len(known) // 2, 0]), float(known[len(known) // 2, 1]))
            axes.annotate(
                stretch.terrain,
                middle,
                (0.0, 17.0 * _emptier_side(axes, middle)),
                textcoords="offset points",
                ha="center",
                va="center",
                bbox={"boxstyle": "round,pad=0.2", "facecolor": colour, "edgecolor": "none"},
                fontsize=9,
                parse_math=False,
            )


def plot_paths(
    axes: Axes, paths: Mapping[str, Trajectory], styles: Mapping[str, LineStyle]
) -> None:
    """Draw paths of equal scale along x and y, each named at its end.

    Parameters
    ----------
    axes : Axes
        At its final place in the figure.
    paths : Mapping of name to Trajectory
        A line breaks where its poses are NaN.
    styles : Mapping of name to LineStyle
    """
    for name, path in paths.items():
        draw_line(axes, path.poses[:, 0], path.poses[:, 1], name, styles[name])
    first = next(iter(paths.values()))
    start = (float(first.poses[0, 0]), float(first.poses[0, 1]))
    axes.plot(*start, "o", color="black", markersize=4.5)
    axes.annotate(
        "start",
        start,
        (0.0, 8.0),
        textcoords="offset points",
        ha="center",
        fontsize=9,
        path_effects=HALO,
    )
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)
    axes.grid(visible=True)
    axes.yaxis.set_major_locator(MaxNLocator(6, integer=True))
    axes.set(xlabel="x [m]", ylabel="y [m]")
    label_points(
        axes, {n: last_point(p.poses[:, 0], p.poses[:, 1]) for n, p in paths.items()}, styles
    )


def _emptier_side(axes: Axes, place: tuple[float, float]) -> int:
    """1 if fewer points of lines lie just above a place than just below it, else -1."""
    points_per_pixel = 72.0 / axes.figure.dpi
    drawn = np.concatenate([axes.transData.transform(line.get_xydata()) for line in axes.lines])
    aside, above = ((drawn - axes.transData.transform(place)) * points_per_pixel).T
    near = (np.abs(aside) < 25.0) & (np.abs(above) < 40.0)
    return 1 if np.sum(near & (above > 8.0)) <= np.sum(near & (above < -8.0)) else -1
