"""What is said of a factor, of no known unit, between the way of treads and of the robot."""

from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import treads_times
from odometry.checks.findings.unit_tables import ORDINARY_FORWARD, of_wheels


def slip_along(seen: str, tight: bool) -> Finding:
    """A factor below 1, that slip explains as well."""
    return Finding(
        "slip",
        Level.WARNING,
        f"{seen}; the factor is {'constant' if tight else 'not known to be constant'}",
        "Heavy slip (ice, snow, a robot that is stuck) where terrain allows it, else a wrong "
        "scale of treads (a unit, a wheel radius) or positions: these cannot be distinguished",
        "Where it truly slipped nothing can be corrected; what is learned holds on it alone",
    )


def farther_along(seen: str) -> Finding:
    """A factor above 1, not known to be constant."""
    return Finding(
        "scale",
        Level.WARNING,
        f"{seen}; the factor is not known to be constant",
        "Either treads or positions have a wrong scale, or the sensor is far from the centre (a "
        "lever arm): no slip makes a robot go farther than its treads",
        "Compare a straight stretch with a tape measure, and state the place of the sensor",
    )


def scale_along(seen: str, forward: float, radius_known: bool) -> Finding:
    """A constant factor along the way that is no known unit."""
    factor = ORDINARY_FORWARD / forward
    size = f"{factor:.2g} times too large" if factor > 1 else f"{1 / factor:.2g} times too small"
    missed = "" if factor > 1 else ", encoder ticks that are missed"
    units = "" if radius_known else "".join(f"{words}, " for words in of_wheels(forward))
    return Finding(
        "scale",
        Level.WARNING,
        f"{seen}; the factor is constant",
        f"Tread speeds are {size} ({units}wheel radius or diameter, gear ratio, unit{missed}), "
        "or positions are scaled",
        "Compare a straight stretch with a tape measure, and correct the wheel radius",
        mend=treads_times(1 / factor, 1 / factor),
    )
