"""Where the search for the parameters of a model starts, and which of them are free."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.errors import IdentificationError, ParameterError
from odometry.identification.config import SolverConfig
from odometry.models.base import KinematicModel
from odometry.run import Robot


@dataclass(frozen=True)
class Start:
    """What a search begins with.

    Attributes
    ----------
    model : KinematicModel
    values : (P,)
        Of all parameters: fixed ones, else near ones, else guessed.
    free : (P,) of bool
        Parameters that are neither fixed nor known.
    sizes : (P,)
        Their ordinary sizes.
    solver_config : SolverConfig
        One search where values near the answer were given.
    """

    model: KinematicModel
    values: FloatArray
    free: BoolArray
    sizes: FloatArray
    solver_config: SolverConfig

    @property
    def in_sign(self) -> BoolArray:
        """Free parameters (P,) that act through a sign alone."""
        return np.asarray(
            self.free & np.array([parameter.in_sign for parameter in self.model.parameters])
        )

    @property
    def by_name(self) -> dict[str, float]:
        """The values by the parameters' names."""
        return by_name(self.model, self.values)

    def require_numbers(self, count: int, noun: str, per_window: int) -> None:
        """Raise IdentificationError where windows measure no more numbers than are free."""
        if per_window * count <= self.free.sum():
            raise IdentificationError(
                f"{count} {noun} do not determine {int(self.free.sum())} parameters of "
                f"{self.model.name!r}"
            )


def start_of(
    model: KinematicModel,
    robot: Robot,
    *,
    fixed: Mapping[str, float],
    released: frozenset[str],
    near: Mapping[str, float] | None,
    solver_config: SolverConfig,
) -> Start:
    """The start of a search; parameters are those of `fit`.

    Raises
    ------
    ParameterError
        If a name is no parameter of the model, or both fixed and released; or a fixed value is
        out of bounds.
    """
    names = {parameter.name for parameter in model.parameters}
    for name in sorted({*fixed, *released} - names):
        raise ParameterError(
            f"{name!r} is no parameter of {model.name!r}; it has {', '.join(sorted(names))}"
        )
    for name in sorted(released & set(fixed)):
        raise ParameterError(f"{name!r} is both fixed and free; expected one of them")
    return Start(
        model,
        model.pack({**model.guess(robot), **(near or {}), **fixed}),
        np.array(
            [p.name not in fixed and (not p.known or p.name in released) for p in model.parameters]
        ),
        model.ordinary_sizes(robot),
        solver_config if near is None else replace(solver_config, starts=1),
    )


def by_name(model: KinematicModel, values: FloatArray) -> dict[str, float]:
    """Parameters (P,) by their names."""
    return {p.name: float(value) for p, value in zip(model.parameters, values, strict=True)}
