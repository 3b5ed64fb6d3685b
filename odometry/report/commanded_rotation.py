"""What the robot does with a commanded difference of tread speeds."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from odometry.arrays import FloatArray
from odometry.report.palette import LineStyle

BINS = 16
LEAST_WINDOWS = 4  # of a bin whose quartiles are drawn


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
