"""Terrains on which tread ICRs and slip differ."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import Effect, EffectParameter, MotionEffect
from odometry.effects.interface.base_model import Base, slip_factors, tread_icrs
from odometry.effects.interface.recorded import Recorded
from odometry.effects.motion.lateral_skid import DISTINGUISHED_BY
from odometry.errors import ParameterError
from odometry.models.icr import icr_twist
from odometry.models.inputs import Inputs

SHIFTED = (
    *(("y_left", "m"), ("y_right", "m"), ("x_icr", "m")),
    *(("alpha_left", ""), ("alpha_right", "")),
)
BOUNDS = {"m": (-3.0, 3.0), "": (-0.9, 0.3)}  # no terrain carries a robot much beyond its treads


@dataclass(frozen=True)
class Terrain(MotionEffect):
    """ICRs and slip factors of each of the named terrains are shifted by its own amounts.

    Attributes
    ----------
    labels : tuple of str
        Terrains unlike the one that the base was identified on.
    apart_m : float, optional
        How far the tread ICRs of the base are apart, where that is known.
    """

    labels: tuple[str, ...] = ()
    apart_m: float | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        if not isinstance(self.labels, tuple) or not all(isinstance(n, str) for n in self.labels):
            raise ParameterError(f"labels = {self.labels!r}, expected a list of names")

    name = "terrain"
    form = "icr_by_label"
    in_words = "terrain on which the robot turns and slips otherwise"
    equation = "(y_left, y_right, x_icr, alphas) -> the same + shifts of the label"
    source = "Chen 2023, Baril 2020 eq. 7"
    looks_like = "errors that begin and end where the terrain changes"
    remedy = "identify a parameter set for each terrain"
    needs = "odometry.csv with a column terrain, or runs on several terrains"

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """Those that the calibration does not have, together, and each that it has by itself.

        One that it has and that is everywhere is a set for whole runs, see `NewIcrs`.
        """
        new = tuple(label for label in recorded.labels if label not in recorded.calibrated)
        changed = [label for label in recorded.labels if label in recorded.calibrated]
        if changed and recorded.is_on_one_terrain:
            return ()
        apart_m = icrs_apart_m(recorded.base)
        news = [cls(new, apart_m)] if new else []
        return (*news, *(cls((label,), apart_m) for label in changed))

    def is_meant(self, values: FloatArray) -> bool:
        """See `Effect.is_meant`: on no terrain a robot turns against its treads."""
        return all(turns_with_treads(s, self.apart_m) for s in values.reshape(-1, len(SHIFTED)))

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return tuple(
            EffectParameter(f"{name}_{label}", unit, *BOUNDS[unit], 0.0, 0.01)
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
            moved[here] += shifted_by(shift, icrs, alphas, inputs.tread_speeds_m_s[here])
        return moved

    def settings(self) -> dict[str, Any]:
        """See `Effect.settings`."""
        return {"labels": list(self.labels)}


class NewIcrs(MotionEffect):
    """ICRs and slip factors of whole runs are shifted: another terrain, whatever its name.

    Parameters
    ----------
    apart_m : float, optional
        How far the tread ICRs of the base are apart, where that is known.
    """

    name = "terrain"
    form = "icr_set"
    in_words = "a terrain on which the robot turns and slips otherwise throughout"
    equation = "(y_left, y_right, x_icr, alphas) -> the same + shifts"
    source = "Chen 2023, Baril 2020 eq. 7"
    looks_like = "a model that is off in every turn of a run, always by the same share"
    remedy = "identify a parameter set on this terrain"
    includes: ClassVar[Mapping[str, str]] = {
        "lever_arm": DISTINGUISHED_BY,
        "lateral_skid": DISTINGUISHED_BY,
        "wheel_scale": "a run on the terrain of the calibration, or wheels measured with a tape",
    }

    def __init__(self, apart_m: float | None = None) -> None:
        self.apart_m = apart_m

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """Beside the ICRs of the base."""
        return (cls(icrs_apart_m(recorded.base)),)

    def is_meant(self, values: FloatArray) -> bool:
        """See `Effect.is_meant`: on no terrain a robot turns against its treads."""
        return turns_with_treads(values, self.apart_m)

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return tuple(
            EffectParameter(name, unit, *BOUNDS[unit], 0.0, 0.01) for name, unit in SHIFTED
        )

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        return "" if base.model.name == "icr" else "a base model with tread ICRs"

    def twist(
        self, values: FloatArray, twist: FloatArray, inputs: Inputs, base: Base
    ) -> FloatArray:
        """See `MotionEffect.twist`: the difference that the shifts make to the base."""
        icrs, alphas = tread_icrs(base, self.name), slip_factors(base)
        return np.asarray(twist + shifted_by(values, icrs, alphas, inputs.tread_speeds_m_s))


def icrs_apart_m(base: Base) -> float | None:
    """How far the tread ICRs of a base are apart; None where it has none."""
    if base.model.name != "icr":
        return None
    left, right, _ = tread_icrs(base, Terrain.name)
    return float(left - right)


def turns_with_treads(shift: FloatArray, apart_m: float | None) -> bool:
    """Whether the left ICR stays to the left of the right one."""
    return apart_m is None or bool(apart_m + shift[0] - shift[1] > 0)


def shifted_by(
    shift: FloatArray, icrs: FloatArray, alphas: FloatArray, speeds_m_s: FloatArray
) -> FloatArray:
    """What a shift (5,) of ICRs (3,) and slip factors (2,) changes of the twist (N, 3)."""
    return np.asarray(
        icr_twist(icrs + shift[:3], (alphas + shift[3:]) * speeds_m_s)
        - icr_twist(icrs, alphas * speeds_m_s)
    )
