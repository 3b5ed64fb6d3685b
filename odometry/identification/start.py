"""How parameters are searched: settings, where the search starts, and which are free."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.config import require, require_positive
from odometry.errors import IdentificationError, ParameterError
from odometry.models.base import KinematicModel
from odometry.recording.run import Robot

LOSSES = ("huber", "squares", "linear")


@dataclass(frozen=True)
class SolverConfig:
    """How parameters are searched.

    Attributes
    ----------
    loss : str
        "huber": squared Mahalanobis distances by the covariance that the poses' noise gives each
        window, windows far above the others weighing less; "squares": the same, all windows in
        full; "linear": Baril 2020 eq. 13 with the identity covariance, as the paper has it (a
        metre of position weighs as a radian of yaw).
    starts : int
        Searches from different values; the best one counts.
    seed : int
        Of the further starts.
    undetermined : float
        A combination of parameters is undetermined where its standard deviation is above this
        many of the parameters' ordinary sizes.

    Examples
    --------
    >>> import odometry
    >>> odometry.SolverConfig(starts=1).loss
    'huber'
    """

    loss: str = "huber"
    starts: int = 4
    seed: int = 0
    undetermined: float = 1.0

    def __post_init__(self) -> None:
        require(self.loss in LOSSES, f"loss = {self.loss!r}, expected one of {', '.join(LOSSES)}")
        require(self.starts >= 1, f"starts = {self.starts}, expected 1 or more")
        require_positive(self, "undetermined")


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
