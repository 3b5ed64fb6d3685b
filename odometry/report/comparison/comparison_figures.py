"""The figures of a comparison as files with captions."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from odometry.arrays import FloatArray
from odometry.comparison.config import ROTATION_HORIZON_M
from odometry.comparison.evaluation import Evaluation
from odometry.comparison.file_names import file_name
from odometry.comparison.result import Comparison
from odometry.comparison.summary import QUANTITIES, Place, values_of
from odometry.report.comparison.comparison_plots import (
    commanded_rotation,
    difference_edges,
    plot_against_horizon,
    plot_commanded_rotation,
    plot_violins,
)
from odometry.report.drawing.figure import line_styles, save_figure
from odometry.report.drawing.html import Picture

_WIDTH_IN, _LEGEND_COLUMNS = 7.0, 4
_PANELS, _PANEL_IN = 3, 2.3  # of the figure of turns


def distribution_picture(comparison: Comparison, place: Place, folder: Path) -> Picture | None:
    """Violins of both errors, one row a model; None where no model was evaluated."""
    evaluations = comparison.evaluations_at(place)
    errors = {q: pooled_errors(evaluations, comparison.models, q) for q in QUANTITIES}
    names = list(errors["translation"])
    if not names:
        return None
    styles = line_styles(comparison.models)
    height_in = 0.75 + 0.42 * len(names)

    def draw(figure: Figure) -> None:
        bottom, height = 0.55 / height_in, 1 - 0.65 / height_in
        for quantity, left in (("translation", 0.25), ("rotation", 0.64)):
            axes = figure.add_axes((left, bottom, 0.34, height))
            plot_violins(
                axes, errors[quantity], styles, f"{quantity} error [{QUANTITIES[quantity]}]"
            )
            if quantity == "rotation":
                axes.set_yticklabels([])

    windows = max(len(values) for values in errors["translation"].values())
    return Picture(
        save_figure(
            folder / f"errors_{picture_name(comparison, place)}.png", (_WIDTH_IN, height_in), draw
        ),
        f"Distributions of the errors of {', '.join(names)}.",
        f"Held-out errors over {windows} windows of {place.horizon_m:g} m of wheel travel, on "
        "logarithmic axes (as Baril 2020 Fig. 5 and 6). Curves: density; boxes: quartiles; "
        "black: median.",
    )


def horizon_picture(
    comparison: Comparison, robot: str, terrain: str, folder: Path
) -> Picture | None:
    """Median and interquartile range over evaluation horizons; None below two horizons."""
    curves = {q: horizon_curves(comparison, robot, terrain, q) for q in QUANTITIES}
    if not any(len(h) > 1 for median, _ in curves.values() for h, _ in median.values()):
        return None
    styles = line_styles(comparison.models)
    legend_in = 0.1 + 0.22 * -(-len(comparison.models) // _LEGEND_COLUMNS)
    height_in = 5.3 + legend_in

    def draw(figure: Figure) -> None:
        for row, quantity in enumerate(QUANTITIES):
            for column, name in enumerate(("median", "interquartile range")):
                bottom_in = legend_in + 0.55 + 2.5 * (1 - row)
                axes = figure.add_axes(
                    (0.09 + 0.5 * column, bottom_in / height_in, 0.4, 1.95 / height_in)
                )
                plot_against_horizon(axes, curves[quantity][column], styles)
                axes.set_title(f"{quantity} error: {name}", loc="left")
                axes.set_ylabel(QUANTITIES[quantity] if column == 0 else "")
                axes.set_xlabel("evaluation horizon h_e [m]" if row else "")
        lines, names = axes.get_legend_handles_labels()
        legend = figure.legend(
            lines, names, loc="lower left", ncols=_LEGEND_COLUMNS, frameon=False, fontsize=8.5
        )
        for text in legend.get_texts():
            text.set_parse_math(False)

    training = comparison.config.training
    usual = f"{training.travel_m:g} m" + (" or less" if training.horizon_m is None else "")
    trained = f"{training.horizon_s:g} s" if training.horizon_s else usual
    return Picture(
        save_figure(
            folder / f"horizons_{file_name(robot, terrain)}.png", (_WIDTH_IN, height_in), draw
        ),
        "Errors of each model against the evaluation horizon.",
        f"Held-out errors against the evaluation horizon h_e (as Baril 2020 Fig. 4); training "
        f"horizon h_t = {trained}.",
    )


def rotation_picture(comparison: Comparison, robot: str, folder: Path) -> Picture | None:
    """Measured turns over one metre by commanded difference; None without such windows."""
    terrains: dict[str, list[Evaluation]] = {}
    for each in comparison.evaluations:
        if each.robot == robot and each.horizon_m == ROTATION_HORIZON_M:
            terrains.setdefault(each.terrain, []).append(each)
    if not terrains:
        return None
    commanded = {terrain: _commanded(of_terrain) for terrain, of_terrain in terrains.items()}
    edges = difference_edges(np.concatenate([each[0] for each in commanded.values()]))
    every = {terrain: commanded_rotation(*pair, edges) for terrain, pair in commanded.items()}
    found = {terrain: each for terrain, each in every.items() if len(each.differences_m_s)}
    if not found:
        return None
    columns = min(len(found), _PANELS)
    rows = -(-len(found) // columns)
    height_in = 0.55 + rows * _PANEL_IN
    style = line_styles(found)[next(iter(found))]

    def draw(figure: Figure) -> None:
        panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
        for number, (terrain, each) in enumerate(found.items()):
            axes = panels[number]
            plot_commanded_rotation(
                axes, each, [other for other in found.values() if other is not each], style
            )
            axes.set_title(terrain, loc="left", parse_math=False)
            axes.tick_params(labelbottom=number + columns >= len(found))
        for axes in panels[len(found) :]:
            axes.set_visible(False)
        figure.subplots_adjust(
            left=0.12, right=0.98, bottom=0.55 / height_in, top=1 - 0.3 / height_in, hspace=0.35
        )
        figure.supxlabel("commanded difference v_right - v_left [m/s]", fontsize=10)
        figure.supylabel("turn over 1 m [degrees]", fontsize=10)

    return Picture(
        save_figure(folder / f"rotation_{file_name(robot)}.png", (_WIDTH_IN, height_in), draw),
        f"Measured turns of {robot} against the commanded difference of tread speeds.",
        "Measured turn over one metre of wheel travel against the commanded difference of the "
        "tread speeds (as Baril 2020 Fig. 7). Lines: medians; bands: quartiles; grey: the medians "
        "on the other terrains.",
    )


def pooled_errors(
    evaluations: tuple[Evaluation, ...], models: tuple[str, ...], quantity: str
) -> dict[str, FloatArray]:
    """All errors by model, of those that were evaluated."""
    found: dict[str, FloatArray] = {}
    for model in models:
        values = [values_of(j.errors[model], quantity) for j in evaluations if model in j.errors]
        if values:
            found[model] = np.concatenate(values)
    return found


def horizon_curves(
    comparison: Comparison, robot: str, terrain: str, quantity: str
) -> tuple[Mapping[str, tuple[FloatArray, FloatArray]], ...]:
    """Median, and interquartile range, by model: horizons and values."""
    medians, ranges = {}, {}
    for model in comparison.models:
        rows = [
            (horizon_m, *summary.quartiles[quantity])
            for horizon_m in comparison.config.evaluated_m
            for summary in comparison.summaries_at(Place(robot, terrain, horizon_m))
            if summary.model == model and summary.windows
        ]
        if rows:
            horizons_m, low, middle, high = np.array(rows).T
            medians[model], ranges[model] = (horizons_m, middle), (horizons_m, high - low)
    return medians, ranges


def _commanded(evaluations: list[Evaluation]) -> tuple[FloatArray, FloatArray]:
    """Commanded differences and measured turns (degrees per m) of all windows."""
    differences = np.concatenate(
        [j.mean_speeds_m_s[:, 1] - j.mean_speeds_m_s[:, 0] for j in evaluations]
    )
    turns = np.concatenate([j.windows.measured[:, 2] / j.windows.travel_m for j in evaluations])
    return differences, np.degrees(turns)


def picture_name(comparison: Comparison, place: Place) -> str:
    """Of the files of a place: with the horizon where there are several."""
    several = len(comparison.config.horizons_m) > 1
    horizon = f"_{place.horizon_m:g}m".replace(".", "p") if several else ""
    return file_name(place.robot, place.terrain) + horizon
