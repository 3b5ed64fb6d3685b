"""Units of tread speeds, positions and yaw rate, and the track width."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, disagreement
from odometry.checks.findings.undo import times
from odometry.checks.findings.unit_tables import (
    COUNTS,
    HOLDS,
    ORDINARY_FORWARD,
    POSITION_UNITS,
    RARE,
    SLIPS,
    counts,
    matching,
    tread_units,
)
from odometry.checks.statistics.relation import Relation, pieces
from odometry.checks.treads.proportion import holds_the_mean
from odometry.checks.turns.constancy import one_side, uneven_gyroscope, uneven_way
from odometry.checks.units.carried import carried_along
from odometry.checks.units.constant_along import reads_less, turns_less
from odometry.checks.units.effective_width import (
    ORDINARY_WIDTH,
    PLAUSIBLE_M_S,
    TIGHT,
    WIDTH,
    across,
    width_factor,
)
from odometry.checks.units.factor_along import farther_along, scale_along, slip_along
from odometry.checks.units.swinging_sensor import swinging_sensor
from odometry.checks.units.unit_findings import (
    beyond_treads,
    gyroscope_unit,
    imported_unit,
    too_fast,
    track_against_body,
    tread_unit,
)

# Robots that were measured move 0.75 to 1.05 times as far as their treads where the terrain holds,
# on ice 0.24 to 0.4 times as far.
FORWARD = (0.55, 1.2)
SLIDING = 0.6  # concentration of course less yaw below which the robot slides sideways
EXTREME = 8.0  # a factor that no slip explains
NOISE = 6.0  # noise of both ends adds 2 (sigma / distance)^2 to a distance, and may wander
LEAST_WINDOWS = 15  # from which a factor without heading can be called constant
NEARLY = 0.9  # of the ordinary way: farther off, the unit may be another one
MOST, CLOSELY = 0.7, 0.99  # share of the windows, and their correlation, that are no outliers
STRAIGHT_TO_ALL = 1.2  # ratio of the ways for each metre of the treads; real robots have less
SLIPPERY_WIDTH = 2.1  # in track widths; where robots slipped along the way they turned as if 2.3
ONE_AXIS_STRETCHED = 2.0  # degrees of longitude taken for those of latitude, up to 60 degrees


def units(evidence: Evidence) -> Iterator[Finding]:
    """Factors between sensors that are units, and a track width that nothing agrees with."""
    forward, forward_tight = _forward_factor(evidence)
    gyroscope_factor = _gyroscope_factor(evidence)
    width, turn_tight = width_factor(evidence, gyroscope_factor or 1.0)
    if gyroscope_factor:
        yield gyroscope_unit(evidence, gyroscope_factor)
    low, high = FORWARD[0] * (1 - evidence.arm_share), FORWARD[1] * (1 + evidence.arm_share)
    high *= 1 + _longer_by_noise(evidence)
    if forward is not None and not low <= forward <= high:
        yield _along(evidence, forward, forward_tight, width)
    elif (straight := beyond_treads(evidence)) and swinging_sensor(evidence) is None:
        yield _on_straight_lines(evidence, straight, forward)
    narrow = width is not None and width < WIDTH[0]
    if narrow and (otherwise := holds_the_mean(evidence) or turns_less(evidence)):
        yield disagreement(otherwise)
    elif width is not None and not WIDTH[0] <= width <= WIDTH[1]:
        # one scale of the treads lengthens their way and widens the robot by the same factor
        one_scale = forward is not None and not low <= forward <= high
        if forward is None or not (one_scale and WIDTH[0] <= width * forward <= WIDTH[1]):
            yield across(evidence, forward, width, turn_tight)
    elif evidence.fastest_m_s > PLAUSIBLE_M_S and forward is None:
        yield too_fast(evidence)
    elif (stated := track_against_body(evidence)) is not None:
        yield stated


def _forward_factor(evidence: Evidence) -> tuple[float | None, bool]:
    """Measured displacement per mean tread travel, and whether it is constant."""
    if swinging_sensor(evidence) is not None:
        return None, False
    found = evidence.forward_by_mean
    if found is not None and found.certain():
        return abs(found.slope), found.correlation > TIGHT
    distance = evidence.distance_by_mean
    aligned = evidence.best_concentration  # None without yaw: sliding is then not excluded
    if distance is not None and distance.certain():
        tight = distance.correlation > TIGHT and distance.measured >= LEAST_WINDOWS
        return abs(distance.slope), tight and aligned is not None and aligned >= SLIDING
    return None, False


def _longer_by_noise(evidence: Evidence) -> float:
    """Share by which noise of positions may make distances longer, where yaw says no sign."""
    distance_m = evidence.motion.distance_m
    if evidence.heading is not None or not np.isfinite(distance_m).any():
        return 0.0
    usual_m = float(np.quantile(distance_m[np.isfinite(distance_m)], 0.75))
    return NOISE * (evidence.position_sigma_m / max(usual_m, 1e-9)) ** 2


def _gyroscope_factor(evidence: Evidence) -> float | None:
    """Factor by which the gyroscope is too large; None where it is in rad/s or not known."""
    by_gyroscope = evidence.pose_turn_by_gyroscope
    if not _lasts_by_treads(evidence):
        return None
    if by_gyroscope is not None and by_gyroscope.certain() and _holds(by_gyroscope):
        factor = 1 / abs(by_gyroscope.slope)
        m = evidence.turn_motion
        fits = pieces(evidence.pose_turn_rad, m.gyroscope_rad, m.lasts_s)
        parts = [1 / abs(of.slope) for of in fits if of.certain()]
        lasts = all((part > 1.2 if factor > 1 else part < 0.85) for part in parts)
        odd = lasts and not 0.7 < factor < 1.4
        return factor if odd and not uneven_gyroscope(evidence, factor) else None
    found, rate = evidence.gyroscope_by_difference, evidence.yaw_rate
    if evidence.yaw_measured or found is None or rate is None or not found.certain():
        return None
    width = 1 / (abs(found.slope) * evidence.run.robot.track_width)
    degrees = width < 0.2 and float(np.quantile(np.abs(rate[1]), 0.99)) > 4.0
    return 180 / np.pi if degrees else None


def _lasts_by_treads(evidence: Evidence) -> bool:
    """Whether no quarter of the time has another unit than the others, by the treads."""
    m = evidence.uniform
    fits = pieces(m.gyroscope_rad, m.difference_m, m.lasts_s)
    sizes = [abs(of.slope) for of in fits if of.certain()]
    return not sizes or max(sizes) < EXTREME * min(sizes)


def _holds(by_gyroscope: Relation) -> bool:
    """Whether measured turns go with those of the gyroscope; far from it, but for outliers."""
    far = not 1 / EXTREME < abs(by_gyroscope.slope) < EXTREME
    few = far and by_gyroscope.kept.sum() > MOST * by_gyroscope.measured
    return by_gyroscope.explained > TIGHT or bool(few and by_gyroscope.correlation > CLOSELY)


def _on_straight_lines(evidence: Evidence, straight: float, forward: float | None) -> Finding:
    seen = f"the robot moves {straight:.3g} m for each m of tread travel on straight lines"
    if forward is not None and straight > STRAIGHT_TO_ALL * forward:
        return disagreement(f"{seen}, and {forward:.3g} m for each of all")
    if straight > 1 and (constant := reads_less(evidence)):
        return disagreement(f"{seen}; {constant}")
    if uneven := uneven_way(evidence, straight / ORDINARY_FORWARD):
        return disagreement(f"{seen}, by no constant factor: {uneven}")
    return scale_along(seen, straight, evidence.run.robot.wheel_radius is not None)


def _along(evidence: Evidence, forward: float, tight: bool, width: float | None) -> Finding:
    """Robot and treads move at different speeds along the way."""
    seen = f"the robot moves {forward:.3g} m for each m of tread travel"
    if width is not None:
        seen += f", and turns as if {width:.3g} track widths wide"
    if 1 / EXTREME < forward < EXTREME:
        if carried := carried_along(evidence):
            return disagreement(carried)
        if forward > 1 and (constant := reads_less(evidence)):
            return disagreement(f"{seen}; {constant}")
        if uneven := uneven_way(evidence, forward / ORDINARY_FORWARD):
            seen, tight = f"{seen}, by no constant factor: {uneven}", False
            if forward > 1 or one_side(evidence):
                return disagreement(seen)  # slip of one side alone does not explain its turns
    return _unit_or_slip(evidence, seen, forward, tight, width)


def _unit_or_slip(
    evidence: Evidence, seen: str, forward: float, tight: bool, width: float | None
) -> Finding:
    """A factor along the way, constant where it is `tight`."""
    extreme = not 1 / EXTREME < forward < EXTREME
    if (tight or extreme) and (imported := imported_unit(evidence, seen, forward, width)):
        return imported
    least = HOLDS if forward > 1 else SLIPS
    tread = matching(
        tread_units(evidence.run.robot.wheel_radius, evidence.period_s),
        lambda unit: forward * unit.factor,
        least,
    )
    radius_known = evidence.run.robot.wheel_radius is not None
    position = matching(
        POSITION_UNITS, lambda unit: forward / unit.factor, least, ONE_AXIS_STRETCHED
    )
    tread_fits = tread is not None and (width is None or 0.95 <= width / tread.factor <= WIDTH[1])
    if not tread_fits and forward * EXTREME < 1 and width is not None and width > EXTREME:
        tread = counts(forward, radius_known)
        tread_fits = True
    if tread is not None and tread_fits and (tight or extreme):
        counted = extreme and (
            forward * tread.factor < NEARLY * ORDINARY_FORWARD
            or tread.words in RARE
            or tread.factor == 1 / forward
            or _are_whole(evidence)
        )
        return tread_unit(
            seen, tread, evidence, *([COUNTS] if counted else []), measured=1 / forward
        )
    if (
        position is not None
        and (tight or extreme)
        and (width is None or WIDTH[0] <= width <= WIDTH[1])
    ):
        return Finding(
            "latitude_longitude" if position.factor < 1e-4 else "position_unit",
            Level.WARNING,
            seen,
            f"Positions of pose.csv are in {position.words}, not metres",
            "Convert x and y to local metres",
            mend=times("pose", 1 / position.factor, "x", "y"),
        )
    if not tight and width is not None and WIDTH[0] <= width < SLIPPERY_WIDTH:
        return disagreement(f"{seen}: slip along the way widens turns, too")
    if not tight or (forward < FORWARD[0] and width is not None and width > ORDINARY_WIDTH):
        opposed, radius_m = _opposed_share(evidence), evidence.run.robot.wheel_radius
        slips = slip_along(seen, forward, tight=tight, radius_m=radius_m, opposed=opposed)
        return farther_along(seen) if forward > 1 else slips
    return scale_along(seen, forward, radius_known)


def _opposed_share(evidence: Evidence) -> float:
    """Of the way of the treads, the share on which they run against each other."""
    speeds_m_s = evidence.speeds_m_s
    ways = np.abs(speeds_m_s).sum(axis=1)
    against = speeds_m_s.prod(axis=1) < 0
    return float(ways[against].sum() / max(ways.sum(), 1e-9))


def _are_whole(evidence: Evidence) -> bool:
    """Whether all speeds are whole numbers, as counts are."""
    return bool((evidence.speeds_m_s == np.round(evidence.speeds_m_s)).all())
