"""Mean errors over the plane of tread speeds, and their figure, one panel a model."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from odometry.arrays import FloatArray
from odometry.comparison.evaluation import Evaluation
from odometry.comparison.summary import QUANTITIES, values_of
from odometry.report.drawing.figure import save_figure
from odometry.report.drawing.html import Picture

BINS = 10
FLAT = 1.001  # least ratio of the largest to the smallest colour


@dataclass(frozen=True)
class SpeedPlane:
    """Means by bin of (v_left, v_right).

    Attributes
    ----------
    edges_m_s : (B + 1,)
        Of both axes.
    means : (B, B)
        Row: v_right, column: v_left; NaN where no window falls.
    """

    edges_m_s: FloatArray
    means: FloatArray


def speed_plane(speeds_m_s: FloatArray, errors: FloatArray, edges_m_s: FloatArray) -> SpeedPlane:
    """Average errors (K,) over bins of mean tread speeds (K, 2)."""
    both = (edges_m_s, edges_m_s)
    right, left = speeds_m_s[:, 1], speeds_m_s[:, 0]
    counts, _, _ = np.histogram2d(right, left, bins=both)
    sums, _, _ = np.histogram2d(right, left, bins=both, weights=errors)
    return SpeedPlane(edges_m_s, np.where(counts > 0, sums / np.maximum(counts, 1), np.nan))


def speed_edges(speeds_m_s: FloatArray) -> FloatArray:
    """Edges of `BINS` equal bins that hold all mean tread speeds (K, 2)."""
    low, high = float(speeds_m_s.min()), float(speeds_m_s.max())
    room = 1e-6 + 1e-3 * (high - low)
    return np.linspace(low - room, high + room, BINS + 1)


def common_range(planes: list[SpeedPlane]) -> tuple[float, float]:
    """Lowest and highest colour, both above 0, that suit all planes of one figure."""
    means = np.concatenate([plane.means[np.isfinite(plane.means)] for plane in planes])
    positive = means[means > 0]
    if not len(positive):
        return 1e-3, 1.0
    low, high = np.percentile(positive, [2, 98])
    return float(low), float(max(high, low * FLAT))


def plot_speed_plane(axes: Axes, plane: SpeedPlane, colours: tuple[float, float]) -> QuadMesh:
    """Draw mean errors, as in Baril 2020 Fig. 8.

    Parameters
    ----------
    axes : Axes
    plane : SpeedPlane
    colours : (float, float)
        Ends of the logarithmic scale of colours; what is beyond has the colour of an end.

    Returns
    -------
    QuadMesh
        For a bar of colours.
    """
    shown = np.ma.masked_invalid(np.maximum(plane.means, colours[0]))
    mesh = axes.pcolormesh(
        plane.edges_m_s,
        plane.edges_m_s,
        shown,
        norm=LogNorm(*colours),
        cmap="cividis",
        rasterized=True,
    )
    axes.axline((0, 0), slope=1, color="#AAAAAA", linewidth=0.8)
    ends = (float(plane.edges_m_s[0]), float(plane.edges_m_s[-1]))
    axes.set(xlim=ends, ylim=ends, aspect="equal")
    return mesh


_WIDTH_IN, _COLUMNS, _LARGEST_PANEL_IN = 7.0, 4, 1.7
_LEFT_IN, _GAP_IN, _RIGHT_IN = 0.6, 0.14, 0.75
_TOP_IN, _BETWEEN_IN, _BOTTOM_IN = 0.5, 0.34, 0.55


@dataclass(frozen=True)
class Layout:
    """Two blocks of square panels, one above the other; places are shares of the figure."""

    columns: int
    rows: int
    panel_in: float

    @property
    def block_in(self) -> float:
        """Height of a block in inches."""
        between_in = (self.rows - 1) * _BETWEEN_IN
        return _TOP_IN + self.rows * self.panel_in + between_in + _BOTTOM_IN

    def place(self, block: int, left_in: float, down_in: float) -> tuple[float, float]:
        """A point so many inches from the left, and from the top of a block."""
        return left_in / _WIDTH_IN, 1 - (block * self.block_in + down_in) / (2 * self.block_in)

    def panel(self, block: int, number: int) -> tuple[float, float, float, float]:
        """Left, bottom, width and height of a panel."""
        row, column = divmod(number, self.columns)
        left_in = _LEFT_IN + column * (self.panel_in + _GAP_IN)
        down_in = _TOP_IN + row * (self.panel_in + _BETWEEN_IN) + self.panel_in
        size = (self.panel_in / _WIDTH_IN, self.panel_in / (2 * self.block_in))
        return *self.place(block, left_in, down_in), *size

    def bar(self, block: int) -> tuple[float, float, float, float]:
        """The same of the bar of colours, beside the first row."""
        left_in = _LEFT_IN + self.columns * (self.panel_in + _GAP_IN)
        _, bottom, _, height = self.panel(block, 0)
        return left_in / _WIDTH_IN, bottom, 0.11 / _WIDTH_IN, height


def speed_plane_picture(
    evaluations: tuple[Evaluation, ...], models: tuple[str, ...], file: Path
) -> Picture | None:
    """Mean rotation and translation errors by mean tread speeds; None without a window.

    Parameters
    ----------
    evaluations : tuple of Evaluation
        Of one place.
    models : tuple of str
    file : Path
    """
    planes = {quantity: _planes(evaluations, models, quantity) for quantity in QUANTITIES}
    names = list(planes["rotation"])
    if not names:
        return None
    columns = min(len(names), _COLUMNS)
    room_in = (_WIDTH_IN - _LEFT_IN - _RIGHT_IN) / columns - _GAP_IN
    layout = Layout(columns, -(-len(names) // columns), min(room_in, _LARGEST_PANEL_IN))

    def draw(figure: Figure) -> None:
        for block, quantity in enumerate(("rotation", "translation")):
            _draw_block(figure, planes[quantity], quantity, layout, block)

    return Picture(
        save_figure(file, (_WIDTH_IN, 2 * layout.block_in), draw),
        f"Errors over the plane of tread speeds of {', '.join(names)}.",
        "Mean held-out errors by the mean tread speeds of the windows (as Baril 2020 Fig. 8), on a "
        "logarithmic scale of colours; white where there was no window. On the grey line both "
        "treads run at the same speed.",
    )


def _planes(
    evaluations: tuple[Evaluation, ...], models: tuple[str, ...], quantity: str
) -> dict[str, SpeedPlane]:
    """The plane of each evaluated model, all with the same bins."""
    if not evaluations:
        return {}
    edges = speed_edges(np.concatenate([j.mean_speeds_m_s for j in evaluations]))
    found = {}
    for model in models:
        here = [evaluation for evaluation in evaluations if model in evaluation.errors]
        if here:
            speeds = np.concatenate([j.mean_speeds_m_s for j in here])
            errors = np.concatenate([values_of(j.errors[model], quantity) for j in here])
            found[model] = speed_plane(speeds, errors, edges)
    return found


def _draw_block(
    figure: Figure, planes: dict[str, SpeedPlane], quantity: str, layout: Layout, block: int
) -> None:
    """Panels of one quantity with a title and a bar of colours."""
    colours = common_range(list(planes.values()))
    left, top = layout.place(block, _LEFT_IN, 0.2)
    figure.text(left, top, f"{quantity} error", weight="bold")
    for number, (name, plane) in enumerate(planes.items()):
        axes = figure.add_axes(layout.panel(block, number))
        mesh = plot_speed_plane(axes, plane, colours)
        axes.set_title(name, fontsize=8.5, parse_math=False, pad=3)
        last_of_column = number + layout.columns >= len(planes)
        first_of_row = number % layout.columns == 0
        axes.tick_params(labelsize=8, labelbottom=last_of_column, labelleft=first_of_row)
        axes.set_xlabel("v_left [m/s]" if last_of_column else "", fontsize=8.5)
        axes.set_ylabel("v_right [m/s]" if first_of_row else "", fontsize=8.5)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MaxNLocator(3, prune="both"))
    bar = figure.add_axes(layout.bar(block))
    figure.colorbar(mesh, cax=bar)
    bar.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    bar.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    bar.yaxis.set_minor_formatter(NullFormatter())
    bar.tick_params(labelsize=8)
    bar.set_title(QUANTITIES[quantity].replace("degrees", "deg"), fontsize=8, loc="left", pad=5)
