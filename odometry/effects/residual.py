"""A part of the motion that no named effect explains: a smooth function of one variable."""

from collections.abc import Callable, Mapping
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
COMPONENTS = ("v_x", "v_y", "omega")  # of the twist
TREADS = ("left", "right")  # their speeds
ANGLES = ("heading", "wheel_angle", "left_wheel_angle", "right_wheel_angle")
OF_TREADS = ("tread_speed", "tread_acceleration")  # variables (N, 2): of each tread its own
ACCELERATION_OVER_S = 0.2
CREEPING_M_S = 0.05  # below this forward speed a curvature is taken as at it


@dataclass(frozen=True)
class Residual(MotionEffect):
    """Adds a smooth function of one variable to components of the twist, or to tread speeds.

    Of an angle it is a Fourier series, else piecewise linear between knots.

    Attributes
    ----------
    variable : str
        A name of `variables_of`.
    terms : tuple of (str, int)
        Component of the twist, or "left" or "right" of the treads, and number of the basis
        function.
    by_speed : bool
        Whether it grows with speed: that of the wheels whose angle it is, that of the tread that
        it is added to, else the mean of both treads' magnitudes. Else it is there at any speed.
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
            known = TREADS if self.variable in OF_TREADS else (*COMPONENTS, *TREADS)
            if len(term) != 2 or term[0] not in known or term[1] not in range(functions):
                raise ParameterError(
                    f"the residual has a term {term!r}, expected one of {', '.join(known)} "
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
        unit = {"omega": "rad/s"}
        return tuple(
            EffectParameter(
                f"{component}_{number}",
                "" if self.by_speed and component != "omega" else unit.get(component, "m/s"),
                -10.0,
                10.0,
                0.0,
                0.01,
            )
            for component, number in self.terms
        )

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        known = self.variable in SIMULATED or _variable(self.variable, inputs, None) is not None
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
        variable = _variable(self.variable, inputs, twist)
        if variable is None:
            raise ParameterError(
                f"the residual is a function of {self.variable!r}, which was not recorded; there "
                f"are {', '.join(variables_of(inputs, twist))}"
            )
        bases = _of_each_tread(variable, self.knots)
        added, by_tread = np.zeros_like(twist), np.zeros((len(twist), len(TREADS)))
        for (component, number), value in zip(self.terms, values, strict=True):
            if component in TREADS:
                tread = TREADS.index(component)
                by_tread[:, tread] += value * bases[tread][:, number]
            else:
                added[:, COMPONENTS.index(component)] += value * bases[0][:, number]
        if self.by_speed:
            by_tread *= inputs.tread_speeds_m_s
            added *= _speed(self.variable, inputs)[:, None]
        if by_tread.any():
            slopes = base.model.speed_jacobian(base.values, inputs)
            added += np.einsum("nij,nj->ni", slopes, by_tread)
        return np.asarray(twist + added)

    @property
    def key(self) -> tuple[str, str, str]:
        """See `Effect.key`: of each variable another."""
        return self.name, f"{self.form} of {self.variable}", f"{self.by_speed}"

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


def variables_of(inputs: Inputs, twist: FloatArray | None = None) -> dict[str, FloatArray]:
    """What a residual may depend on, of what was recorded and of the twist (N, 3) simulated.

    Each is (N,), but those of `OF_TREADS` (N, 2).
    """
    found = {name: _variable(name, inputs, twist) for name in VARIABLES}
    return {name: values for name, values in found.items() if values is not None}


def _variable(name: str, inputs: Inputs, twist: FloatArray | None) -> FloatArray | None:
    """Values of a variable, None where it was not recorded."""
    if name in RECORDED:
        return RECORDED[name](inputs)
    return None if twist is None or name not in SIMULATED else SIMULATED[name](twist)


RECORDED: Mapping[str, Callable[[Inputs], FloatArray | None]] = {
    "speed": lambda inputs: (inputs.left + inputs.right) / 2,
    "speed_difference": lambda inputs: inputs.right - inputs.left,
    "roll": lambda inputs: inputs.roll_rad,
    "pitch": lambda inputs: inputs.pitch_rad,
    "tread_speed": lambda inputs: inputs.tread_speeds_m_s,
    "tread_acceleration": lambda inputs: _accelerations(inputs.tread_speeds_m_s, inputs.time_s),
    "time": lambda inputs: inputs.time_s,
    "heading": lambda inputs: inputs.heading_rad,
    "wheel_angle": lambda inputs: _wheel_angle(inputs.wheel_angles_rad, slice(None)),
    "left_wheel_angle": lambda inputs: _wheel_angle(inputs.wheel_angles_rad, slice(0, 1)),
    "right_wheel_angle": lambda inputs: _wheel_angle(inputs.wheel_angles_rad, slice(1, 2)),
}
SIMULATED: Mapping[str, Callable[[FloatArray], FloatArray]] = {
    "curvature": lambda twist: twist[:, 2] / _at_least(twist[:, 0], CREEPING_M_S),
    "lateral_acceleration": lambda twist: twist[:, 0] * twist[:, 2],
}
VARIABLES = (*RECORDED, *SIMULATED)


def _wheel_angle(angles_rad: FloatArray | None, which: slice) -> FloatArray | None:
    return None if angles_rad is None else np.asarray(angles_rad[..., which].mean(axis=-1))


def _at_least(values: FloatArray, least: float) -> FloatArray:
    return np.copysign(np.maximum(np.abs(values), least), values)


def _accelerations(speeds_m_s: FloatArray, time_s: FloatArray | None) -> FloatArray | None:
    """Of both treads (N, 2) [m/s^2]: differences over ACCELERATION_OVER_S."""
    if time_s is None:
        return None
    ends = [
        np.searchsorted(time_s, time_s + side * ACCELERATION_OVER_S / 2, side="right") - 1
        for side in (1, -1)
    ]
    ahead, behind = (speeds_m_s[np.maximum(end, 0)] for end in ends)
    return np.asarray((ahead - behind) / ACCELERATION_OVER_S)


def _of_each_tread(variable: FloatArray, knots: tuple[float, ...]) -> tuple[FloatArray, ...]:
    """Basis functions (N, B) for the left and the right tread."""
    if variable.ndim == 1:
        return (basis_of(variable, knots),) * 2
    return tuple(basis_of(column, knots) for column in variable.T)


def basis_of(variable: FloatArray, knots: tuple[float, ...]) -> FloatArray:
    """Basis functions (N, B): hats on the knots, or sines and cosines without any."""
    if knots:
        return np.stack([np.interp(variable, knots, hat) for hat in np.eye(len(knots))], axis=-1)
    return np.stack(
        [wave(k * variable) for k in range(1, HARMONICS + 1) for wave in (np.cos, np.sin)], axis=-1
    )
