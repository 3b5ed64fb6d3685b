"""How a model is fitted: all parameters at once, or in stages."""

from collections.abc import Mapping
from functools import partial
from typing import Protocol

from odometry.identification.config import SolverConfig
from odometry.identification.fit import Fit, fit
from odometry.identification.slopes import fit_in_two_stages
from odometry.identification.stretch_fit import fit_stretches
from odometry.models.base import KinematicModel
from odometry.run import Robot
from odometry.windows.config import WindowConfig
from odometry.windows.stretches import Stretches
from odometry.windows.windows import Windows


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
