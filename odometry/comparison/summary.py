"""Errors of each model by robot, ground and horizon."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.comparison.judgement import Judgement, Shortfall
from odometry.windows.window_errors import WindowErrors

# Quantity to unit. Angles are degrees in everything that a comparison states.
QUANTITIES = {"translation": "m per m", "rotation": "degrees per m"}


@dataclass(frozen=True)
class Place:
    """Where models are compared: one robot on one ground over one horizon."""

    robot: str
    ground: str
    horizon_m: float

    @property
    def title(self) -> str:
        """The place in words."""
        return f"{self.robot} on {self.ground}, over {self.horizon_m:g} m"

    def holds(self, judgement: Judgement) -> bool:
        """Whether a judgement belongs here."""
        return (judgement.robot, judgement.ground, judgement.horizon_m) == (
            self.robot,
            self.ground,
            self.horizon_m,
        )


@dataclass(frozen=True)
class Summary:
    """Errors of one model at one place.

    Attributes
    ----------
    place : Place
    model : str
    seen : tuple of str
        What it had seen, once for each split.
    runs : tuple of str
        That it was judged on.
    windows : int
    complete : bool
        Whether it was judged on all windows of the place.
    means : Mapping of quantity to float
    quartiles : Mapping of quantity to (3,)
    reasons : tuple of str
        Why it was not judged on some run.
    """

    place: Place
    model: str
    seen: tuple[str, ...]
    runs: tuple[str, ...]
    windows: int
    complete: bool
    means: dict[str, float]
    quartiles: dict[str, FloatArray]
    reasons: tuple[str, ...]


def values_of(errors: WindowErrors, quantity: str) -> FloatArray:
    """Errors (K,) in the unit of `QUANTITIES`."""
    if quantity == "translation":
        return errors.translation_per_m
    return np.degrees(errors.rotation_per_m)


def summarise(
    place: Place, judgements: Sequence[Judgement], shortfalls: Sequence[Shortfall], model: str
) -> Summary:
    """Pool the windows of one model over the judgements of a place."""
    here = [judgement for judgement in judgements if model in judgement.errors]
    pooled = {
        quantity: np.concatenate(
            [np.empty(0), *(values_of(each.errors[model], quantity) for each in here)]
        )
        for quantity in QUANTITIES
    }
    windows = sum(len(judgement.judged) for judgement in here)
    return Summary(
        place=place,
        model=model,
        seen=tuple(dict.fromkeys(judgement.seen for judgement in here)),
        runs=tuple(dict.fromkeys(judgement.run for judgement in here)),
        windows=windows,
        complete=0 < windows == sum(len(judgement.judged) for judgement in judgements),
        means={q: float(values.mean()) for q, values in pooled.items() if windows},
        quartiles={q: np.percentile(v, [25, 50, 75]) for q, v in pooled.items() if windows},
        reasons=tuple(
            f"{shortfall.run}: {shortfall.reason}"
            for shortfall in shortfalls
            if (shortfall.robot, shortfall.ground) == (place.robot, place.ground)
            and shortfall.model in (model, "")
        ),
    )
