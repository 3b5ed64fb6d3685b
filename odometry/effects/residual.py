"""A part of the motion that no named effect explains: a smooth function of one variable."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import EffectParameter, MotionEffect
from odometry.effects.base_model import Base
from odometry.errors import ParameterError
from odometry.models.inputs import Inputs
from odometry.parameter_covariance import finite_number

HARMONICS = 2
COMPONENTS = ("v_x", "v_y", "omega")
ANGLES = ("heading", "wheel_angle", "left_wheel_angle", "right_wheel_angle")


@dataclass(frozen=True)
class Residual(MotionEffect):
    """Adds a smooth function of one variable to some components of the twist.

    Of an angle it is a Fourier series, else piecewise linear between knots.

    Attributes
    ----------
    variable : str
        A name of `variables_of`.
    terms : tuple of (str, int)
        Component of the twist, and number of the basis function.
    by_speed : bool
        Whether it grows with speed: that of the wheels whose angle it is, else the mean of both
        treads' magnitudes. Else it is there at any speed.
    knots : tuple of float
        Of the piecewise linear functions, increasing; empty for an angle.
    """

    variable: str
    terms: tuple[tuple[str, int], ...] = ()
    by_speed: bool = False
    knots: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        variable: object = self.variable  # a table of a file may hold anything
        if not isinstance(variable, str):
            raise ParameterError(f"variable = {variable!r}, expected a name")
        knots = [finite_number(knot, "knots: one") for knot in self.knots]
        if sorted(set(knots)) != knots:
            raise ParameterError(f"knots = {knots}, expected increasing numbers")
        functions = len(self.knots) or 2 * HARMONICS
        for term in self.terms:
            if len(term) != 2 or term[0] not in COMPONENTS or term[1] not in range(functions):
                raise ParameterError(
                    f"the residual has a term {term!r}, expected one of {', '.join(COMPONENTS)} "
                    f"and a number below {functions}"
                )

    name = "unknown"
    form = "residual"
    in_words = "a cause that the catalogue does not have"
    equation = "twist + sum of c_ij basis_j(variable)"
    source = "none: no effect of the catalogue explains it"
    looks_like = "errors that follow the variable"
    remedy = "look for what depends on this variable"
    needs = "the variable"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        unit = {"v_x": "m/s", "v_y": "m/s", "omega": "rad/s"}
        return tuple(
            EffectParameter(
                f"{component}_{number}",
                "" if self.by_speed and component != "omega" else unit[component],
                -10.0,
                10.0,
                0.0,
                0.01,
            )
            for component, number in self.terms
        )

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the face
        """See `Effect.lacks`."""
        return "" if self.variable in variables_of(inputs) else self.variable

    def twist(
        self,
        values: FloatArray,
        twist: FloatArray,
        inputs: Inputs,
        base: Base,  # noqa: ARG002 - of the face
    ) -> FloatArray:
        """See `MotionEffect.twist`; nothing is added while the treads stand still."""
        recorded = variables_of(inputs)
        if self.variable not in recorded:
            raise ParameterError(
                f"the residual is a function of {self.variable!r}, which was not recorded; there "
                f"are {', '.join(recorded)}"
            )
        basis = basis_of(recorded[self.variable], self.knots)
        weight = _speed(self.variable, inputs) if self.by_speed else np.ones(len(twist))
        added = np.zeros_like(twist)
        for (component, number), value in zip(self.terms, values, strict=True):
            added[:, COMPONENTS.index(component)] += value * weight * basis[:, number]
        return np.asarray(twist + added)

    def settings(self) -> dict[str, Any]:
        """See `Effect.settings`."""
        return {
            "variable": self.variable,
            "by_speed": self.by_speed,
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


def variables_of(inputs: Inputs) -> dict[str, FloatArray]:
    """What a residual may depend on (N,), of what was recorded."""
    left, right = inputs.left, inputs.right
    found = {
        "speed": (left + right) / 2,
        "speed_difference": right - left,
        "roll": inputs.roll_rad,
        "pitch": inputs.pitch_rad,
    }
    if inputs.time_s is not None:
        found["time"] = inputs.time_s
    if inputs.heading_rad is not None:
        found["heading"] = inputs.heading_rad
    if inputs.wheel_angles_rad is not None:
        found["wheel_angle"] = inputs.wheel_angles_rad.mean(axis=-1)
        found["left_wheel_angle"] = inputs.wheel_angles_rad[..., 0]
        found["right_wheel_angle"] = inputs.wheel_angles_rad[..., 1]
    return found


def basis_of(variable: FloatArray, knots: tuple[float, ...]) -> FloatArray:
    """Basis functions (N, B): hats on the knots, or sines and cosines without any."""
    if knots:
        return np.stack([np.interp(variable, knots, hat) for hat in np.eye(len(knots))], axis=-1)
    return np.stack(
        [wave(k * variable) for k in range(1, HARMONICS + 1) for wave in (np.cos, np.sin)], axis=-1
    )
