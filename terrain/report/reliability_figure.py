"""The figure of probabilities: how often answers are right, by how probable they were."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from odometry.arrays import AnyArray
from odometry.report.drawing.figure import save_figure
from terrain.classification.neighbours.calibration import (
    BINS,
    Reliability,
    ReliabilityByChance,
    reliability,
    reliability_by_chance,
)
from terrain.classification.neighbours.validation import CrossValidation

_SIZE_IN = (5.6, 6.4)
_RIGHT, _CHANCE = "#0072B2", "#C9CED6"


def write_reliability_figure(
    file: Path, found: CrossValidation, photos: AnyArray, source: str | None = None
) -> Path:
    """Draw the share of right answers in each tenth of probability, and what chance explains.

    Parameters
    ----------
    file : Path
        Ends in .png.
    found : CrossValidation
        Of n patches.
    photos : array, shape (n,)
        Of each patch: chance is drawn for the patches of a photograph together.
    source : str, optional
        What made it.

    Returns
    -------
    Path
        `file`.

    References
    ----------
    Guo et al. 2017, fig. 1: the reliability diagram.
    """
    seen = reliability(found.codes, found.probabilities)
    chance = reliability_by_chance(found.probabilities, photos)

    def draw(figure: Figure) -> None:
        above = figure.add_axes((0.14, 0.36, 0.83, 0.50))
        below = figure.add_axes((0.14, 0.09, 0.83, 0.2), sharex=above)
        plot_reliability(above, seen, chance)
        _plot_counts(below, seen)
        figure.suptitle(
            "How often answers were right in cross-validation\n"
            f"off by {seen.expected_error:.3f} in the mean;\n"
            "exact probabilities would seem off by "
            f"{chance.expected_error:.3f} by chance",
            fontsize=10,
            y=0.97,
        )

    return save_figure(file, _SIZE_IN, draw, source=source)


def plot_reliability(axes: Axes, seen: Reliability, chance: ReliabilityByChance) -> None:
    """Draw the share of right answers in each tenth of probability over the mean probability.

    Grey bars reach as far as chance alone takes exact probabilities in 95 % of draws.
    """
    used = seen.counts > 0
    middle = seen.confidences[used]
    spread = (chance.highest - chance.lowest)[used]
    axes.bar(middle, spread, 0.06, chance.lowest[used], color=_CHANCE,
             label="by chance, of exact probabilities (95 %)")  # fmt: skip
    axes.plot([0, 1], [0, 1], color="black", linewidth=0.8, label="exact")
    axes.plot(middle, seen.accuracies[used], "o", color=_RIGHT, clip_on=False,
              label="answers of each tenth")  # fmt: skip
    axes.set(xlim=(0, 1), ylim=(0, 1.02), ylabel="share that is right")
    axes.legend(loc="lower right", frameon=False, fontsize=8.5)


def _plot_counts(axes: Axes, seen: Reliability) -> None:
    edges = np.arange(BINS) / BINS
    axes.bar(edges, seen.counts, 1 / BINS, align="edge", color=_RIGHT, edgecolor="white")
    axes.set(xlabel="probability of the answer", ylabel="patches")
