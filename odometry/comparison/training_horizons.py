"""Training horizon against evaluation horizon (Baril 2020 Fig. 4)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from odometry.comparison.candidates import IdentifiedModel
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.evaluation import evaluate_all
from odometry.comparison.fitting import SplitModels, fit_models
from odometry.comparison.split import Split
from odometry.comparison.summary import COLUMNS, Place, Summary, summarise
from odometry.io.csv_table import write_csv_table

AS_GOOD = 1.05  # times the least median error: no worse in practice


@dataclass(frozen=True)
class HorizonErrors:
    """Held-out errors of one model with one training and one evaluation horizon.

    Attributes
    ----------
    training_m : float
        h_t of Baril 2020: wheel travel of the windows that the model was identified on.
    summary : Summary
        Over windows of the evaluation horizon h_e, which its place states.
    """

    training_m: float
    summary: Summary


def training_horizon_errors(
    planned: Sequence[Split],
    candidates: Sequence[IdentifiedModel],
    config: ComparisonConfig,
    fitted: Sequence[SplitModels],
    *,
    show_progress: bool,
) -> tuple[HorizonErrors, ...]:
    """Identify models with each training horizon, and evaluate them over each horizon.

    The windows of an evaluation horizon are the same for every training horizon. Models of which
    nothing is identified are left out.

    Parameters
    ----------
    planned : sequence of Split
    candidates : sequence of IdentifiedModel
    config : ComparisonConfig
    fitted : sequence of SplitModels
        Where the searches start.
    show_progress : bool
    """
    free = [each for each in candidates if not all(p.known for p in each.model.parameters)]
    terrains = dict.fromkeys((split.robot, split.terrain) for split in planned)
    found = []
    for training_m in tqdm(
        config.training_horizons_m,
        desc="training horizons",
        unit="horizon",
        disable=None if show_progress else True,
    ):
        training = replace(config.training, horizon_m=training_m, horizon_s=0.0)
        here = replace(config, training=training)
        models = fit_models(planned, free, here, fitted_to_all=fitted, show_progress=False)
        evaluations, not_evaluated = evaluate_all(models, here)
        for robot, terrain in terrains:
            for horizon_m in config.evaluated_m:
                place = Place(robot, terrain, horizon_m)
                at_place = [each for each in evaluations if place.holds(each)]
                found += [
                    HorizonErrors(training_m, summarise(place, at_place, not_evaluated, each.label))
                    for each in free
                ]
    return tuple(found)


def best_training_horizons(
    errors: Sequence[HorizonErrors], quantity: str
) -> dict[float, tuple[float, ...]]:
    """By evaluation horizon, the training horizons with the least median error of one model.

    All that err at most 5 % more than the least, in increasing order; those with which the model
    could not be evaluated on all windows do not take part.
    """
    by_horizon: dict[float, dict[float, float]] = {}
    for each in errors:
        if each.summary.complete:
            medians = by_horizon.setdefault(each.summary.place.horizon_m, {})
            medians[each.training_m] = each.summary.medians[quantity]
    return {
        horizon_m: tuple(
            sorted(h for h, median in medians.items() if median <= AS_GOOD * min(medians.values()))
        )
        for horizon_m, medians in sorted(by_horizon.items())
    }


def horizon_sentence(model: str, errors: Sequence[HorizonErrors], quantity: str) -> str:
    """Which training horizons suit which evaluation horizon."""
    every = tuple(sorted({each.training_m for each in errors}))
    parts = [
        f"{'any' if best_m == every else ', '.join(f'{h:g}' for h in best_m)} for {evaluation_m:g}"
        for evaluation_m, best_m in best_training_horizons(errors, quantity).items()
    ]
    return (
        f"{model}, {quantity}: training horizons [m] with the least median error, or up to "
        f"{AS_GOOD - 1:.0%} more, for each evaluation horizon [m]: {'; '.join(parts) or 'none'}."
    )


def write_training_horizons(file: Path, errors: Sequence[HorizonErrors]) -> None:
    """One row a robot, terrain, model, training horizon and evaluation horizon [m]."""
    rows = [(each.training_m, each.summary) for each in errors if each.summary.complete]
    columns: dict[str, Any] = {
        "robot": [summary.place.robot for _, summary in rows],
        "terrain": [summary.place.terrain for _, summary in rows],
        "model": [summary.model for _, summary in rows],
        "training_horizon": [training_m for training_m, _ in rows],
        "evaluation_horizon": [summary.place.horizon_m for _, summary in rows],
        "windows": [summary.windows for _, summary in rows],
    }
    for quantity, name in COLUMNS.items():
        low, median, high = np.array([s.quartiles[quantity] for _, s in rows]).reshape(-1, 3).T
        columns[f"{name}_median"], columns[f"{name}_quartile_range"] = median, high - low
    write_csv_table(file, {name: np.array(column) for name, column in columns.items()})
