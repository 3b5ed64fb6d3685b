"""The way of fitting that a model asks for: all parameters at once, or in stages."""

from collections.abc import Mapping
from functools import partial
from typing import Protocol

from odometry.identification.config import SolverConfig
from odometry.identification.fit import Fit, fit
from odometry.identification.slopes import fit_in_two_stages
from odometry.models.base import KinematicModel
from odometry.run import Robot
from odometry.windows.config import WindowConfig
from odometry.windows.windows import Windows


class FitTo(Protocol):
    """Fits one model to windows; `near` saves searching far, see `fit`."""

    def __call__(self, windows: Windows, near: Mapping[str, float] | None = None) -> Fit:
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
    """The function that fits a model to windows, in its `stages` where it has any."""
    fit_with = partial(fit_in_two_stages, stages=model.stages) if model.stages else fit

    def fit_to(windows: Windows, near: Mapping[str, float] | None = None) -> Fit:
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
