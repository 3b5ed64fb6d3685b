"""Units in which tread speeds and positions are logged, and which of them fits a factor."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

ORDINARY_FORWARD = 0.93  # metres that a robot moves for each metre of tread travel
# Least share of its way that a robot moves which slips, and one that moves farther than it should.
SLIPS, HOLDS = 0.45, 0.8
RADII_M = (0.04, 0.6)  # of wheels
COUNTS = "encoder ticks"  # of any number a metre


@dataclass(frozen=True)
class Unit:
    """A unit in place of the right one: the file holds `factor` times the SI value."""

    words: str
    factor: float


def tread_units(wheel_radius_m: float | None, period_s: float = 0.0) -> tuple[Unit, ...]:
    """Units in which tread speeds are logged; those of wheels need a radius."""
    linear = (
        Unit("metres a row (increments of an odometer, not speeds)", period_s or 1e-9),
        Unit("mm/s", 1000.0),
        Unit("cm/s", 100.0),
        Unit("km/h", 3.6),
        Unit("miles per hour", 2.23694),
        Unit("feet per second", 3.28084),
        Unit("feet per minute", 196.850),
        Unit("inches per second", 39.3701),
    )
    if wheel_radius_m is None:
        return linear
    turn = 2 * np.pi * wheel_radius_m
    return (
        Unit(f"rad/s (of wheels of {wheel_radius_m:g} m radius)", 1 / wheel_radius_m),
        Unit(f"RPM (of wheels of {wheel_radius_m:g} m radius)", 60 / turn),
        Unit("revolutions per second", 1 / turn),
        Unit("degrees per second", 360 / turn),
        *linear,
    )


POSITION_UNITS = (
    Unit("mm", 1000.0),
    Unit("cm", 100.0),
    Unit("km", 0.001),
    Unit("feet", 3.28084),
    Unit("inches", 39.3701),
    Unit("degrees of latitude and longitude", 1 / 111_320.0),
)


def matching(
    candidates: tuple[Unit, ...],
    ratio: Callable[[Unit], float],
    least: float = SLIPS,
    most: float = 1.2,
) -> Unit | None:
    """The unit that brings a ratio nearest to the ordinary one, if near enough.

    A rare unit may lie farther off, up to `most`: no robot goes much farther than its treads. Slip
    may bring it down to `least`.
    """
    near = min(candidates, key=lambda unit: abs(np.log(ratio(unit) / ORDINARY_FORWARD)))
    low, high = (least, most) if not 1 / 50 < near.factor < 50 else (0.7, 1.15)
    return near if low <= ratio(near) <= high else None


RARE = ("miles per hour", "feet per second", "feet per minute", "inches per second")  # in robotics
EQUAL = (0.8, 1.25)  # ratio of factors that cannot be distinguished


def as_likely(unit: Unit, wheel_radius_m: float | None, period_s: float) -> list[str]:
    """What speeds may be that are too large by the factor of a unit, the likeliest first.

    A wheel whose radius is stated comes first, then its diameter; a wheel of any radius fits
    nearly any factor.
    """
    twice = Unit("twice too large (the diameter of the wheels was taken for their radius)", 2.0)
    half = Unit("half of the right ones (the radius of the wheels is set to half of it)", 0.5)
    units = [_in(of) for of in tread_units(wheel_radius_m, period_s)]
    units[0 if wheel_radius_m is None else 1 : 0] = [twice, half]
    near = [of.words for of in units if EQUAL[0] < of.factor / unit.factor < EQUAL[1]]
    wheels = () if wheel_radius_m is not None else of_wheels(ORDINARY_FORWARD / unit.factor)
    rare = [words for words in near if words.removeprefix("in ") in RARE]
    usual = [words for words in near if words not in rare]
    return [*usual, *(f"in {words}" for words in wheels), *rare]


def _in(unit: Unit) -> Unit:
    return Unit(f"in {unit.words}", unit.factor)


def counts(forward: float, radius_known: bool) -> Unit:
    """What speeds are that are far too large for m/s: of wheels, motors or encoders."""
    units = () if radius_known else of_wheels(forward)
    words = [*units, "encoder ticks, motor RPM (before the gearbox) or another unit"]
    return Unit(", ".join(words), 1 / forward)


def of_wheels(forward: float) -> tuple[str, ...]:
    """Units of the turning of wheels, whose radius would then be one that robots have."""
    radii_m = {"rad/s": forward / ORDINARY_FORWARD}
    radii_m["RPM"] = radii_m["rad/s"] * 60 / (2 * np.pi)
    return tuple(
        f"{unit} of wheels of {radius_m:.2g} m radius"
        for unit, radius_m in radii_m.items()
        if RADII_M[0] < radius_m < RADII_M[1]
    )
