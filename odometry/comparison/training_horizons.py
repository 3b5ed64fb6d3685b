"""Training horizon against evaluation horizon (Baril 2020 Fig. 4)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from odometry.comparison.candidates import IdentifiedModel
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.evaluation import Evaluation, NotEvaluated, evaluate_all
from odometry.comparison.fitting import SplitModels, fit_models
from odometry.comparison.split import Split
from odometry.comparison.summary import COLUMNS, Place, Summary, summarise
from odometry.io.csv_table import write_csv_table

Evaluated = tuple[Sequence[Evaluation], Sequence[NotEvaluated]]

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
    compared: Evaluated,
    *,
    show_progress: bool,
) -> tuple[HorizonErrors, ...]:
    """Identify models with each training horizon, and evaluate them over each horizon.

    The windows of an evaluation horizon are the same for every training horizon. Models of which
    nothing is identified are left out. The horizon of the comparison itself takes part, too.

    Parameters
    ----------
    planned : sequence of Split
    candidates : sequence of IdentifiedModel
    config : ComparisonConfig
        Without training horizons there are no errors.
    fitted : sequence of SplitModels
        Where the searches start.
    compared : Evaluation and NotEvaluated
        Of the comparison: its models were identified with `config.training`.
    show_progress : bool
    """
    free = [each for each in candidates if not all(p.known for p in each.model.parameters)]
    labels = [each.label for each in free]
    own_m, others_m = config.training.travel_m, config.training_horizons_m
    found = []
    if others_m and not config.training.horizon_s:
        found += [HorizonErrors(own_m, summary) for summary in _summaries(compared, labels, config)]
        others_m = tuple(horizon_m for horizon_m in others_m if horizon_m != own_m)
    for training_m in tqdm(
        others_m, desc="training horizons", unit="horizon", disable=None if show_progress else True
    ):
        training = replace(config.training, horizon_m=training_m, horizon_s=0.0)
        here = replace(config, training=training)
        models = fit_models(planned, free, here, fitted_to_all=fitted, show_progress=False)
        summaries = _summaries(evaluate_all(models, here), labels, here)
        found += [HorizonErrors(training_m, summary) for summary in summaries]
    return tuple(sorted(found, key=lambda each: each.training_m))


def _summaries(
    evaluated: Evaluated, models: Sequence[str], config: ComparisonConfig
) -> Iterator[Summary]:
    """Errors of these models by robot, terrain and evaluation horizon."""
    evaluations, not_evaluated = evaluated
    places = [(each.robot, each.terrain) for each in evaluations]
    places += [(each.robot, each.terrain) for each in not_evaluated]
    for robot, terrain in dict.fromkeys(places):
        for horizon_m in config.evaluated_m:
            place = Place(robot, terrain, horizon_m)
            here = [each for each in evaluations if place.holds(each)]
            yield from (summarise(place, here, not_evaluated, model) for model in models)


def best_training_horizons(
    errors: Sequence[HorizonErrors], quantity: str
) -> dict[float, tuple[float, ...]]:
    """By evaluation horizon, the training horizons with the smallest median error of one model.

    All with errors at most 5 % above the smallest, in increasing order; those with which the model
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
    """The training horizon (`--horizon`) of the smallest error over each evaluation horizon."""
    tried = sorted({each.training_m for each in errors if each.summary.complete})
    over: dict[tuple[float, ...], list[str]] = {}
    for evaluation_m, best_m in best_training_horizons(errors, quantity).items():
        over.setdefault(best_m, []).append(f"{evaluation_m:g}")
    if not over:
        return f"{model}, {quantity}: no training horizon could be evaluated."
    parts = [
        f"over {_listed(horizons, 'and')} m "
        + (
            "the errors of all are the same"
            if list(best_m) == tried
            else f"the error with {_listed([f'{h:g}' for h in best_m], 'or')} m is the smallest"
        )
        for best_m, horizons in over.items()
    ]
    return (
        f"{model}, {quantity}, identified over windows of "
        f"{_listed([f'{h:g}' for h in tried], 'or')} m: {'; '.join(parts)} (medians within "
        f"{100 * (AS_GOOD - 1):.0f} % count as equal)."
    )


def _listed(words: Sequence[str], last: str) -> str:
    """Words with commas, and `last` before the last one."""
    return f" {last} ".join(part for part in (", ".join(words[:-1]), words[-1]) if part)


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
