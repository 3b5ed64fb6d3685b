"""Parts of the motion that no named effect explains: smooth functions of one variable."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import EffectParameter, MotionEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.unknown.residual_variables import (
    ANGLES,
    HARMONICS,
    OF_TREADS,
    SIMULATED,
    VARIABLES,
    bases_of_treads,
    basis_of,
    variable_of,
    variables_of,
)
from odometry.errors import ParameterError
from odometry.models.inputs import Inputs
from odometry.parameter_covariance import finite_number

__all__ = [
    "ANGLES",
    "HARMONICS",
    "OF_TREADS",
    "VARIABLES",
    "Residual",
    "basis_of",
    "variable_of",
    "variables_of",
]

COMPONENTS = ("v_x", "v_y", "omega")  # of the twist
WORLD = ("world_x", "world_y")  # of a velocity over the world, along the axes of the reference
TREADS = ("left", "right")  # their speeds
CARRIERS = ("", "speed", "v_x", "omega")
UNITS = {"": "m/s", "speed": "", "v_x": "", "omega": "m/rad"}  # of what is added to a velocity


@dataclass(frozen=True)
class Residual(MotionEffect):
    """Adds a smooth function of one variable to components of the motion, or to tread speeds.

    Of an angle it is a Fourier series, else piecewise linear between knots.

    Attributes
    ----------
    variable : str
        A name of `variables_of`, or one of `FURTHER`.
    terms : tuple of (str, int)
        Component of the twist or of a velocity over the world, or "left" or "right" of the
        treads, and number of the basis function.
    by : str
        What it is multiplied by: "" nothing, "v_x" or "omega" that part of the twist, "speed" the
        speed: that of the wheels whose angle it is, that of the tread that it is added to, else
        the mean of both treads' magnitudes.
    knots : tuple of float
        Of the piecewise linear functions, increasing; empty for an angle.
    """

    variable: str
    terms: tuple[tuple[str, int], ...] = ()
    by: str = ""
    knots: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        variable: object = self.variable  # a table of a file may hold anything
        if not isinstance(variable, str):
            raise ParameterError(f"variable = {variable!r}, expected a name")
        if self.by not in CARRIERS:
            raise ParameterError(f"by = {self.by!r}, expected one of {', '.join(CARRIERS[1:])}")
        knots = [finite_number(knot, "knots: one") for knot in self.knots]
        if sorted(set(knots)) != knots:
            raise ParameterError(f"knots = {knots}, expected increasing numbers")
        for term in self.terms:
            known = TREADS if self.variable in OF_TREADS else (*COMPONENTS, *WORLD, *TREADS)
            if len(term) != 2 or term[0] not in known or term[1] not in range(self.functions):
                raise ParameterError(
                    f"the residual has a term {term!r}, expected one of {', '.join(known)} "
                    f"and a number below {self.functions}"
                )

    name = "unknown"
    form = "residual"
    in_words = "a cause that the catalogue does not have"
    equation = "twist + sum of c_ij basis_j(variable)"
    source = "none: no effect of the catalogue explains it"
    looks_like = "errors that follow the variable"
    remedy = "look for a cause that depends on its variable"
    needs = "the variable"

    @property
    def functions(self) -> int:
        """How many basis functions there are."""
        return len(self.knots) or 2 * HARMONICS + 1

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        turning = {"": "rad/s", "speed": "rad/m", "v_x": "rad/m", "omega": ""}
        return tuple(
            EffectParameter(
                f"{component}_{number}",
                turning[self.by] if component == "omega" else UNITS[self.by],
                -10.0,
                10.0,
                0.0,
                0.01,
            )
            for component, number in self.terms
        )

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        known = self.variable in SIMULATED or variable_of(self.variable, inputs, None) is not None
        return "" if known else self.variable

    def twist(
        self,
        values: FloatArray,
        twist: FloatArray,
        inputs: Inputs,
        base: Base,
    ) -> FloatArray:
        """See `MotionEffect.twist`; what is added to treads is a change to first order.

        Raises
        ------
        ParameterError
            If the variable was not recorded.
        """
        return np.asarray(twist + np.tensordot(values, self.columns(twist, inputs, base), axes=1))

    @property
    def answers_to(self) -> str:
        """See `MotionEffect.answers_to`; treads go through the base."""
        if self.variable in SIMULATED or self.by not in ("", "speed"):
            return "twist"
        return "base" if any(component in TREADS for component, _ in self.terms) else ""

    def columns(self, twist: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """What one of each term adds to the twist (P, N, 3).

        Raises
        ------
        ParameterError
            If the variable was not recorded.
        """
        bases = self.bases(twist, inputs)
        names = {name for name, _ in self.terms}
        directions = {name: self._direction(name, twist, inputs, base) for name in names}
        made = np.zeros((3, len(self.terms), len(twist)))
        for place, (component, number) in enumerate(self.terms):
            basis = bases[int(component == TREADS[1])][:, number]
            for part, direction in enumerate(directions[component].T):
                if component not in COMPONENTS or component == COMPONENTS[part]:
                    np.multiply(basis, direction, out=made[part, place])
        return np.moveaxis(made, 0, -1)

    def bases(self, twist: FloatArray, inputs: Inputs) -> tuple[FloatArray, FloatArray]:
        """Basis functions (N, B) for the left and the right tread.

        Raises
        ------
        ParameterError
            If the variable was not recorded.
        """
        variable = variable_of(self.variable, inputs, twist)
        if variable is None:
            raise ParameterError(
                f"the residual is a function of {self.variable!r}, which was not recorded; there "
                f"are {', '.join(variables_of(inputs, twist))}"
            )
        return bases_of_treads(variable, self.knots)

    def _direction(
        self, component: str, twist: FloatArray, inputs: Inputs, base: Base
    ) -> FloatArray:
        """What one more of a component adds to the twist (N, 3)."""
        direction = np.zeros(twist.shape[::-1]).T
        if component in TREADS:
            tread = TREADS.index(component)
            direction += base.model.speed_jacobian(base.values, inputs)[..., tread]
            own = inputs.tread_speeds_m_s[:, tread]
            return direction * own[:, None] if self.by == "speed" else direction
        if component in WORLD:
            heading = inputs.heading_rad
            if heading is None:
                raise ParameterError(f"{component} of a residual: no heading was recorded")
            turned = heading - np.pi / 2 * WORLD.index(component)
            direction[:, :2] = np.stack([np.cos(turned), -np.sin(turned)], axis=-1)
        else:
            direction[:, COMPONENTS.index(component)] = 1.0
        return direction * self._carrier(twist, inputs)[:, None] if self.by else direction

    def _carrier(self, twist: FloatArray, inputs: Inputs) -> FloatArray:
        if self.by == "speed":
            return _speed(self.variable, inputs)
        return np.asarray(twist[:, COMPONENTS.index(self.by)])

    @property
    def key(self) -> tuple[str, str, str]:
        """See `Effect.key`: of each variable, what it is added to and what with, another."""
        added_to = " ".join(dict.fromkeys(component for component, _ in self.terms))
        return self.name, f"{self.form} of {self.variable} to {added_to}", self.by

    def settings(self) -> dict[str, Any]:
        """See `Effect.settings`."""
        return {
            "variable": self.variable,
            "by": self.by,
            "knots": list(self.knots),
            "terms": [list(term) for term in self.terms],
        }


def _speed(variable: str, inputs: Inputs) -> FloatArray:
    own = {
        "wheel_angle": (inputs.left + inputs.right) / 2,
        "left_wheel_angle": inputs.left,
        "right_wheel_angle": inputs.right,
    }
    return np.asarray(own.get(variable, np.abs(inputs.tread_speeds_m_s).mean(axis=-1)))
