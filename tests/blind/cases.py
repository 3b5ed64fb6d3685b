"""Blind cases: a calibration without an effect, and two runs with it, as run folders.

    from tests.blind.cases import KINDS, make_case
    case = make_case("slope_sliding", seed=3, folder=Path("somewhere"), noise=1.0)

Nothing here uses the catalogue of effects: the formulae are written from the papers again.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tests.blind.contact_cases import CONTACT, make_contact_case
from tests.blind.formula_cases import draw_formula_case
from tests.blind.hidden.catalogue import GROUPS, HIDDEN
from tests.blind.hidden.draw import draw_hidden_case
from tests.blind.hidden.recorded import record as record_hidden
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
# What the effects of the papers are in plain words.
PLAIN = {
    "slope_sliding": "slope",
    "inertia": "inertia",
    "curvature": "turn radius",
    "wheel_scale": "wheel size",
    "terrain": "terrain",
    "traction_loss": "traction",
    "lateral_skid": "sideways",
    "time_offset": "late stamps",
    "actuator_lag": "slow drive",
    "lever_arm": "sensor place",
    "heading_offset": "sensor heading",
    "unknown": "unknown",
    "none": "none",
}
# What no data of these cases distinguish from it: a reference that drifts, a gust or current.
ALIKE = {"unknown_pull": ("reference",)}
KINDS = {
    "formula": FORMULA,
    "contact": tuple(CONTACT),
    "unknown": UNKNOWN,
    "none": NONE,
    "pairs": PAIRS,
    **{group: tuple(kinds) for group, kinds in GROUPS.items()},
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
        Names of other effects that mislead nobody.
    parts : tuple of tuples of str
        The truth in plain words: for each effect, the families of answers that are right.
    acceptable_families : tuple of str
        Families of answers that mislead nobody, "family course" where the course is needed.
    course : str
        Course in time of the truth, or "".
    gyroscope : bool
        Whether one is recorded.
    """

    kind: str
    seed: int
    noise: float
    calibration: Path
    measured: Path
    holdout: Path
    effects: tuple[str, ...]
    truth: dict[str, Any]
    acceptable: tuple[str, ...] = ()
    parts: tuple[tuple[str, ...], ...] = ()
    acceptable_families: tuple[str, ...] = ()
    course: str = ""
    gyroscope: bool = True


def make_case(kind: str, seed: int, folder: Path, noise: float = 1.0) -> Case:
    """Write the three run folders of a case; the noise level changes nothing but the noise."""
    if kind not in NAMES:
        raise ValueError(f"kind = {kind!r}, expected one of {', '.join(NAMES)}")
    make = _hidden_case if kind in HIDDEN else _paper_case
    return make(kind, seed, Path(folder), noise, np.random.default_rng([seed, *kind.encode()]))


def _paper_case(kind, seed, folder, noise, rng):
    draw = make_contact_case if kind in CONTACT else draw_formula_case
    drawn = draw(kind, rng)
    runs = {
        name: record(folder / name, motion, drawn.body, effects, rng=rng, noise=noise)
        for name, (motion, effects) in drawn.motions.items()
    }
    return Case(
        *(kind, seed, noise),
        **runs,
        effects=drawn.effects,
        truth=drawn.truth,
        acceptable=drawn.acceptable,
        parts=tuple((PLAIN[name],) for name in drawn.effects),
        acceptable_families=(*(PLAIN[name] for name in drawn.acceptable), *ALIKE.get(kind, ())),
        course="from_a_moment" if kind == "traction_loss" else "",
    )


def _hidden_case(kind, seed, folder, noise, rng):
    row = HIDDEN[kind]
    drawn = draw_hidden_case(row, rng)
    runs = {
        name: record_hidden(folder / name, motion, drawn.scene, rng=rng, noise=noise)
        for name, motion in drawn.motions.items()
    }
    gyroscope = bool(drawn.scene.sensors.gyroscope)
    return Case(
        *(kind, seed, noise),
        **runs,
        effects=tuple(part[0] for part in row.true),
        truth=drawn.truth,
        parts=row.true,
        acceptable_families=(*row.acceptable, *(() if gyroscope else row.without_gyroscope)),
        course=row.course,
        gyroscope=gyroscope,
    )
