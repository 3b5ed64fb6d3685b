"""Grounds on which tread ICRs and slip differ."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import Base, EffectParameter, MotionEffect, slip_factors, tread_icrs
from odometry.errors import ParameterError
from odometry.models.icr import icr_twist
from odometry.models.inputs import Inputs
from odometry.run import UNKNOWN

SHIFTED = (
    *(("y_left", "m"), ("y_right", "m"), ("x_icr", "m")),
    *(("alpha_left", ""), ("alpha_right", "")),
)
LARGEST = {"m": 3.0, "": 0.9}


@dataclass(frozen=True)
class Terrain(MotionEffect):
    """ICRs and slip factors of each of the named terrains are shifted by its own amounts.

    Attributes
    ----------
    labels : tuple of str
        Grounds unlike the one that the base was identified on.
    """

    labels: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.labels, tuple) or not all(isinstance(n, str) for n in self.labels):
            raise ParameterError(f"labels = {self.labels!r}, expected a list of names")

    name = "terrain"
    form = "icr_by_label"
    equation = "(y_left, y_right, x_icr, alphas) -> the same + shifts of the label"
    source = "Chen 2023, Baril 2020 eq. 7"
    looks_like = "errors that begin and end where the terrain changes"
    needs = "odometry.csv with a column terrain, or runs on several terrains"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return tuple(
            EffectParameter(f"{name}_{label}", unit, -LARGEST[unit], LARGEST[unit], 0.0, 0.01)
            for label in self.labels
            for name, unit in SHIFTED
        )

    def lacks(self, inputs: Inputs, base: Base) -> str:
        """See `Effect.lacks`."""
        if base.model.name != "icr":
            return "a base model with tread ICRs"
        if not self.labels or inputs.terrain is None:
            return "labels of terrain unlike that of the calibration"
        return ""

    def twist(
        self, values: FloatArray, twist: FloatArray, inputs: Inputs, base: Base
    ) -> FloatArray:
        """See `MotionEffect.twist`: the difference that the shifts make to the base."""
        if inputs.terrain is None:
            return twist
        icrs, alphas = tread_icrs(base, self.name), slip_factors(base)
        moved = twist.copy()
        for shift, label in zip(values.reshape(-1, len(SHIFTED)), self.labels, strict=True):
            here = inputs.terrain == label
            speeds = inputs.tread_speeds_m_s[here]
            moved[here] += icr_twist(icrs + shift[:3], (alphas + shift[3:]) * speeds)
            moved[here] -= icr_twist(icrs, alphas * speeds)
        return moved

    def settings(self) -> dict[str, Any]:
        """See `Effect.settings`."""
        return {"labels": list(self.labels)}


def new_labels(inputs: Inputs, calibrated: set[str]) -> tuple[str, ...]:
    """Grounds of a recording that the calibration has not seen, by name."""
    if inputs.terrain is None:
        return ()
    return tuple(sorted(set(np.unique(inputs.terrain.astype(str))) - calibrated - {UNKNOWN, ""}))
