"""Inertia in fast turns, as ICRs that move with its force."""

import numpy as np

from odometry.arrays import FloatArray, components_first
from odometry.effects.interface.base import Effect, EffectParameter, MotionEffect
from odometry.effects.interface.base_model import Base, slip_factors, tread_icrs
from odometry.effects.interface.recorded import Recorded
from odometry.effects.interface.remembered import Remembered
from odometry.models.icr import icr_twist
from odometry.models.icr_inertia import IcrInertia
from odometry.models.inertia_forces import Column
from odometry.models.inertia_model import G_M_S2, Turn
from odometry.models.inputs import Inputs

MODEL = IcrInertia()
OWN = [Column.ZETA_1, Column.EPSILON_1, Column.ETA_1, Column.ETA_2, Column.H]


class InertiaByIndices(MotionEffect):
    """The change that the indices of Martinez 2017 make to the base's ICRs.

    Without force zeta, epsilon and eta are those of the base.

    Parameters
    ----------
    mass : float
        Of the robot [kg]; 1 where it is not known: the coefficients are then by force per mass.
    track_width : float, optional
        By which eta is measured [m]; that of the robot where absent.
    """

    name = "inertia"
    in_words = "inertia in fast turns"
    form = "icr_inertia"
    answers_to = "base"
    equation = "zeta, epsilon, eta change with |F| by zeta_1, epsilon_1, eta_1, eta_2 and signs"
    constant_names = ("mass", "track_width")
    source = "Martinez 2017 eq. 17-30"
    looks_like = "turns that come out wider or tighter the faster they are driven"
    remedy = "keep it in the model, or drive turns more slowly"
    needs = "fast turns; a base model with tread ICRs"

    def __init__(self, mass: float = 1.0, track_width: float | None = None) -> None:
        self.mass, self.track_width = mass, track_width
        self._forces = Remembered()

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """By the mass of the robot."""
        robot = recorded.base.robot
        return (cls(robot.mass or 1.0, robot.track_width),)

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`; `h` acts through a sign alone."""
        weight = self.mass * G_M_S2
        return (
            EffectParameter("zeta_1", "m/N", -20 / weight, 20 / weight, 0.0, 0.02 / weight),
            EffectParameter("epsilon_1", "m/N", -20 / weight, 20 / weight, 0.0, 0.02 / weight),
            EffectParameter("eta_1", "1/N", -50 / weight, 50 / weight, 0.0, 0.02 / weight),
            EffectParameter(
                "eta_2", "1/N^2", -200 / weight**2, 200 / weight**2, 0.0, 0.1 / weight**2
            ),
            EffectParameter("h", "", 0.2, 3.0, 1.0, 0.05, None),
        )

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        return "" if base.model.name == "icr" else "a base model with tread ICRs"

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:  # noqa: ARG002 - of the interface
        """No change, for several H; first that of the base.

        The base's v_x is zero where V_l + H V_r = 0 with H = -y_left / y_right.
        """
        y_left, y_right, _ = tread_icrs(base, self.name)
        signs = np.clip([-y_left / y_right, 1.0, 0.67, 0.85, 1.2], 0.2, 3.0)
        return np.array([[0.0, 0.0, 0.0, 0.0, h] for h in signs])

    def twist(
        self, values: FloatArray, twist: FloatArray, inputs: Inputs, base: Base
    ) -> FloatArray:
        """See `MotionEffect.twist`."""
        packed, speeds = self._in_model(values, inputs, base)
        moved = self._turn(packed, speeds).twist
        return np.asarray(twist + moved - icr_twist(tread_icrs(base, self.name), speeds))

    def _turn(self, packed: FloatArray, speeds: FloatArray) -> Turn:
        inputs = Inputs(speeds)
        force_n = self._forces.to(
            (packed, speeds), lambda: MODEL.turn(packed, inputs).indices.force_n
        )
        return MODEL.turn_under(packed, inputs, force_n)

    def added_by_values(
        self, values: FloatArray, inputs: Inputs, base: Base
    ) -> tuple[FloatArray, FloatArray]:
        """Derivatives (P, N, 3) of what `twist` adds, and (5, N, 3) by the values of the base."""
        packed, speeds = self._in_model(values, inputs, base)
        moved = components_first(MODEL.jacobian(packed, self._turn(packed, speeds)))
        by_width = moved[Column.ETA_0] / packed[Column.TRACK_WIDTH]
        by_middle = moved[Column.EPSILON_0] / 2
        of_base = [by_width - by_middle, -by_width - by_middle, moved[Column.ZETA_0]]
        of_base += [moved[Column.V_LEFT] * inputs.left[:, None]]
        of_base += [moved[Column.V_RIGHT] * inputs.right[:, None]]
        plain = components_first(base.model.parameter_jacobian(base.values, inputs))
        return moved[OWN], np.stack(of_base) - plain

    def _in_model(
        self, values: FloatArray, inputs: Inputs, base: Base
    ) -> tuple[FloatArray, FloatArray]:
        """Parameters (12,) of `IcrInertia`, and the speeds (N, 2) of treads that slip."""
        y_left, y_right, x_icr = tread_icrs(base, self.name)
        width = self.track_width or base.robot.track_width
        zeta_1, epsilon_1, eta_1, eta_2, h = values
        coefficients = [
            *(x_icr, zeta_1, -(y_left + y_right) / 2, epsilon_1),
            *((y_left - y_right) / width, eta_1, eta_2),
            *(h, self.mass, 0.0, 0.0, width),
        ]
        return np.array(coefficients), slip_factors(base) * inputs.tread_speeds_m_s
