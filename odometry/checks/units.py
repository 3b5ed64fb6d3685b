"""Units of tread speeds, positions and yaw rate, and the track width."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.carried import carried_along
from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level, disagreement
from odometry.checks.proportion import holds_the_mean
from odometry.checks.relation import Relation, pieces
from odometry.checks.turn_signs import Sense, gyroscope_sense, pose_sense
from odometry.checks.undo import times
from odometry.checks.unit_findings import (
    SLIP_OR_TRACK,
    beyond_treads,
    gyroscope_unit,
    imported_unit,
    scale_along,
    slip_along,
    too_fast,
    track_against_body,
    tread_unit,
)
from odometry.checks.unit_tables import (
    ORDINARY_FORWARD,
    POSITION_UNITS,
    counts,
    matching,
    tread_units,
)

# Robots that were measured move 0.75 to 1.05 times as far as their treads where the terrain holds,
# and turn as if 1.0 to 3.1 times as wide; on ice 0.24 to 0.4 times as far, on snow 10 times
# as wide.
FORWARD = (0.55, 1.2)
WIDTH = (0.9, 4.0)
VERY_TIGHT = 0.85  # share of the turns explained from which a factor of turns alone may be a unit
TIGHT = 0.9  # correlation from which a factor is a unit and no slip
SLIDING = 0.6  # concentration of course less yaw below which the robot slides sideways
EXTREME = 8.0  # a factor that no slip explains
NOISE = 6.0  # noise of both ends adds 2 (sigma / distance)^2 to a distance, and may wander
HALF = 0.5  # share of the turns explained from which they have a width
LEAST_WINDOWS = 15  # from which a factor without heading can be called constant
PLAUSIBLE_M_S = 10.0  # no skid-steer robot is faster
NEARLY = 0.9  # of the ordinary way: farther off, the unit may be another one
COUNTS = "encoder ticks"
ORDINARY_WIDTH = 1.8
SLIPPERY_WIDTH = 2.1  # in track widths; where robots slipped along the way they turned as if 2.3
ONE_AXIS_STRETCHED = 1.6  # degrees of longitude taken for those of latitude


def units(evidence: Evidence) -> Iterator[Finding]:
    """Factors between sensors that are units, and a track width that nothing agrees with."""
    forward, forward_tight = _forward_factor(evidence)
    width, turn_tight, gyroscope_factor = _width_factor(evidence)
    if gyroscope_factor:
        yield gyroscope_unit(evidence, gyroscope_factor)
    low, high = FORWARD[0] * (1 - evidence.arm_share), FORWARD[1] * (1 + evidence.arm_share)
    high *= 1 + _longer_by_noise(evidence)
    if forward is not None and not low <= forward <= high:
        carried = carried_along(evidence) if 1 / EXTREME < forward < EXTREME else ""
        yield disagreement(carried) if carried else _along(evidence, forward, forward_tight, width)
    elif (straight := beyond_treads(evidence)) is not None:
        seen = f"the robot moves {straight:.3g} m for each m of tread travel on straight lines"
        yield scale_along(seen, straight, evidence.run.robot.wheel_radius is not None)
    if width is not None and width < WIDTH[0] and (mean := holds_the_mean(evidence)):
        yield disagreement(mean)
    elif width is not None and not WIDTH[0] <= width <= WIDTH[1]:
        # one scale of the treads lengthens their way and widens the robot by the same factor
        if forward is None or low <= forward or not WIDTH[0] <= width * forward <= WIDTH[1]:
            yield _across(evidence, forward, width, turn_tight)
    elif evidence.fastest_m_s > PLAUSIBLE_M_S and forward is None:
        yield too_fast(evidence)
    elif (stated := track_against_body(evidence)) is not None:
        yield stated


def _forward_factor(evidence: Evidence) -> tuple[float | None, bool]:
    """Measured displacement per mean tread travel, and whether it is constant."""
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


def _width_factor(evidence: Evidence) -> tuple[float | None, bool, float | None]:
    """Effective width in track widths, whether it is constant, and the factor of the gyroscope."""
    track = evidence.run.robot.track_width
    gyroscope, pose = evidence.gyroscope_by_difference, evidence.pose_turn_by_difference
    factor = _gyroscope_factor(evidence)
    for found, of, scale in (
        (gyroscope, gyroscope_sense(evidence), factor or 1.0),
        (pose, pose_sense(evidence), 1.0),
    ):
        known = found is not None and found.certain() and found.explained > HALF
        if found is not None and known and of in (Sense.AGREES, Sense.OPPOSITE):
            width = scale / (abs(found.slope) * track)
            odd = not WIDTH[0] <= width <= WIDTH[1]
            if odd and not all(_odd(scale / (of * track)) for of in _slopes(evidence, found)):
                return None, False, factor  # a part of the recording alone makes it odd
            return width, found.correlation > TIGHT, factor
    return None, False, factor


def _odd(width: float) -> bool:
    """Whether a width of a piece of the recording is odd, with less certainty than of all."""
    return not 1.2 * WIDTH[0] <= width <= 0.7 * WIDTH[1]


def _slopes(evidence: Evidence, found: Relation) -> list[float]:
    """Turn per difference of the treads in the pieces of the recording that determine it."""
    m = evidence.uniform
    fits = pieces(m.gyroscope_rad, m.difference_m, m.lasts_s)
    if found is evidence.pose_turn_by_difference:
        fits = pieces(evidence.pose_turn_rad, evidence.turn_motion.difference_m)
    return [abs(of.slope) for of in fits if of.certain() and of.explained > HALF]


def _gyroscope_factor(evidence: Evidence) -> float | None:
    """Factor by which the gyroscope is too large; None where it is in rad/s or not known."""
    by_gyroscope = evidence.pose_turn_by_gyroscope
    if by_gyroscope is not None and by_gyroscope.certain() and by_gyroscope.explained > TIGHT:
        factor = 1 / abs(by_gyroscope.slope)
        m = evidence.turn_motion
        fits = pieces(evidence.pose_turn_rad, m.gyroscope_rad, m.lasts_s)
        parts = [1 / abs(of.slope) for of in fits if of.certain()]
        lasts = all((part > 1.2 if factor > 1 else part < 0.85) for part in parts)
        return factor if lasts and not 0.7 < factor < 1.4 else None
    found, rate = evidence.gyroscope_by_difference, evidence.yaw_rate
    if evidence.yaw_measured or found is None or rate is None or not found.certain():
        return None
    width = 1 / (abs(found.slope) * evidence.run.robot.track_width)
    degrees = width < 0.2 and float(np.quantile(np.abs(rate[1]), 0.99)) > 4.0
    return 180 / np.pi if degrees else None


def _along(evidence: Evidence, forward: float, tight: bool, width: float | None) -> Finding:
    """Robot and treads move at different speeds along the way."""
    seen = f"the robot moves {forward:.3g} m for each m of tread travel"
    if width is not None:
        seen += f", and turns as if {width:.3g} track widths wide"
    extreme = not 1 / EXTREME < forward < EXTREME
    if (tight or extreme) and (imported := imported_unit(evidence, seen, forward, width)):
        return imported
    tread = matching(
        tread_units(evidence.run.robot.wheel_radius, evidence.period_s),
        lambda unit: forward * unit.factor,
    )
    radius_known = evidence.run.robot.wheel_radius is not None
    position = matching(POSITION_UNITS, lambda unit: forward / unit.factor, ONE_AXIS_STRETCHED)
    tread_fits = tread is not None and (width is None or 0.95 <= width / tread.factor <= WIDTH[1])
    if not tread_fits and forward * EXTREME < 1 and width is not None and width > EXTREME:
        tread = counts(forward, radius_known)
        tread_fits = True
    if tread is not None and tread_fits and (tight or extreme):
        counted = extreme and forward * tread.factor < NEARLY * ORDINARY_FORWARD
        return tread_unit(seen, tread, evidence, *([COUNTS] if counted else []))
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
        return slip_along(seen, tight)
    return scale_along(seen, forward, radius_known)


def _across(evidence: Evidence, forward: float | None, width: float, tight: bool) -> Finding:
    """The robot turns as if of another width, while nothing contradicts the distance driven."""
    track = evidence.run.robot.track_width
    seen = (
        f"the robot turns as if {width * track:.3g} m wide, {width:.3g} times the track_width of "
        f"{track:g} m"
    )
    body = evidence.run.robot.width
    if forward is None and evidence.fastest_m_s > PLAUSIBLE_M_S:
        return too_fast(evidence)
    tread = matching(
        tread_units(evidence.run.robot.wheel_radius, evidence.period_s),
        lambda unit: ORDINARY_WIDTH * unit.factor / width,
    )
    body_fits = body is not None and 0.5 * body <= track <= 1.1 * body
    very_tight = _turns_explained(evidence) > VERY_TIGHT
    if forward is None and very_tight and width > WIDTH[1] and tread is not None and body_fits:
        return tread_unit(
            f"{seen}; there are no positions to say more", tread, evidence, SLIP_OR_TRACK
        )
    if width > WIDTH[1] and (forward is None or not tight) and body_fits:
        return Finding(
            "slip_in_turns",
            Level.WARNING,
            seen,
            "Heavy slip in turns (snow), or tread speeds in another unit (rad/s, km/h), or a wrong "
            "track_width: these cannot be distinguished here",
            "Decide by what the robot drove on; add poses to distinguish them",
        )
    unit = " (mm?)" if width < 0.01 else _tenfold(width / ORDINARY_WIDTH)
    return Finding(
        "track_width",
        Level.WARNING,
        seen,
        f"track_width of run.toml is wrong{unit}; a skid-steer robot turns as if 1 to 3 track "
        "widths wide",
        "Measure the distance between the middles of the left and the right treads, in metres",
    )


def _tenfold(factor: float) -> str:
    """Words for a factor near a power of ten."""
    for power, words in (
        (10.0, "ten times too small"),
        (0.1, "ten times too large"),
        (100.0, "in another unit"),
        (0.01, "in cm"),
    ):
        if 0.5 < factor / power < 2:
            return f", likely {words}"
    return ""


def _turns_explained(evidence: Evidence) -> float:
    """Share of the turns that the difference of the treads explains."""
    found = evidence.gyroscope_by_difference or evidence.pose_turn_by_difference
    return found.explained if found is not None else 0.0
