"""The change of the contact force balance by one more force: for slope sliding and inertia.

Not the balance itself is the effect but the change that gravity along the slope, or inertia,
makes to it: on level terrain and slow the base stays as it was calibrated. Both change
slowly, so that they are computed on means over a fifth of a second, of the recorded
speeds before any slip: then they do not depend on what else is fitted, and are remembered.
"""

from abc import abstractmethod

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.effects.interface.base import Effect, EffectParameter, MotionEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.recorded import Recorded
from odometry.effects.interface.remembered import Remembered
from odometry.effects.motion.slope_icr import half_length_m
from odometry.models.contact import GUESSED_HEIGHT, Contact
from odometry.models.inputs import Inputs

MODEL = Contact()
MEAN_S = 0.2
LATEST = 8  # answers from which the next one is searched
FEWEST, MORE = 2.0, (3.0, 4.0)  # contacts a side: those of two axles, of three, of a tread
STARTS = ((0.4, 0.01), (0.4, 0.08), (0.8, 0.01), (0.8, 0.08))  # friction, scale of slip
IN_BALANCE = [0, 4, 5, 2, 8]  # where the parameters are among those of `Contact`


class ContactChange(MotionEffect):
    """Shared by both: a balance less the same balance without what is missing.

    Parameters
    ----------
    half_width : float, optional
        Of the contacts [m]; half the track width of the robot where absent.
    contacts : float, optional
        How many a side bear the load, two where absent. It is no number that a search can follow:
        wheels at the ends alone resist a turn as a longer track would.
    """

    form = "contact"
    slow = True
    physics = "contact"
    answers_to = ""
    constant_names = ("half_width", "contacts")
    source = "force balance of this project (odometry.models.contact)"

    def __init__(self, half_width: float | None = None, contacts: float | None = None) -> None:
        self.half_width = half_width
        self.contacts = contacts
        self._changes = Remembered()
        self._balanced = Remembered()
        self._latest: list[tuple[FloatArray, FloatArray]] = []

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """On contacts as wide as the robot: two wheels a side, three, or all along the treads.

        A wheel in the middle slides otherwise than those at the ends as loads shift: turns may
        become tighter where those of two or four become wider.
        """
        half_width = recorded.base.robot.track_width / 2
        return (cls(half_width), *(cls(half_width, contacts) for contacts in MORE))

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (
            EffectParameter("mu", "", 0.1, 2.0, 0.6, 0.02, None),
            EffectParameter("height", "m", 0.0, 1.5, 0.15, 0.01, None),
            EffectParameter("half_length", "m", 0.03, 2.0, 0.25, 0.01, None),
            EffectParameter("x_cm", "m", -0.3, 0.3, 0.0, 0.01, None),
            EffectParameter("slip_scale", "m/s", 1e-3, 0.5, 0.03, 0.005, None),
        )

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:  # noqa: ARG002 - of the interface
        """See `Effect.starts`: contacts under the body, slippery and rough, stiff and soft."""
        usual, _ = self.usual(base)
        return np.array([[mu, *usual[1:4], scale] for mu, scale in STARTS])

    def usual(self, base: Base) -> tuple[FloatArray, FloatArray]:
        """See `Effect.usual`: from the size of the robot; what motion leaves open stays there."""
        height, half_length = GUESSED_HEIGHT * base.robot.track_width, half_length_m(base.robot)
        return (
            np.array([0.6, height, half_length, 0.0, 0.03]),
            np.array([0.2, height / 2, half_length / 4, half_length / 5, 0.03]),
        )

    def is_meant(self, values: FloatArray) -> bool:
        """Not at an end of what was searched, but for smooth contacts and a mass at the terrain."""
        lows, highs = np.array([(p.low, p.high) for p in self.parameters]).T
        return bool((values < highs).all() and (values > lows)[[0, 2, 3]].all())

    def balance_values(self, values: FloatArray, base: Base, scale: float = 1.0) -> FloatArray:
        """Parameters of `Contact`; `scale` is that of the speeds."""
        mu, height, half_length, x_cm, slip_scale = values
        half_width, contacts = self._half_width_m(base), self.contacts or FEWEST
        return np.array(
            [mu, 1.0, x_cm, 0.0, height, half_length, half_width, contacts, scale * slip_scale]
        )

    def _half_width_m(self, base: Base) -> float:
        return self.half_width or base.robot.track_width / 2

    @abstractmethod
    def change(self, values: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """What it changes of the twist (K, 3) at few inputs (K,)."""

    @abstractmethod
    def change_by_values(self, values: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """Derivative (P, K, 3) of `change`."""

    def twist(
        self, values: FloatArray, twist: FloatArray, inputs: Inputs, base: Base
    ) -> FloatArray:
        """See `MotionEffect.twist`."""
        return np.asarray(twist + self._change(values, inputs, base))

    def added_by_values(self, values: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """Derivative (P, N, 3) of what `twist` adds, whatever the twist is."""
        means, counts = _means(inputs)
        return np.repeat(self.change_by_values(values, means, base), counts, axis=1)

    def balanced(self, balances: FloatArray, inputs: Inputs) -> FloatArray:
        """Balanced twists (K, 3) of parameters (K, 9) of `Contact`."""
        stack = (inputs.tread_speeds_m_s, inputs.roll_rad, inputs.pitch_rad)
        driven = np.column_stack(stack)
        return self._balanced.to(
            (balances, driven), lambda: self._balance(balances, inputs, driven)
        )

    def _balance(self, balances: FloatArray, inputs: Inputs, driven: FloatArray) -> FloatArray:
        """The same, searched from the answer to the inputs (K, 4) most like these."""
        alike = [one for one in self._latest if one[0].shape == driven.shape]
        apart = [float(np.abs(of - driven).sum()) for of, _ in alike]
        if not alike:
            answer = MODEL.twist(balances, inputs)
        else:
            answer = MODEL.twist_near(balances, inputs, alike[int(np.argmin(apart))][1])
        others = [one for one in self._latest if not np.array_equal(one[0], driven)]
        self._latest = [*others, (driven, answer)][-LATEST:]
        return answer

    def balanced_by_values(self, balances: FloatArray, inputs: Inputs) -> FloatArray:
        """Their derivative (P, K, 3) by the effect's parameters."""
        jacobian = MODEL.derivative_at(balances, inputs, self.balanced(balances, inputs))
        return np.moveaxis(jacobian[..., IN_BALANCE], -1, 0)

    def _change(self, values: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """What it adds to the twist (N, 3)."""
        known = np.array([self._half_width_m(base)])
        time_s = np.empty(0) if inputs.time_s is None else inputs.time_s
        recorded = (inputs.tread_speeds_m_s, inputs.roll_rad, inputs.pitch_rad, time_s)

        def answer() -> FloatArray:
            means, counts = _means(inputs)
            return np.repeat(self.change(values, means, base), counts, axis=0)

        return self._changes.to((values, known, *recorded), answer)


def _means(inputs: Inputs) -> tuple[Inputs, IntArray]:
    """Inputs averaged over fifths of a second, and how many samples each is of."""
    first = _first_of_means(inputs)
    means = Inputs(
        _mean(inputs.tread_speeds_m_s, first),
        _mean(inputs.roll_rad, first),
        _mean(inputs.pitch_rad, first),
        time_s=None if inputs.time_s is None else inputs.time_s[first],
    )
    return means, np.diff([*first, len(inputs.roll_rad)])


def _first_of_means(inputs: Inputs) -> IntArray:
    """First sample of each fifth of a second; of each sample where there are no stamps."""
    if inputs.time_s is None:
        return np.arange(len(inputs.tread_speeds_m_s))
    bins = np.floor(inputs.time_s / MEAN_S + 1e-6)
    return np.flatnonzero(np.diff(bins, prepend=np.nan) != 0)


def _mean(values: FloatArray, first: IntArray) -> FloatArray:
    counts = np.diff([*first, len(values)]).reshape(-1, *[1] * (values.ndim - 1))
    return np.asarray(np.add.reduceat(values, first, axis=0) / counts)
