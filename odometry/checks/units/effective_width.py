"""The width as which a robot turns, and a track width that it does not go with."""

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, disagreement
from odometry.checks.findings.unit_tables import matching, tread_units
from odometry.checks.statistics.relation import Relation, pieces
from odometry.checks.turns.turn_signs import Sense, gyroscope_sense, pose_sense
from odometry.checks.units.unit_findings import SLIP_OR_TRACK, too_fast, tread_unit

# Robots that were measured turn as if 1.0 to 3.1 times as wide, on snow 10 times as wide.
WIDTH = (0.9, 4.0)
ORDINARY_WIDTH = 1.8
FIRM = (0.75, 1.05)  # metres that robots were measured to move for each one of their treads
TIGHT = 0.9  # correlation from which a factor is a unit and no slip
VERY_TIGHT = 0.85  # share of the turns explained from which a factor of turns alone may be a unit
HALF = 0.5  # share of the turns explained from which they have a width
PLAUSIBLE_M_S = 10.0  # no skid-steer robot is faster
MIXED = 0.3  # of the narrowest width, or of one over the widest: no farther by a mix or a scale


def width_factor(evidence: Evidence, gyroscope_factor: float) -> tuple[float | None, bool]:
    """Effective width in track widths, and whether it is constant.

    Turns are those of the gyroscope, else of the poses. Where both are known, only both of them
    can say that it is odd: a gyroscope that reads too much narrows the robot alone.
    """
    track = evidence.run.robot.track_width
    known = []
    for found, of, scale in (
        (evidence.gyroscope_by_difference, gyroscope_sense(evidence), gyroscope_factor),
        (evidence.pose_turn_by_difference, pose_sense(evidence), 1.0),
    ):
        sure = found is not None and found.certain() and found.explained > HALF
        if found is not None and sure and of in (Sense.AGREES, Sense.OPPOSITE):
            known.append((scale / (abs(found.slope) * track), found, scale))
    usual = [one for one in known if WIDTH[0] <= one[0] <= WIDTH[1]]
    if not known:
        return None, False
    width, found, scale = (usual or known)[0]
    if not usual and not all(_odd(scale / (of * track)) for of in _slopes(evidence, found)):
        return None, False  # a part of the recording alone makes it odd
    return width, found.correlation > TIGHT


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


def across(evidence: Evidence, forward: float | None, width: float, tight: bool) -> Finding:
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
    explained = _turns_explained(evidence)
    very_tight = explained > VERY_TIGHT
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
    if width < WIDTH[0] and not very_tight:
        return disagreement(
            f"{seen}, but the treads explain only {100 * explained:.0f} % of its turns"
        )
    unit = " (mm?)" if width < 0.01 else _tenfold(width / ORDINARY_WIDTH)
    possible = (body is None or body_fits) and MIXED * WIDTH[0] < width < WIDTH[1] / MIXED
    others = _others(evidence, forward, width) if possible else ""
    if width < WIDTH[0] and not possible:
        others = ", or the treads differ by too little: speeds clipped at a limit, a mean of both"
    return Finding(
        "track_width",
        Level.WARNING,
        seen,
        f"track_width of run.toml is wrong{unit}{others}; a skid-steer robot turns as if 1 to 3 "
        "track widths wide",
        "Measure the distance between the middles of the left and the right treads, in metres",
    )


def _others(evidence: Evidence, forward: float | None, width: float) -> str:
    """What else makes turns too large, or too small, for their treads by a factor."""
    narrow = width < WIDTH[0]
    mixed = ", or the column of each tread holds a part of the other one (cross-talk, a mean)"
    size, more = ("small", "much") if narrow else ("large", "little")
    scaled = f"tread speeds{' and positions' if forward is not None else ''} are too {size}"
    if forward is not None and _is_off_as_well(forward, width):
        scaled = (
            f"tread speeds are too {size} (a unit, a wheel radius): the robot moves {forward:.3g} "
            "m for each m of tread travel, too"
        )
    alone = "" if evidence.yaw_measured else f", or the gyroscope reads too {more}"
    return f"{mixed if narrow else ''}, or {scaled}{alone}: these cannot be distinguished"


def _is_off_as_well(forward: float, width: float) -> bool:
    """Whether one scale of the treads makes both ordinary, of a way that firm terrain has not."""
    holds = FIRM[0] <= forward <= FIRM[1]
    return not holds and WIDTH[0] <= width * forward <= WIDTH[1]


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
