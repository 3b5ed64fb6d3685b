"""Mean errors over the plane of mean tread speeds."""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm

from odometry.arrays import FloatArray

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
