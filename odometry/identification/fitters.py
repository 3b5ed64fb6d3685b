"""Which model is identified on which terrain, and how: all parameters at once, or in stages."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol

from odometry.effects.tables import model_of
from odometry.errors import ParameterError
from odometry.identification.fit import Fit, fit
from odometry.identification.slopes import fit_in_two_stages
from odometry.identification.start import SolverConfig
from odometry.identification.stretch_fit import fit_stretches
from odometry.models.base import KinematicModel
from odometry.models.catalogue import model_named
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.run import Robot
from odometry.windows.config import WindowConfig
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.windows import Windows

Wanted = str | KinematicModel | ParameterSet


@dataclass(frozen=True)
class TerrainModel:
    """The model that is identified on one terrain.

    Attributes
    ----------
    model : KinematicModel
    known : Mapping of name to float
        Parameters that a set states of what is measured on the robot.
    """

    model: KinematicModel
    known: Mapping[str, float] = field(default_factory=dict)


def model_on_terrain(terrain: str, wanted: Wanted, robot: Robot) -> TerrainModel:
    """Find the model for a terrain: of a parameter set that of its table, with its effects fixed.

    A set with one table is for every terrain.

    Raises
    ------
    ParameterError
        If there is no such model or effect, or a set with several tables has none of the terrain.
    """
    if isinstance(wanted, KinematicModel):
        return TerrainModel(wanted)
    if isinstance(wanted, str):
        return TerrainModel(model_named(wanted))
    name, table = _table(terrain, wanted)
    model = model_of(table, robot, f"[terrain.{name}]")
    known = {p.name for p in model.parameters if p.known}
    return TerrainModel(model, {key: value for key, value in table.values.items() if key in known})


def _table(terrain: str, parameters: ParameterSet) -> tuple[str, TerrainParameters]:
    terrains = parameters.terrains
    if len(terrains) == 1:
        return next(iter(terrains.items()))
    if terrain not in terrains:
        raise ParameterError(f"the set has no terrain {terrain!r}; it has {', '.join(terrains)}")
    return terrain, terrains[terrain]


class FitTo(Protocol):
    """Fits one model to windows or stretches; `near` saves searching far, see `fit`."""

    def __call__(
        self, windows: Windows | Stretches, near: Mapping[str, float] | None = None
    ) -> Fit:
        """The fit."""


def fitter(
    model: KinematicModel,
    robot: Robot,
    *,
    fixed: Mapping[str, float],
    released: frozenset[str] = frozenset(),
    window_config: WindowConfig,
    solver_config: SolverConfig,
) -> FitTo:
    """The function that fits a model to windows, in its `stages` if any, or to stretches."""
    fit_with = partial(fit_in_two_stages, stages=model.stages) if model.stages else fit

    def fit_to(windows: Windows | Stretches, near: Mapping[str, float] | None = None) -> Fit:
        if isinstance(windows, Stretches):
            return fit_stretches(
                model,
                windows,
                robot,
                fixed=fixed,
                released=released,
                near=near,
                solver_config=solver_config,
            )
        return fit_with(
            model,
            windows,
            robot,
            fixed=fixed,
            released=released,
            near=near,
            window_config=window_config,
            solver_config=solver_config,
        )

    return fit_to
