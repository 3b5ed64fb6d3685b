"""The unit as which wheel speeds of a bag were imported, where another one fits."""

from odometry.bags.wheel_units import UNITS
from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level
from odometry.checks.mending import treads_times
from odometry.checks.unit_tables import Unit, matching

ALIKE = (0.8, 1.25)  # factors that cannot be distinguished


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
