"""Heat maps of held-out errors by training and evaluation horizon."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import Rectangle

from odometry.arrays import FloatArray
from odometry.comparison.file_names import file_name
from odometry.comparison.summary import QUANTITIES
from odometry.comparison.training_horizons import HorizonErrors, best_training_horizons
from odometry.digits import three_figures
from odometry.report.drawing.figure import save_figure
from odometry.report.drawing.html import Picture

_WIDTH_IN, _ROW_IN, _LEAST_IN, _REST_IN = 7.0, 0.32, 1.6, 0.9
_MOST_RATIO = 2.0  # times the least of a column: the end of the colours


def training_horizon_picture(
    errors: Sequence[HorizonErrors], folder: Path, name: str
) -> Picture | None:
    """Median errors of one model on one terrain; None where it was evaluated with no horizon."""
    evaluated = [each for each in errors if each.summary.complete]
    if not evaluated:
        return None
    first = evaluated[0].summary
    training_m = sorted({each.training_m for each in errors})
    evaluation_m = sorted({each.summary.place.horizon_m for each in evaluated})
    map_in = max(_LEAST_IN, _ROW_IN * len(training_m))  # room for the label beside it
    height_in = _REST_IN + map_in

    def draw(figure: Figure) -> None:
        bottom, height = 0.55 / height_in, map_in / height_in
        for quantity, left in (("translation", 0.09), ("rotation", 0.525)):
            axes = figure.add_axes((left, bottom, 0.385, height))
            medians = median_table(evaluated, training_m, evaluation_m, quantity)
            image = _plot_medians(axes, medians, training_m, evaluation_m)
            for column, horizon_m in enumerate(evaluation_m):
                for best_m in best_training_horizons(evaluated, quantity)[horizon_m]:
                    _frame(axes, column, training_m.index(best_m))
            unit = QUANTITIES[quantity].replace("degrees", "deg")
            axes.set_title(f"median {quantity} error [{unit}]", loc="left")
            axes.set_xlabel("evaluation horizon h_e [m]")
        figure.axes[0].set_ylabel("training horizon h_t [m]")
        bar = figure.colorbar(image, cax=figure.add_axes((0.925, bottom, 0.015, height)))
        bar.set_ticks([1.0, 1.5, _MOST_RATIO], labels=["1", "1.5", "2+"])
        bar.ax.tick_params(labelsize=8)

    where = (first.place.robot, first.place.terrain, first.model)
    return Picture(
        save_figure(
            folder / f"training_horizons_{file_name(*where)}.png", (_WIDTH_IN, height_in), draw
        ),
        f"Median errors of {name} by training and evaluation horizon.",
        f"{name}: median held-out errors by training horizon h_t and evaluation horizon h_e (as "
        "Baril 2020 Fig. 4). Colour: how many times the least of the column; framed: the least of "
        "the column, and what is at most 5 % above it. Every column is of the same "
        "windows; white: not evaluated on all of them.",
    )


def median_table(
    errors: Sequence[HorizonErrors],
    training_m: Sequence[float],
    evaluation_m: Sequence[float],
    quantity: str,
) -> FloatArray:
    """Medians (T, E) of one model by training and evaluation horizon, NaN where there is none."""
    table = np.full((len(training_m), len(evaluation_m)), np.nan)
    for each in errors:
        row = training_m.index(each.training_m)
        table[row, evaluation_m.index(each.summary.place.horizon_m)] = each.summary.medians[
            quantity
        ]
    return table


def _plot_medians(
    axes: Axes, medians: FloatArray, training_m: Sequence[float], evaluation_m: Sequence[float]
) -> AxesImage:
    least = np.nanmin(medians, axis=0)
    ratios = medians / np.where(least > 0, least, 1.0)
    image = axes.imshow(
        ratios, cmap="YlOrBr", vmin=1.0, vmax=_MOST_RATIO, aspect="auto", origin="lower"
    )
    for (row, column), median in np.ndenumerate(medians):
        if np.isfinite(median):
            dark = ratios[row, column] > 0.5 * (1 + _MOST_RATIO)
            axes.text(
                column,
                row,
                three_figures(median),
                ha="center",
                va="center",
                fontsize=8,
                color="white" if dark else "black",
            )
    axes.set_xticks(range(len(evaluation_m)), [f"{horizon_m:g}" for horizon_m in evaluation_m])
    axes.set_yticks(range(len(training_m)), [f"{horizon_m:g}" for horizon_m in training_m])
    axes.tick_params(length=0, labelsize=8.5)
    return image


def _frame(axes: Axes, column: int, row: int) -> None:
    axes.add_patch(
        Rectangle((column - 0.46, row - 0.44), 0.92, 0.88, fill=False, linewidth=1.5, color="black")
    )
