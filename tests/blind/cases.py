"""Blind cases: a calibration without an effect, and two runs with it, as run folders.

    from tests.blind.cases import KINDS, make_case
    case = make_case("slope_sliding", seed=3, folder=Path("somewhere"), noise=1.0)

Nothing here knows the catalogue of effects: the formulae are written from the papers again.
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tests.blind.contact_cases import CONTACT, make_contact_case
from tests.blind.formula_cases import draw_formula_case
from tests.blind.sensors import record

FORMULA = (
    "slope_sliding",
    "inertia",
    "curvature",
    "wheel_scale",
    "terrain",
    "traction_loss",
    "lateral_skid",
    "time_offset",
    "actuator_lag",
    "lever_arm",
    "heading_offset",
)
UNKNOWN = ("unknown_pull", "unknown_ripple")
NONE = ("none",)
PAIRS = (
    "wheel_scale+time_offset",
    "slope_sliding+lever_arm",
    "terrain+heading_offset",
    "traction_loss+actuator_lag",
    "curvature+lateral_skid",
    "inertia+wheel_scale",
    "heading_offset+actuator_lag",
    "time_offset+lever_arm",
    "slope_sliding+traction_loss",
    "terrain+time_offset",
    "curvature+heading_offset",
    "wheel_scale+lateral_skid",
    "inertia+time_offset",
    "slope_sliding+wheel_scale",
)
KINDS = {
    "formula": FORMULA,
    "contact": tuple(CONTACT),
    "unknown": UNKNOWN,
    "none": NONE,
    "pairs": PAIRS,
}
NAMES = tuple(name for names in KINDS.values() for name in names)


@dataclass(frozen=True)
class Case:
    """A case on disk, and its truth.

    Attributes
    ----------
    kind, seed, noise
        What was asked for; `noise` is a factor of the pose's noise.
    calibration, measured, holdout : Path
        Run folders.
    effects : tuple of str
        Names of the true effects; "unknown" where no catalogue should have it; () where none is.
    truth : dict
        Parameters by effect, and "base": the ICRs of the calibration.
    acceptable : tuple of str
        Other names that would be honest.
    """

    kind: str
    seed: int
    noise: float
    calibration: Path
    measured: Path
    holdout: Path
    effects: tuple[str, ...]
    truth: dict[str, Any]
    acceptable: tuple[str, ...] = field(default=())


def make_case(kind: str, seed: int, folder: Path, noise: float = 1.0) -> Case:
    """Write the three run folders of a case; the noise level changes nothing but the noise."""
    if kind not in NAMES:
        raise ValueError(f"kind = {kind!r}, expected one of {', '.join(NAMES)}")
    rng = np.random.default_rng([seed, *kind.encode()])
    draw = make_contact_case if kind in CONTACT else draw_formula_case
    drawn = draw(kind, rng)
    runs = {
        name: record(Path(folder) / name, motion, drawn.body, effects, rng=rng, noise=noise)
        for name, (motion, effects) in drawn.motions.items()
    }
    return Case(
        kind,
        seed,
        noise,
        **runs,
        effects=drawn.effects,
        truth=drawn.truth,
        acceptable=drawn.acceptable,
    )
