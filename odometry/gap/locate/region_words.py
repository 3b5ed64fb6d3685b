"""Bounds of variables as text."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from odometry.effects.unknown.residual import Residual
from odometry.effects.unknown.residual_of_each_run import ResidualOfEachRun

EVERYWHERE = "everywhere"


@dataclass(frozen=True)
class Signed:
    """A variable whose two signs have their own words.

    Attributes
    ----------
    positive, negative : str
    more : str
        Between these and a number.
    noun, unit : str
        Unit as it is written.
    scale : float
        From the variable's unit to the one written.
    slight : float
        Bounds nearer to zero (in the variable's unit) get no number.
    """

    positive: str
    negative: str
    more: str
    noun: str
    unit: str
    scale: float = 1.0
    slight: float = 0.0

    def words(self, low: float | None, high: float | None) -> str:
        """Of a lower and an upper bound."""
        if low is not None and high is not None:
            if low >= 0:
                return f"{self.positive} {self._number(low, bare=True)} to {self._number(high)}"
            if high <= 0:
                return f"{self.negative} {self._number(high, bare=True)} to {self._number(low)}"
            written = f"{low * self.scale:.2g} and {high * self.scale:.2g} {self.unit}"
            return f"{self.noun} between {written}"
        if low is not None:
            return self._beyond(low, self.positive, self.negative)
        return self._beyond(-high, self.negative, self.positive) if high is not None else ""

    def _beyond(self, bound: float, side: str, other: str) -> str:
        """More than a bound to one side, which is negative on the other side of zero."""
        if abs(bound) < self.slight:
            return side
        beyond = f"{self.more} {self._number(bound)}"
        return f"{side} {beyond}" if bound > 0 else f"not {other} {beyond}"

    def _number(self, bound: float, *, bare: bool = False) -> str:
        number = f"{abs(bound) * self.scale:.2g}"
        return number if bare else f"{number} {self.unit}"


@dataclass(frozen=True)
class Plain:
    """A variable by its name."""

    noun: str
    unit: str
    scale: float = 1.0
    above: str = "above"
    below: str = "below"

    def words(self, low: float | None, high: float | None) -> str:
        """Of a lower and an upper bound."""
        if low is not None and high is not None:
            written = f"{low * self.scale:.3g} and {high * self.scale:.3g} {self.unit}"
            return f"{self.noun} between {written}"
        if low is not None:
            return f"{self.noun} {self.above} {low * self.scale:.3g} {self.unit}"
        if high is not None:
            return f"{self.noun} {self.below} {high * self.scale:.3g} {self.unit}"
        return ""


DEGREES = math.degrees(1.0)
SPOKEN: Mapping[str, Signed | Plain] = {
    "speed": Plain("speed", "m/s"),
    "omega": Signed(
        "turning left", "turning right", "faster than", "yaw rate", "degrees/s", DEGREES, 0.1
    ),
    "curvature": Signed(
        "curving left", "curving right", "more than", "curvature", "per m", 1.0, 0.1
    ),
    "roll": Signed(
        "right side down", "left side down", "more than", "roll", "degrees", DEGREES, 0.01
    ),
    "pitch": Signed("nose down", "nose up", "more than", "pitch", "degrees", DEGREES, 0.01),
    "heading": Plain("heading", "degrees", DEGREES),
    "lateral_acceleration": Signed(
        "accelerated to the left",
        "accelerated to the right",
        "more than",
        "lateral acceleration",
        "m/s²",
        1.0,
        0.05,
    ),
    "speed_difference": Plain("difference of tread speeds", "m/s"),
    "time": Plain("run time", "s", 1.0, "after", "before"),
    "time_since_stop": Plain("time since the last stop", "s", 1.0, "after", "before"),
    "left_wheel_angle": Plain("angle of the left wheels", "degrees", DEGREES),
    "right_wheel_angle": Plain("angle of the right wheels", "degrees", DEGREES),
    "leaning_forward": Plain("how fast a mast of 1 m on the robot leans forward", "m/s"),
    "leaning_left": Plain("how fast a mast of 1 m on the robot leans to the left", "m/s"),
    "speed_before": Plain("previous speed", "m/s"),
    "speed_history": Plain("speeds recorded shortly before and after", "s"),
    "speed_change": Signed(
        "speeding up", "slowing down", "by more than", "change of speed", "m/s", 1.0, 0.05
    ),
}

NAMES = {
    "turn": "direction of turning",
    "place": "place",
    "terrain": "terrain",
    "tread_speed": "speed of each tread",
    "tread_acceleration": "acceleration of each tread",
    "other_tread_speed": "speed of the other tread",
    "tread_speed_lost": "speed that each tread lost in the last 0.6 s",
    "tread_speed_gained": "speed that each tread gained in the last 0.6 s",
    "tread_speed_repeated": "how often the record repeats a tread speed while it changes",
    "turn_since_rest": "turn since the robot last did not turn",
    "turn_since_reversal": "turn since the robot last turned to the other side",
    "tread_travel_since_reversal": "travel of each tread since it last reversed",
    "travel_since_reversal": "travel since the last reversal",
    "turn_before": "turn over the last metre",
    "mean_speed_before": "mean speed over the last 8 seconds",
    "mean_turning_before": "mean size of the yaw rate over the last 8 seconds",
    "lateral_acceleration_before": "lateral acceleration over the last second",
    "wheel_angle": "angle of the wheels",
}


def words_of(bounds: Mapping[str, tuple[float | None, float | None]]) -> str:
    """All bounds in one phrase."""
    return ", ".join(_words(name, low, high) for name, (low, high) in bounds.items()) or EVERYWHERE


def noun_of(name: str) -> str:
    """A variable as text."""
    return SPOKEN[name].noun if name in SPOKEN else NAMES.get(name, name)


def noun_of_residual(residual: Residual) -> str:
    """What a smooth function depends on, as text."""
    noun = noun_of(residual.variable)
    own = isinstance(residual, ResidualOfEachRun)
    return f"{noun} (in each run by its own)" if own else noun


def shown_unit(name: str) -> tuple[str, float]:
    """The unit that a person reads, and the factor to it."""
    return (SPOKEN[name].unit, SPOKEN[name].scale) if name in SPOKEN else ("", 1.0)


def _words(name: str, low: float | None, high: float | None) -> str:
    if "=" in name:
        label = name.split("=", 1)[1]
        return f"on {label}" if low is not None else f"not on {label}"
    return SPOKEN[name].words(low, high)
