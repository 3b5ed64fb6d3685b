"""Measured ICRs drawn over the robot, from above: x forward is up, y left is left."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Ellipse, Rectangle

from odometry.arrays import BoolArray, FloatArray
from odometry.icrs.measured import IcrMedian, MeasuredIcrs, icr_medians
from odometry.recording.run import Robot
from odometry.report.drawing.labels import HALO

TURN_STYLES: dict[str, dict[str, Any]] = {
    "left": {"color": "#0072B2", "marker": "o"},
    "right": {"color": "#D55E00", "marker": "s"},
}
FITTED_STYLE: dict[str, Any] = {
    "color": "black",
    "marker": "+",
    "linestyle": "",
    "markersize": 20,
    "markeredgewidth": 0.9,
}
_BODY, _TREAD = "#F1F1F1", "#C9C9C9"
_TREAD_WIDTHS, _TREAD_LENGTH = 0.16, 0.92  # as drawn: of the track width, of the length
_SHOWN = (5.0, 95.0)  # percentiles of the points that the limits hold
_MARGIN = 0.25  # of the track width, around what the limits must hold


@dataclass(frozen=True)
class Frame:
    """What a panel shows, in metres."""

    left: float
    right: float
    back: float
    front: float

    @property
    def height_by_width(self) -> float:
        """Of the panel, at equal scales."""
        return (self.front - self.back) / (self.left - self.right)

    def holds(self, icrs: FloatArray) -> BoolArray:
        """Whether both tread ICRs (K, 3) of each window lie inside."""
        y, x = icrs[:, :2], icrs[:, 2:]
        inside = (y >= self.right) & (y <= self.left) & (x >= self.back) & (x <= self.front)
        return np.asarray(inside.all(axis=1))


def frame_of(icrs: FloatArray, robot: Robot, fitted: FloatArray | None) -> Frame:
    """Room for the robot, for 90 % of the ICRs (K, 3) of each tread, and for those of a model."""
    half_length = (robot.length or robot.track_width) / 2
    half_width = max((1 + _TREAD_WIDTHS) * robot.track_width, robot.width or 0.0) / 2
    held = [np.array([[half_width, half_length], [-half_width, -half_length]])]
    for tread in ([0, 2], [1, 2]):
        if len(icrs):
            held.append(np.percentile(icrs[:, tread], _SHOWN, axis=0))
        if fitted is not None:
            held.append(fitted[None, tread])
    corners = np.concatenate(held)
    margin_m = _MARGIN * robot.track_width
    (right, back), (left, front) = corners.min(axis=0) - margin_m, corners.max(axis=0) + margin_m
    return Frame(float(left), float(right), float(back), float(front))


def plot_icrs(
    axes: Axes,
    measured: MeasuredIcrs,
    robot: Robot,
    fitted: FloatArray | None = None,
) -> Frame:
    """Draw the ICRs of both treads by the side of the turn, their medians and the robot.

    An ellipse holds the middle half of the points along and across; the bars of a median are its
    95 % interval. Both are left out where there are too few windows for an interval.

    Parameters
    ----------
    axes : Axes
        Gets equal scales; the horizontal one counts to the left.
    measured : MeasuredIcrs
        Of one terrain.
    robot : Robot
        Drawn as a body where its length and width are stated, as treads in any case.
    fitted : (3,) or None
        y_left, y_right, x_icr of a model.

    Returns
    -------
    Frame
        What the axes show.
    """
    _draw_robot(axes, robot)
    for side in TURN_STYLES:
        _draw_points(axes, measured.icrs[measured.side == side], side)
    for median in icr_medians(measured):
        if np.isfinite(median.low).all():
            _draw_median(axes, median, measured.icrs[measured.side == median.side])
    if fitted is not None:
        axes.plot(fitted[:2], np.full(2, fitted[2]), **FITTED_STYLE, zorder=3.5)
    frame = frame_of(measured.icrs, robot, fitted)
    axes.set_aspect("equal", adjustable="box")
    axes.set(xlim=(frame.left, frame.right), ylim=(frame.back, frame.front))
    axes.set_axisbelow(True)
    axes.grid(visible=True)
    axes.set(xlabel="y, to the left [m]", ylabel="x, forward [m]")
    return frame


def _draw_robot(axes: Axes, robot: Robot) -> None:
    length_m, tread_m = robot.length or robot.track_width, _TREAD_WIDTHS * robot.track_width
    if robot.length and robot.width:
        _draw_box(axes, 0.0, (robot.width, length_m), facecolor=_BODY, edgecolor="#999999")
    for y in (robot.track_width / 2, -robot.track_width / 2):
        _draw_box(axes, y, (tread_m, _TREAD_LENGTH * length_m), facecolor=_TREAD)
    axes.annotate(
        "",
        (0, 0.42 * length_m),
        (0, 0),
        arrowprops={"arrowstyle": "-|>", "color": "#777777", "linewidth": 1.2, "shrinkA": 0},
        zorder=1,
    )
    axes.plot(0, 0, "+", color="#777777", markersize=7, zorder=1)


def _draw_box(axes: Axes, y: float, size_m: tuple[float, float], **look: Any) -> None:
    """A rectangle around (x = 0, y), of this width and length."""
    corner = (y - size_m[0] / 2, -size_m[1] / 2)
    axes.add_patch(Rectangle(corner, *size_m, linewidth=0.8, zorder=0.8, **look))


def _draw_points(axes: Axes, icrs: FloatArray, side: str) -> None:
    style = TURN_STYLES[side]
    axes.plot(
        icrs[:, :2].T.ravel(),
        np.tile(icrs[:, 2], 2),
        style["marker"],
        color=style["color"],
        markersize=2.6,
        markeredgewidth=0,
        alpha=0.4,
        zorder=2,
    )


def _draw_median(axes: Axes, median: IcrMedian, icrs: FloatArray) -> None:
    style = TURN_STYLES[median.side]
    for tread in ([0, 2], [1, 2]):
        low, high = np.percentile(icrs[:, tread], [25, 75], axis=0)
        axes.add_patch(
            Ellipse(
                (float(low[0] + high[0]) / 2, float(low[1] + high[1]) / 2),
                *(high - low),
                facecolor="none",
                edgecolor=style["color"],
                linewidth=1.5,
                path_effects=HALO,
                zorder=3,
            )
        )
        (y, x), (y_low, x_low), (y_high, x_high) = (
            each[tread] for each in (median.icrs, median.low, median.high)
        )
        axes.plot([y_low, y_high], [x, x], color=style["color"], linewidth=1.4, zorder=4)
        axes.plot([y, y], [x_low, x_high], color=style["color"], linewidth=1.4, zorder=4)
        axes.plot(y, x, **style, markersize=5, markeredgecolor="white", zorder=4)
