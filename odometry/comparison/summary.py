"""Errors of each model by robot, terrain and horizon."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.comparison.evaluation import Evaluation, NotEvaluated
from odometry.windows.window_errors import WindowErrors

# Quantity to unit. Angles are degrees in everything that a comparison states.
QUANTITIES = {"translation": "m per m", "rotation": "degrees per m"}
NOT_IDENTIFIED = "at a bound: parameters not identified"
COLUMNS = {"translation": "translation_m_per_m", "rotation": "rotation_deg_per_m"}  # in files


@dataclass(frozen=True)
class Place:
    """Where models are compared: one robot on one terrain over one horizon."""

    robot: str
    terrain: str
    horizon_m: float

    @property
    def title(self) -> str:
        """The place in words."""
        return f"{self.robot} on {self.terrain}, over {self.horizon_m:g} m"

    def holds(self, evaluation: Evaluation) -> bool:
        """Whether an evaluation belongs here."""
        return (evaluation.robot, evaluation.terrain, evaluation.horizon_m) == (
            self.robot,
            self.terrain,
            self.horizon_m,
        )


@dataclass(frozen=True)
class Summary:
    """Errors of one model at one place.

    Attributes
    ----------
    place : Place
    model : str
    training_runs : tuple of str
        What it was identified on, once for each split.
    runs : tuple of str
        That it was evaluated on.
    windows : int
    complete : bool
        Whether it was evaluated on all windows of the place.
    means : Mapping of quantity to float
    quartiles : Mapping of quantity to (3,)
    reasons : tuple of str
        Why it was not evaluated on some run.
    not_identified : tuple of str
        Why `identify` refuses its parameters; its errors stand all the same.
    """

    place: Place
    model: str
    training_runs: tuple[str, ...]
    runs: tuple[str, ...]
    windows: int
    complete: bool
    means: dict[str, float]
    quartiles: dict[str, FloatArray]
    reasons: tuple[str, ...]
    not_identified: tuple[str, ...] = ()

    @property
    def ranked(self) -> bool:
        """Whether it may be named as the model to take."""
        return self.complete and not self.not_identified

    @property
    def medians(self) -> dict[str, float]:
        """By quantity: what outliers among the measured poses hardly change."""
        return {quantity: float(values[1]) for quantity, values in self.quartiles.items()}


def values_of(errors: WindowErrors, quantity: str) -> FloatArray:
    """Errors (K,) in the unit of `QUANTITIES`."""
    if quantity == "translation":
        return errors.translation_per_m
    return np.degrees(errors.rotation_per_m)


def summarise(
    place: Place,
    evaluations: Sequence[Evaluation],
    not_evaluated: Sequence[NotEvaluated],
    model: str,
) -> Summary:
    """Pool the windows of one model over the evaluations of a place."""
    here = [evaluation for evaluation in evaluations if model in evaluation.errors]
    pooled = {
        quantity: np.concatenate(
            [np.empty(0), *(values_of(each.errors[model], quantity) for each in here)]
        )
        for quantity in QUANTITIES
    }
    windows = sum(len(evaluation.windows) for evaluation in here)
    return Summary(
        place=place,
        model=model,
        training_runs=tuple(dict.fromkeys(evaluation.training_runs for evaluation in here)),
        runs=tuple(dict.fromkeys(evaluation.run for evaluation in here)),
        windows=windows,
        complete=0 < windows == sum(len(evaluation.windows) for evaluation in evaluations),
        means={q: float(values.mean()) for q, values in pooled.items() if windows},
        quartiles={q: np.percentile(v, [25, 50, 75]) for q, v in pooled.items() if windows},
        reasons=tuple(
            dict.fromkeys(
                f"{missing.run}: {missing.reason}"
                for missing in not_evaluated
                if (missing.robot, missing.terrain) == (place.robot, place.terrain)
                and missing.model in (model, "")
            )
        ),
    )
