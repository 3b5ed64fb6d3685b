"""What is said of a unit that was taken for another, and of factors that are none."""

import numpy as np

from odometry.bags.topics.wheel_names import UNITS
from odometry.checks.evidence.evidence import CLEARLY, Evidence
from odometry.checks.evidence.heading import CONSISTENT, headings
from odometry.checks.evidence.scatter import scattered
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import gyroscope_times, times, treads_times
from odometry.checks.findings.unit_tables import (
    COUNTS,
    EQUAL,
    ORDINARY_FORWARD,
    RADII_M,
    Unit,
    as_likely,
    matching,
    tread_units,
)
from odometry.checks.statistics.relation import relation

WIDEST_M = 50.0  # no robot is wider
FARTHEST = 1.1  # the same, at most: 0.92 to 1.02 where real robots drive straight
STEADY = 0.98  # correlation from which a factor on straight lines is constant
DEGREES = 0.07  # logarithm of a factor by 180 / pi, as poses measure it; gradians are 0.105 off
HALF_ANGLE = 0.07  # the same, by 2
STRAIGHT = 0.05  # way of an arm in a turn, as a share of the way of the robot
WATCH = ", if that is it: compare with a turn by hand, and the duration with a watch"
AS_MUCH = 0.1  # logarithm by which the way of the treads may be off the ordinary one by the factor
SLIP_OR_TRACK = "there is heavy slip in turns (snow), or a wrong track_width"


def gyroscope_unit(evidence: Evidence, factor: float) -> Finding:
    """A yaw rate that is too large by a factor."""
    degrees = abs(np.log(factor * np.pi / 180)) < DEGREES
    cause = (
        "The gyroscope is in degrees per second"
        if degrees
        else "The gyroscope has a wrong scale (another unit, such as gradians, or full-scale range)"
    )
    remedy = "Convert gyro_z to rad/s"
    if abs(np.log(factor) - np.log(2)) < HALF_ANGLE and (half := _half_yaw(evidence)):
        return half
    if evidence.yaw_measured and abs(abs(np.log(factor)) - np.log(2)) < HALF_ANGLE:
        speed = "half" if factor > 1 else "twice"
        cause += f"; or stamps are those of a replay at {speed} the speed"
        if factor > 1:
            cause += "; or yaw is half of the right one (of a quaternion, without its factor of 2)"
        remedy += WATCH
    elif not degrees and _treads_as_well(evidence, factor):
        cause += (
            f"; or stamps are those of a replay at {1 / factor:.2g} times the speed: the treads "
            "are off by as much"
        )
        remedy += WATCH
    return Finding(
        "gyroscope_unit",
        Level.WARNING,
        f"gyro_z of {evidence.gyroscope_file} is {factor:.3g} times the turn rate that poses or "
        "treads have",
        cause,
        remedy,
        mend=gyroscope_times(evidence.run, 1 / factor),
    )


def _half_yaw(evidence: Evidence) -> Finding | None:
    """Yaw that turns half as far as the gyroscope; None where twice the yaw is not the course."""
    m = evidence.motion
    turn = evidence.turn_rad(m)
    found = [headings(of, turn).get("radians") for of in (m, m.with_yaw(lambda yaw: 2 * yaw))]
    plain, doubled = (0.0 if of is None else of.concentration for of in found)
    if doubled < CONSISTENT or doubled < plain + CLEARLY:
        return None
    return Finding(
        "yaw_is_quaternion",
        Level.WARNING,
        "gyro_z turns twice as far as yaw of pose.csv, and twice this yaw agrees with the course "
        f"(concentration {doubled:.2f}, as recorded {plain:.2f})",
        "Yaw is half of the right one (the half angle of a quaternion, without its factor of 2)",
        "Multiply yaw by 2",
        mend=times("pose", 2.0, "yaw"),
    )


def _treads_as_well(evidence: Evidence, factor: float) -> bool:
    """Whether the treads travel too far by the same factor: they and the gyroscope share stamps."""
    forward = evidence.metres_per_metre
    if not evidence.yaw_measured or forward is None:
        return False
    return bool(abs(np.log(forward * factor / ORDINARY_FORWARD)) < AS_MUCH)


