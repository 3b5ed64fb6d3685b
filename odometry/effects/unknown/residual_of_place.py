"""A part of the motion that follows where the robot is: a map of it."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base_model import Base
from odometry.effects.unknown.residual import Residual
from odometry.errors import ParameterError
from odometry.models.inputs import Inputs
from odometry.parameter_covariance import finite_number

PLACE = "place"
AXES = ("x", "y")


@dataclass(frozen=True)
class ResidualOfPlace(Residual):
    """The same of the measured position: bilinear between the nodes of a square grid.

    Of `Residual`, `variable` is PLACE, a term is a component and the number of a node, and `knots`
    are not used. Where no node is near it adds nothing.

    Attributes
    ----------
    spacing_m : float
        Between neighbouring nodes.
    nodes : tuple of (int, int)
        Each node lies at so many spacings along x and y.
    spread : float
        Standard deviation about zero that is expected of a coefficient: a few windows at a node
        do not determine it.
    axis : str
        "x" or "y": of this coordinate alone, and nodes have 0 as the other; "" of both.
    """

    variable: str = PLACE
    spacing_m: float = 1.0
    nodes: tuple[tuple[int, int], ...] = ()
    spread: float = 0.1
    axis: str = ""

    def __post_init__(self) -> None:
        nodes: object = self.nodes  # a table of a file may hold anything
        if self.variable != PLACE or self.knots:
            raise ParameterError(f"a residual of {self.variable!r} with nodes, expected {PLACE!r}")
        if not isinstance(nodes, tuple) or not all(map(_is_node, nodes)):
            raise ParameterError(f"nodes = {nodes!r}, expected pairs of whole numbers")
        if self.axis not in ("", *AXES):
            raise ParameterError(f"axis = {self.axis!r}, expected one of {', '.join(AXES)}")
        for name, size in (("spacing_m", self.spacing_m), ("spread", self.spread)):
            if not finite_number(size, name) > 0:
                raise ParameterError(f"{name} = {size}, expected more than 0")
        super().__post_init__()

    form = "map"
    equation = "twist + sum of c_ij hat_j(x, y)"
    looks_like = "errors at the same places each time"
    remedy = "look at what lies there: label another terrain, or correct the map of the reference"
    needs = "measured positions"

    @property
    def functions(self) -> int:
        """See `Residual.functions`: one of each node."""
        return len(self.nodes)

    def usual(self, base: Base) -> tuple[FloatArray, FloatArray]:  # noqa: ARG002 - of the interface
        """See `Effect.usual`."""
        count = len(self.parameters)
        return np.zeros(count), np.full(count, self.spread)

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        return "" if inputs.position_m is not None else PLACE

    def bases(self, twist: FloatArray, inputs: Inputs) -> tuple[FloatArray, FloatArray]:  # noqa: ARG002
        """See `Residual.bases`.

        Raises
        ------
        ParameterError
            If no positions were measured.
        """
        if inputs.position_m is None:
            raise ParameterError("the residual is a function of place: no positions were measured")
        hats = self.hats(np.asarray(inputs.position_m))
        return hats, hats

    def hats(self, position_m: FloatArray) -> FloatArray:
        """Weight (N, B) of each node at positions (N, 2)."""
        nodes = np.array(self.nodes, dtype=np.float64).reshape(-1, 2)
        apart = np.abs(position_m[:, None] / self.spacing_m - nodes)
        if self.axis:
            apart = apart[..., [AXES.index(self.axis)]]
        return np.asarray(np.maximum(1.0 - apart, 0.0).prod(axis=-1))

    @property
    def key(self) -> tuple[str, str, str]:
        """See `Effect.key`: a finer map beside a coarse one is another."""
        name, form, by = super().key
        along = f" along {self.axis}" if self.axis else ""
        return name, f"{form}, {self.spacing_m:.3g} m{along}", by

    def settings(self) -> dict[str, Any]:
        """See `Effect.settings`."""
        return {
            "by": self.by,
            "spacing_m": self.spacing_m,
            "nodes": [list(node) for node in self.nodes],
            "spread": self.spread,
            **({"axis": self.axis} if self.axis else {}),
            "terms": [list(term) for term in self.terms],
        }


def _is_node(node: object) -> bool:
    return isinstance(node, tuple) and len(node) == 2 and all(type(one) is int for one in node)
