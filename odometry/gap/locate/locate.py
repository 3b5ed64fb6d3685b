"""Where simulation and measurement disagree: what predicts the excess, and in which regions."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats.contingency import association, crosstab

from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.gap.config import GapConfig
from odometry.gap.locate.predictors import Predictor, groups_of, predictors
from odometry.gap.locate.regions import Region, regions
from odometry.gap.locate.variables import Variable, window_variables
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.end_residuals import ends_of
from odometry.windows.dense.dense import DenseWindows

__all__ = ["Location", "Predictor", "Region", "locate"]

ALIKE = 0.5  # Cramer's V from which two variables are taken as one
SHOWN = 2  # variables of a map
# Of two alike and about as strong, the one that stands first is the one that a person reads more
# easily. "turn" is in "omega".
PLAIN = (
    *("speed", "omega", "roll", "pitch", "terrain", "heading", "time", "speed_change"),
    *("speed_before", "lateral_acceleration", "speed_difference", "curvature"),
    *("left_wheel_angle", "right_wheel_angle"),
)


@dataclass(frozen=True)
class Location:
    """What predicts the gap, and where it is.

    Attributes
    ----------
    predictors : tuple of Predictor
        All variables that were recorded and varied; strongest discoveries first.
    regions : tuple of Region
        Largest share of the excess first; none where the gap is nowhere above the noise floor.
    strongest : tuple of str
        Up to two variables over which the gap varies most, not correlated with each other.
    """

    predictors: tuple[Predictor, ...]
    regions: tuple[Region, ...]
    strongest: tuple[str, ...]


def locate(
    base: Base,
    effects: Sequence[Added],
    scenes: Sequence[DenseWindows],
    floor_m: float,
    config: GapConfig,
    *,
    calibration: Calibration,
) -> Location:
    """Test which variables predict the residuals, and bound the regions of the excess.

    The excess of a window is its squared position error at the end less what noise and the
    uncertainty of the calibration explain of it. Regions are bounds of discovered variables.

    Parameters
    ----------
    base, effects
        The simulation.
    scenes : sequence of DenseWindows
        Measured runs.
    floor_m : float
        The noise floor: the RMS position error on held-back stretches of the calibration.
    config : GapConfig
    calibration : Calibration
        Gives the error that noise explains in each window, and the covariance of the base.
    """
    ends = ends_of(base, effects, scenes, calibration, config.part_s)
    variables = {v.name: v for v in window_variables(base, effects, scenes)}
    found = predictors(tuple(variables.values()), ends)
    readable = sorted(
        (one for one in found if one.name in PLAIN),
        key=lambda one: (not one.discovered, -round(one.strength, 1), PLAIN.index(one.name)),
    )
    discovered = [variables[one.name] for one in readable if one.discovered]
    strongest = _unlike([variables[one.name] for one in readable])[:SHOWN]
    return Location(
        found, regions(_unlike(discovered), ends, floor_m), tuple(v.name for v in strongest)
    )


def _unlike(variables: Sequence[Variable]) -> list[Variable]:
    """Those that vary and are not associated with one before them."""
    kept: list[Variable] = []
    for variable in variables:
        groups = groups_of(variable)
        if len(np.unique(groups)) > 1 and all(
            association(crosstab(groups, groups_of(o)).count) < ALIKE for o in kept
        ):
            kept.append(variable)
    return kept
