"""The tables of a comparison's page."""

from collections.abc import Sequence

import numpy as np

from odometry.comparison.result import Comparison
from odometry.comparison.statistics import Difference
from odometry.comparison.summary import NOT_IDENTIFIED, Place, Summary
from odometry.digits import within_sigma
from odometry.report.drawing.html import Grid


def error_grid(comparison: Comparison) -> Grid:
    """Mean and median errors of every model at every place."""
    rows = [
        (
            place.robot,
            place.terrain,
            f"{place.horizon_m:g}",
            f"{summary.model} ({NOT_IDENTIFIED})" if summary.not_identified else summary.model,
            str(summary.windows),
            *_mean_and_median(summary, "translation", 4),
            *_mean_and_median(summary, "rotation", 3),
        )
        for place in comparison.places
        for summary in comparison.summaries_at(place)
    ]
    header = (
        *("robot", "terrain", "horizon [m]", "model", "windows"),
        *("mean [m per m]", "median [m per m]", "mean [degrees per m]", "median [degrees per m]"),
    )
    return Grid(header, rows, "Held-out errors per metre of wheel travel.")


def quartile_grid(comparison: Comparison, place: Place) -> Grid:
    """Quartiles of both errors, on which windows, and remarks."""
    rows = [
        (
            summary.model,
            str(summary.windows),
            _quartiles(summary, "translation", 4),
            _quartiles(summary, "rotation", 3),
            "; ".join(comparison.remarks_at(place, summary)) or "-",
        )
        for summary in comparison.summaries_at(place)
    ]
    header = ("model", "windows", "quartiles [m per m]", "quartiles [degrees per m]", "remarks")
    return Grid(header, rows)


def split_grid(comparison: Comparison, place: Place) -> Grid:
    """Which runs were held out from models that were identified on which."""
    rows = dict.fromkeys(
        (evaluation.run, evaluation.training_runs, str(len(evaluation.windows)))
        for evaluation in comparison.evaluations_at(place)
    )
    return Grid(
        ("evaluated run", "identified on", "windows"),
        list(rows),
        "Runs that the models of each evaluated run were identified on.",
    )


def difference_grid(found: Sequence[Difference]) -> Grid:
    """Paired differences with intervals, both quantities side by side."""
    pairs: dict[tuple[str, str], dict[str, Difference]] = {}
    for each in found:
        pairs.setdefault((each.first, each.second), {})[each.quantity] = each
    rows = [
        (f"{first} less {second}", *(_verdict(of_pair[q]) for q in ("translation", "rotation")))
        for (first, second), of_pair in pairs.items()
    ]
    caption = "Differences of mean errors on the same windows, with 95 % intervals."
    return Grid(("models", "translation", "rotation"), rows, caption)


def fitness_grid(comparison: Comparison) -> Grid:
    """J and its parts of whole runs."""
    rows = [
        (
            each.run,
            each.model,
            str(each.fitness.poses),
            f"{each.fitness.x_m2:.3f}",
            f"{each.fitness.y_m2:.3f}",
            f"{each.fitness.z_m2:.3f}" if each.fitness.heights else "-",
            f"{each.fitness.yaw_rad2:.4f}",
            f"{each.fitness.mean:.3f}",
        )
        for each in comparison.fitness
    ]
    header = ("run", "model", "N", "x [m²]", "y [m²]", "z [m²]", "yaw [rad²]", "J / N")
    caption = (
        "Mean squared errors of dead reckoning from the first pose to the end, held out. N: "
        "poses; J / N: the sum of the four (Martinez 2024, eq. 13 and Table II)."
    )
    return Grid(header, rows, caption)


def parameter_grid(comparison: Comparison) -> Grid:
    """What was identified, from all data that each model may use."""
    rows = []
    for (robot, model), parameters in comparison.parameters.items():
        for terrain, table in parameters.terrains.items():
            sigmas = dict(
                zip(table.covariance_order, np.sqrt(np.diag(table.covariance)), strict=True)
            )
            words = [
                f"{name} " + " ± ".join(within_sigma(value, sigmas[name]))
                if name in sigmas
                else f"{name} {value:.4g}"
                for name, value in table.values.items()
            ]
            rows.append((f"{robot} on {terrain}", model, ", ".join(words)))
    caption = "Values with one standard deviation, as in the files of parameters/."
    return Grid(("where", "model", "parameters"), rows, caption)


def settings_grid(comparison: Comparison) -> Grid:
    """Every setting that was used."""
    config = comparison.config
    values = {
        "evaluation horizons [m]": ", ".join(f"{h:g}" for h in config.horizons_m),
        "training horizons [m]": ", ".join(f"{h:g}" for h in config.training_horizons_m) or "-",
        "draws": config.draws,
        "block [m]": config.block_m,
        "seed": config.seed,
        **{f"training.{name}": value for name, value in vars(config.training).items()},
        **{f"solver.{name}": value for name, value in vars(config.solver).items()},
    }
    return Grid(("setting", "value"), [(name, str(value)) for name, value in values.items()])


def _mean_and_median(summary: Summary, quantity: str, decimals: int) -> tuple[str, str]:
    if not summary.windows:
        return "-", "-"
    numbers = (summary.means[quantity], summary.medians[quantity])
    return f"{numbers[0]:.{decimals}f}", f"{numbers[1]:.{decimals}f}"


def _quartiles(summary: Summary, quantity: str, decimals: int) -> str:
    if not summary.windows:
        return "-"
    return " / ".join(f"{value:.{decimals}f}" for value in summary.quartiles[quantity])


def _verdict(difference: Difference) -> str:
    apart = "not distinguished" if difference.interval.holds_zero else "distinguished"
    return f"{difference.words()}: {apart}"
