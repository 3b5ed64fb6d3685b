"""Whether speeds are proportional to those of the treads, slow and fast, left and right."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion, turns_both_ways
from odometry.checks.findings.finding import Finding, Level, disagreement
from odometry.checks.statistics.relation import Relation, relation
from odometry.checks.treads.turns_by_treads import squares_by_parts
from odometry.checks.turns.turn_signs import lasting_turn_rad

SLOW, FAST = 0.25, 0.9  # shares of the ordinary fastest speed that are compared
SQUARED = 4.0  # the same of squared speeds is 3.6: no motor is more bent
NEXT_TO_NONE, BETWEEN = 0.1, 0.45  # the same, of slow windows; above the second ones are fast
LEAST_OF_EACH = 10  # windows
UNLIKE = 1.3  # ratio of what a metre at slow and at fast speed moves the robot; slip stays below
LASTING = 1.12  # the same in each half of the recording, and in turns where there are enough
SURELY = 0.1  # of what a metre turns: standard deviation of its bend
CERTAIN = 6.0  # standard deviations
HALVED = 0.6  # share of the residual squares that is left when proportion is given up
HELD = 0.95  # share of the motion explained then: else it may be slip
# Where less is explained; of 28 real recordings that ratio is 1.1 at most.
HARDLY_HELD, FAR_UNLIKE = 0.8, 1.5
PARTS, AS_WELL = 32, 0.9  # of the time, and times what a curve leaves of the way
ONE_SIDE = 0.12  # turn at full speed straight on, as a share of that by one tread alone
NARROW = 1.2  # track widths: robots that were measured turn as if 1.0 to 3.1 wide
WHOLE = 0.85  # share of the way along that one column has
LEAST_TURN_RAD = 3.0  # range of the heading from which turns are compared
ALIKE = 0.3  # share of the changing part of the turns that the treads explain at least
CHANGING = 0.1  # share of the squared turns that changes, from which it is compared
LEAST_WINDOWS = 30


def proportion(evidence: Evidence) -> Iterator[Finding]:
    """Columns that hold what drives the motors, and not the speeds that come of it."""
    m, forward_m = evidence.motion, evidence.forward_m
    squared = _squared(evidence, m.mean_m, m)
    plain, bent = evidence.forward_by_mean, relation(forward_m, m.mean_m, squared)
    if plain is None or bent is None or bent.measured < LEAST_WINDOWS:
        return
    if _slow_by_fast(bent) < UNLIKE or not _has_both(evidence) or holds_the_mean(evidence):
        return
    halves = (
        relation(forward_m[rows], m.mean_m[rows], squared[rows])
        for rows in np.array_split(np.flatnonzero(np.isfinite(forward_m)), 2)
    )
    parts = [half for half in halves if half is not None]
    if len(parts) < 2 or min(map(_slow_by_fast, parts)) < LASTING or _turns_proportional(evidence):
        return
    slow, fast = _slow_and_fast(bent)
    seen = (
        f"a metre of tread travel moves the robot by {slow:.3g} m at a quarter of the ordinary "
        f"fastest speed, and by {fast:.3g} m near it"
    )
    sure = any(part.certain(1, CERTAIN) for part in parts)
    named = sure and _explains(plain, bent, 1) and _slow_by_fast(bent) < SQUARED
    if named and 1 - _explained_by_time(evidence) < AS_WELL * (1 - bent.explained):
        yield disagreement(f"{seen}, or by factors that change with time")
        return
    if bent.explained < HELD or not named:
        if bent.explained > HARDLY_HELD and bent.certain(1) and _slow_by_fast(bent) > FAR_UNLIKE:
            yield disagreement(seen)
        return
    yield Finding(
        "treads_not_proportional",
        Level.WARNING,
        seen,
        "Speeds are not proportional to those of the treads: the columns hold what drives the "
        "motors (a duty cycle, throttle or voltage), or encoders miss ticks",
        "Log measured wheel speeds",
    )


def _explained_by_time(evidence: Evidence) -> float:
    """Share of the squares of the way that one factor for each short part of the time explains."""
    mean_m, forward_m = evidence.motion.mean_m, evidence.forward_m
    rows = np.array_split(np.flatnonzero(np.isfinite(forward_m)), PARTS)
    left = 0.0
    for part in rows:
        of, by = forward_m[part], mean_m[part]
        left += float(np.sum(of**2) - (of @ by) ** 2 / max(float(by @ by), 1e-300))
    return 1 - left / max(float(np.nansum(forward_m**2)), 1e-300)


def _has_both(evidence: Evidence) -> bool:
    """Whether the robot drives slowly and fast along: a curve says nothing beyond its speeds."""
    m = evidence.motion
    share = np.abs(m.mean_m) / np.maximum(m.lasts_s * evidence.fastest_m_s, 1e-9)
    slow = (share > NEXT_TO_NONE) & (share < BETWEEN)
    return bool(min(np.sum(slow), np.sum(share > BETWEEN)) >= LEAST_OF_EACH)


def _slow_and_fast(bent: Relation, place: int = 0, more: int = 1) -> tuple[float, float]:
    """What a metre of travel moves at slow and at fast speed."""
    plain, bend = (float(bent.coefficients[i]) for i in (place, more))
    return plain + SLOW * bend, plain + FAST * bend


def _slow_by_fast(bent: Relation) -> float:
    slow, fast = _slow_and_fast(bent)
    return slow / fast if fast > 0 else float("inf")


def _turns_proportional(evidence: Evidence) -> bool:
    """Whether turns surely are proportional to the treads: then no column is bent."""
    m, turns = evidence.uniform, evidence.uniform.gyroscope_rad
    if evidence.yaw_rate is None:
        m, turns = evidence.turn_motion, evidence.pose_turn_rad
    left, right = (_squared(evidence, way_m, m) for way_m in (m.left_m, m.right_m))
    bent = relation(turns, m.right_m - m.left_m, right - left, m.lasts_s)
    if bent is None or bent.sigmas[1] > SURELY * abs(bent.slope):
        return False
    return _slow_by_fast(bent) < LASTING


def one_side_not_proportional(evidence: Evidence) -> str:
    """A robot that turns when it drives straight on fast, and not slowly."""
    m, turns = evidence.uniform, evidence.uniform.gyroscope_rad
    if evidence.yaw_rate is None:
        m, turns = evidence.turn_motion, evidence.pose_turn_rad
    if len(m) < LEAST_WINDOWS or not turns_both_ways(m):
        return ""
    left, right = (_squared(evidence, way_m, m) for way_m in (m.left_m, m.right_m))
    plain = relation(turns, m.left_m, m.right_m, right - left, m.lasts_s)
    bent = relation(turns, m.left_m, m.right_m, right - left, m.lasts_s, right + left)
    if plain is None or bent is None or not _explains(plain, bent, 4):
        return ""
    share = float(bent.coefficients[4] / np.mean(np.abs(bent.coefficients[:2])))
    if abs(share) < ONE_SIDE or _by_terrain(m, turns) < AS_WELL * (1 - bent.explained):
        return ""
    side = "left" if share < 0 else "right"
    return (
        f"the faster it drives straight on, the more it turns, against the treads "
        f"({100 * abs(share):.0f} % of one tread at full speed), as if the encoder of the {side} "
        "tread missed ticks, or the other one counted too many"
    )


def _by_terrain(m: Motion, turns_rad: FloatArray) -> float:
    """Share of the squared turns that is left where each part of a drive has its own scales."""
    rows = np.stack([m.left_m, m.right_m, m.lasts_s])
    known = np.isfinite(turns_rad) & np.isfinite(rows).all(axis=0)
    whole = float(np.sum(turns_rad[known] ** 2))
    return squares_by_parts(rows[:, known], turns_rad[known]) / max(whole, 1e-300)


def holds_the_mean(evidence: Evidence) -> str:
    """A column that alone is the way along, of a robot that turns as if it were too narrow.

    Turns by a tread and the mean are those of half the width, and the mean is the way along. A
    sensor above one tread of a robot that turns without slip has the same effect.
    """
    turn, forward = evidence.gyroscope_by_difference, evidence.forward_by_treads
    if evidence.yaw_rate is None:
        turn = evidence.pose_turn_by_difference
    if turn is None or forward is None or not turn.certain() or not forward.distinct:
        return ""
    width = 1 / (abs(turn.slope) * evidence.run.robot.track_width)
    shares = forward.coefficients / float(np.sum(forward.coefficients))
    if width > NARROW or float(np.max(shares)) < WHOLE:
        return ""
    side = ("left", "right")[int(np.argmax(shares))]
    return (
        f"the way along is that of v_{side} alone ({100 * float(np.max(shares)):.0f} %), and the "
        f"robot turns as if {width:.2g} track widths wide, as if v_{side} were the mean (average) "
        "of both treads; or track_width is wrong, and the sensor sits above one tread"
    )


def treads_unlike(evidence: Evidence) -> Iterator[str]:
    """Turns, apart from their mean rate, of which the treads explain little."""
    for name, motion, turns in (
        ("the gyroscope", evidence.uniform, evidence.uniform.gyroscope_rad),
        ("the poses", evidence.turn_motion, evidence.pose_turn_rad),
    ):
        columns = np.stack([motion.left_m, motion.right_m, motion.lasts_s, turns], axis=-1)
        known = np.isfinite(columns).all(axis=1)
        measured = evidence.yaw_measured or motion is evidence.uniform
        if known.sum() < LEAST_WINDOWS or not measured:
            continue
        if lasting_turn_rad(turns, motion.lasts_s) < LEAST_TURN_RAD:
            continue
        columns = columns[known]
        whole = float(np.sum(columns[:, 3] ** 2))
        columns = columns - columns.mean(axis=0)
        design, target = columns[:, :3], columns[:, 3]
        if np.sum(target**2) < CHANGING * whole:
            continue  # a steady turn: what changes is slip
        left = target - design @ np.linalg.lstsq(design, target, rcond=None)[0]
        share = 1 - float(np.sum(left**2) / max(np.sum(target**2), 1e-300))
        if share < ALIKE:
            yield (
                f"the treads explain {100 * max(share, 0.0):.0f} % of the changing turns of {name} "
                "(slip alone leaves more on most terrain)"
            )


def _squared(evidence: Evidence, way_m: FloatArray, motion: Motion) -> FloatArray:
    """Travel (K,) weighted by its speed, as a share of the ordinary fastest."""
    fastest_m = np.maximum(motion.lasts_s * evidence.fastest_m_s, 1e-9)
    return np.asarray(way_m * np.abs(way_m) / fastest_m)


def _explains(plain: Relation, bent: Relation, place: int) -> bool:
    left = 1 - bent.explained
    return bent.certain(place, CERTAIN) and left < HALVED * (1 - plain.explained)
