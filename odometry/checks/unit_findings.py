"""What is said of a unit that was taken for another: tables of units, and factors that are none."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from odometry.bags.wheel_names import UNITS
from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level
from odometry.checks.undo import gyroscope_times, treads_times

ORDINARY_FORWARD = 0.93  # metres that a robot moves for each metre of tread travel


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


def matching(candidates: tuple[Unit, ...], ratio: Callable[[Unit], float]) -> Unit | None:
    """The unit that brings a ratio nearest to the ordinary one, if near enough."""
    near = min(candidates, key=lambda unit: abs(np.log(ratio(unit) / ORDINARY_FORWARD)))
    low, high = (0.45, 1.6) if not 1 / 50 < near.factor < 50 else (0.7, 1.15)
    return near if low <= ratio(near) <= high else None


SLIP_OR_TRACK = "; or heavy slip in turns (snow), or a wrong track_width"
ALIKE = (0.8, 1.25)  # factors that cannot be distinguished


def gyroscope_unit(evidence: Evidence, factor: float) -> Finding:
    """A yaw rate that is too large by a factor."""
    degrees = abs(np.log(factor * np.pi / 180)) < 0.3
    cause = (
        "The gyroscope is in degrees per second"
        if degrees
        else "The gyroscope has a wrong scale (another unit or full-scale range)"
    )
    return Finding(
        "gyroscope_unit",
        Level.WARNING,
        f"gyro_z of {evidence.gyroscope_file} is {factor:.3g} times the turn rate that poses or "
        "treads have",
        cause,
        "Convert gyro_z to rad/s",
        mend=gyroscope_times(evidence.run, 1 / factor),
    )


def too_fast(evidence: Evidence) -> Finding:
    """Tread speeds that no robot has, where no position says more."""
    radius = evidence.run.robot.wheel_radius
    fitting = [
        unit
        for unit in tread_units(radius)
        if 0.2 <= evidence.fastest_m_s / unit.factor <= 5.0 and unit.factor > 1
    ]
    words = " or ".join(unit.words for unit in fitting) or "another unit than m/s"
    return Finding(
        "tread_unit",
        Level.WARNING,
        f"treads run at up to {evidence.fastest_m_s:.4g} m/s, and no positions say how far the "
        "robot moved",
        f"Tread speeds are in {words}",
        "Convert v_left and v_right to m/s: wheel rate times radius",
    )


def tread_unit(seen: str, unit: Unit, evidence: Evidence, others: str = "") -> Finding:
    """Tread speeds in another unit, and what else the factor may be: `others`, and known ones."""
    if 1 / 4 < unit.factor < 4:
        alike = [
            other.words
            for other in tread_units(evidence.run.robot.wheel_radius, evidence.period_s)
            if other.words != unit.words and 0.8 < other.factor / unit.factor < 1.25
        ]
        half = "half" if unit.factor < 1 else "twice"
        others += "".join(f"; or in {words}" for words in alike)
        others += (
            f"; or scaled by {unit.factor:.2g} (wheel diameter for radius gives {half} the speed; "
            "gear ratio): these cannot be distinguished"
        )
    return Finding(
        "tread_unit",
        Level.WARNING,
        f"{seen}; treads run at up to {evidence.fastest_m_s:.4g} m/s",
        f"Tread speeds are in {unit.words}, not m/s{others}",
        "Convert v_left and v_right to m/s: wheel rate times radius",
        mend=treads_times(1 / unit.factor, 1 / unit.factor),
    )


def slip_along(seen: str, tight: bool) -> Finding:
    """A factor along the way that slip explains as well."""
    return Finding(
        "slip",
        Level.WARNING,
        f"{seen}; the factor is {'constant' if tight else 'not known to be constant'}",
        "Heavy slip (ice, snow, a robot that is stuck) where terrain allows it, else a wrong "
        "scale of treads or positions: these cannot be distinguished",
        "Where it truly slipped nothing can be mended: what is learned holds on such terrain alone",
    )


def scale_along(seen: str, forward: float) -> Finding:
    """A constant factor along the way that is no known unit."""
    return Finding(
        "scale",
        Level.WARNING,
        f"{seen}; the factor is constant",
        f"Tread speeds are {1 / forward * ORDINARY_FORWARD:.2g} times too large (wheel radius or "
        "diameter, gear ratio, unit), or positions are scaled",
        "Compare a straight stretch with a tape measure, and mend the wheel radius",
        mend=treads_times(forward / ORDINARY_FORWARD, forward / ORDINARY_FORWARD),
    )


def track_against_body(evidence: Evidence) -> Finding | None:
    """A track width that does not go with the width of the robot."""
    robot = evidence.run.robot
    if robot.width is None or 0.4 * robot.width <= robot.track_width <= 1.1 * robot.width:
        return None
    return Finding(
        "track_width",
        Level.WARNING,
        f"track_width is {robot.track_width:g} m, and the robot is {robot.width:g} m wide",
        "track_width or width of run.toml is wrong",
        "Measure the distance between the middles of the left and the right treads, in metres",
    )


def imported_unit(
    evidence: Evidence, seen: str, forward: float, width: float | None
) -> Finding | None:
    """That another unit than the one of the import fits; None where none does, or none is known.

    Parameters
    ----------
    evidence : Evidence
    seen : str
    forward : float
        Measured way for each metre of tread travel.
    width : float or None
        Effective width in track widths.
    """
    said = _said(evidence)
    others = _other_units(said, evidence.run.robot.wheel_radius) if said else ()
    found = matching(others, lambda unit: forward * unit.factor) if others else None
    if found is None or (width is not None and not 0.95 <= width / found.factor <= 4.0):
        return None
    alike = [
        unit.words
        for unit in others
        if unit is not found and ALIKE[0] < unit.factor / found.factor < ALIKE[1]
    ]
    units = " or ".join([found.words, *alike])
    return Finding(
        "tread_unit",
        Level.WARNING,
        seen,
        f"The wheel speeds were imported as {said}, and they fit as {units}"
        + (": these cannot be distinguished" if alike else ""),
        f"Import the bag again with --unit {found.words}",
        mend=treads_times(1 / found.factor, 1 / found.factor),
    )


def _said(evidence: Evidence) -> str:
    source = evidence.run.settings.get("source")
    said = source.get("wheel_unit") if isinstance(source, dict) else None
    return said if isinstance(said, str) and said in UNITS else ""


def _other_units(said: str, radius_m: float | None) -> tuple[Unit, ...]:
    """What the file holds for each metre a second, were the numbers in another unit."""
    one, of_angle, is_speed = UNITS[said]
    reach_m = radius_m if radius_m is not None else 1.0
    metres = one * (reach_m if of_angle else 1.0)
    return tuple(
        Unit(name, metres / (other * (reach_m if of_angle_too else 1.0)))
        for name, (other, of_angle_too, is_speed_too) in UNITS.items()
        if name != said and is_speed_too == is_speed
        if radius_m is not None or of_angle_too == of_angle
    )
