"""What is said of a factor, of no known unit, between the way of treads and of the robot."""

from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import treads_times
from odometry.checks.findings.unit_tables import ORDINARY_FORWARD, RADII_M, of_wheels

OF_RADIUS = (0.7, 1.15)  # metres moved for each radian, over the stated radius: slip shortens it
ON_ICE = 0.24  # metres moved for each metre of the treads, of real robots at least
OPPOSED = 0.6  # of the way of the treads: a robot that turns on the spot for so long goes nowhere


def slip_along(
    seen: str, forward: float, *, tight: bool, radius_m: float | None, opposed: float
) -> Finding:
    """A factor below 1, that slip explains as well.

    `opposed` is the share of the way on which the treads run against each other.
    """
    wheel_m = _wheel_of_a_rate(forward, radius_m)
    slip = "heavy slip (ice, snow, a robot that is stuck) where terrain allows it"
    cause, remedy = slip.capitalize(), ""
    if opposed > OPPOSED:
        share = f"{100 * opposed:.0f} % of the way"
        cause = f"One tread has the wrong sign (they run against each other on {share}); or {slip}"
        remedy = "See whether both tread speeds are above zero on a straight. "
    elif wheel_m is not None:
        cause = f"Tread speeds are in rad/s, of wheels of {wheel_m:.3g} m radius; or {slip}"
        remedy = "See whether v_left and v_right are in m/s: wheel rate times radius. "
    return Finding(
        "slip",
        Level.WARNING,
        f"{seen}; the factor is {'constant' if tight else 'not known to be constant'}",
        f"{cause}, else a wrong scale of treads (a unit, a wheel radius) or positions: these "
        "cannot be distinguished",
        f"{remedy}Where it truly slipped nothing can be corrected; what is learned holds on it "
        "alone",
    )


def _wheel_of_a_rate(forward: float, radius_m: float | None) -> float | None:
    """The radius of wheels whose rates would be taken for speeds; None where it is an odd one."""
    if radius_m is not None:
        return radius_m if OF_RADIUS[0] < forward / radius_m < OF_RADIUS[1] else None
    wheel_m = forward / ORDINARY_FORWARD
    return wheel_m if RADII_M[0] < wheel_m and forward < ON_ICE else None


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