def too_fast(evidence: Evidence) -> Finding:
    """Tread speeds that no robot has, where no position says more."""
    radius = evidence.run.robot.wheel_radius
    fitting = [
        unit
        for unit in tread_units(radius)
        if 0.2 <= evidence.fastest_m_s / unit.factor <= 5.0 and unit.factor > 1
    ]
    words = " or ".join(unit.words for unit in fitting)
    counters = "another unit than m/s, or the columns hold counters (encoder ticks), not speeds"
    return Finding(
        "tread_unit",
        Level.WARNING,
        f"treads run at up to {evidence.fastest_m_s:.4g} m/s, and no positions say how far the "
        "robot moved",
        f"Tread speeds are in {words or counters}",
        "Convert v_left and v_right to m/s: wheel rate times radius"
        + ("" if words else "; differentiate counters by t first"),
    )


def tread_unit(
    seen: str, unit: Unit, evidence: Evidence, *others: str, measured: float | None = None
) -> Finding:
    """Tread speeds in another unit, and what else the factor may be, the likeliest first."""
    words = as_likely(unit, evidence.run.robot.wheel_radius, evidence.period_s)
    words = [*(words or [f"in {unit.words}"]), *others]
    if 1 / 4 < unit.factor < 4:
        factor = ORDINARY_FORWARD * (measured or unit.factor)
        usual = RADII_M[0] < 1 / factor < RADII_M[1]
        rate = f", rad/s of wheels of {1 / factor:.2g} m radius" if usual else ""
        words.append(f"scaled by {factor:.2g} (gear ratio{rate})")
        words.append("right, and positions are scaled (a web map)")
    several = ": these cannot be distinguished" if len(words) > 1 else ""
    off = ORDINARY_FORWARD * measured if COUNTS in others and measured else unit.factor
    return Finding(
        "tread_unit",
        Level.WARNING,
        f"{seen}; treads run at up to {evidence.fastest_m_s:.4g} m/s",
        f"Tread speeds are {'; or '.join(words)}{several}",
        "Convert v_left and v_right to m/s: wheel rate times radius",
        mend=treads_times(1 / off, 1 / off),
    )


def beyond_treads(evidence: Evidence) -> float | None:
    """Metres per metre of tread travel where the robot drives straight, if more than slip leaves.

    Slip shortens the way, and on a straight line no arm of the sensor lengthens it.
    """
    m = evidence.motion
    arm_m = max(evidence.run.robot.length or 0.0, evidence.run.robot.track_width) / 2
    straight = np.abs(evidence.turn_rad(m)) * arm_m < STRAIGHT * np.abs(m.mean_m)
    found = relation(np.where(straight, m.distance_m, np.nan), np.abs(m.mean_m))
    if scattered(m, evidence.run.robot.track_width) or found is None or found.correlation < STEADY:
        return None
    return found.slope if found.slope - 5 * found.slope_sigma > FARTHEST else None


def track_against_body(evidence: Evidence) -> Finding | None:
    """A track width that does not go with the width of the robot."""
    robot = evidence.run.robot
    if robot.width is None or 0.4 * robot.width <= robot.track_width <= 1.1 * robot.width:
        return None
    return Finding(
        "track_width",
        Level.WARNING,
        f"track_width is {robot.track_width:g} m, and the robot is {robot.width:g} m wide",
        "track_width of run.toml is in mm, not metres"
        if robot.track_width > WIDEST_M
        else "track_width or width of run.toml is wrong",
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
    equal_units = [
        unit.words
        for unit in others
        if unit is not found and EQUAL[0] < unit.factor / found.factor < EQUAL[1]
    ]
    units = " or ".join([found.words, *equal_units])
    return Finding(
        "tread_unit",
        Level.WARNING,
        seen,
        f"The wheel speeds were imported as {said}, and they fit as {units}"
        + (": these cannot be distinguished" if equal_units else ""),
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
