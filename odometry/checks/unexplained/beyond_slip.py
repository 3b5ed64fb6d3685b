"""Motion that no slip explains: each tread moves by no more than it reads, and no other way."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.heading import Heading, middle_yaw
from odometry.checks.evidence.motion import Motion, motion_between
from odometry.checks.evidence.scatter import noise_of_ends
from odometry.checks.statistics.relation import Relation, relation
from odometry.windows.recorded.gaps import odometry_gaps
from odometry.windows.recorded.spans import touched

WINDOW_S = 1.0  # so long that a robot which follows its treads later, or coasts, hardly counts
FARTHER = 1.1  # than the treads read, by their scale and that of the poses
STANDS = 0.1  # of the ordinary fastest speed, by which a robot may move while a tread stands
ARM = 0.3  # of the track width: of an antenna, whose way in turns is its own
# Share of the motion that is beyond, and of the windows. In 75 real recordings, ice among them, at
# most 0.02 and 0.06 of both sensors of the turns, or of the way; 0.17 and 0.01 in one.
SHARE, OFTEN = 0.08, 0.04
NOISE = 2.0  # standard deviations of a window, by which noise of its two ends may make it longer
LEAST_WINDOWS = 20
LEAST_TRAVEL_M = 2.0  # of the treads, all along
LEAST_FORWARDS = 0.5  # how clearly treads say which way is forwards


def beyond_slip(evidence: Evidence) -> str:
    """Words where the robot often turns or moves as no slip of its treads allows; "" elsewhere.

    A tread that slips moves its side of the robot by some share of what it reads: between nothing
    and all of it. Turns count where every sensor that measures them says so.
    """
    if evidence.run.wheel_travel_m[-1] < LEAST_TRAVEL_M:
        return ""
    turns = [_turns_beyond(evidence, of, turn) for of, turn in _measured_turns(evidence)]
    if turns and min(share for share, _ in turns) > SHARE and min(o for _, o in turns) > OFTEN:
        return (
            f"{100 * min(share for share, _ in turns):.0f} % of the measured turns are beyond what "
            "any slip of the treads allows"
        )
    share, often = _way_beyond(evidence)
    if share > SHARE and often > OFTEN:
        return (
            f"{100 * share:.0f} % of the measured way is beyond what any slip of the treads allows"
        )
    return ""


def _measured_turns(evidence: Evidence) -> list[tuple[Motion, FloatArray]]:
    found = []
    if evidence.yaw_rate is not None:
        of = motion_between(evidence.run, evidence.integrals, None, WINDOW_S)
        turn_rad = evidence.turn_rad(of)
        fit = relation(turn_rad, of.difference_m, of.lasts_s)
        bias_rad_s = 0.0 if fit is None else float(fit.coefficients[1])
        found += [(of, turn_rad), (of, turn_rad - bias_rad_s * of.lasts_s)]  # with and without one
    if evidence.yaw_measured:
        found.append((evidence.motion, evidence.pose_turn_rad))
    return found


def _turns_beyond(evidence: Evidence, of: Motion, turn_rad: FloatArray) -> tuple[float, float]:
    by_gyroscope, by_poses = evidence.gyroscope_by_difference, evidence.pose_turn_by_difference
    width_m = min(_width_m(evidence, found) for found in (by_gyroscope, by_poses))
    left_m, right_m = of.left_m, of.right_m
    most = (np.maximum(right_m, 0.0) - np.minimum(left_m, 0.0)) / width_m
    least = (np.minimum(right_m, 0.0) - np.maximum(left_m, 0.0)) / width_m
    noise_rad = _noise(of, turn_rad, of.difference_m, of.lasts_s)
    allowed = STANDS * evidence.fastest_m_s * of.lasts_s / width_m + NOISE * noise_rad
    return _beyond(evidence, of, turn_rad, (least, most), allowed)


def _width_m(evidence: Evidence, found: Relation | None) -> float:
    width_m = evidence.run.robot.track_width
    if found is None or not found.certain():
        return width_m
    return min(width_m, 1 / abs(found.slope))


def _way_beyond(evidence: Evidence) -> tuple[float, float]:
    heading = evidence.heading
    if heading is None or heading.forwards < LEAST_FORWARDS:
        return 0.0, 0.0
    of = evidence.of_origin(
        motion_between(evidence.run, evidence.integrals, evidence.poses_used, WINDOW_S)
    )
    scale = max(evidence.metres_per_metre or 1.0, 1.0)
    most, least = (
        scale * (of_side(of.left_m, 0.0) + of_side(of.right_m, 0.0)) / 2
        for of_side in (np.maximum, np.minimum)
    )
    turned_m = ARM * evidence.run.robot.track_width * np.abs(evidence.turn_rad(of))
    ahead_m = _ahead_m(of, heading)
    noise_m = _noise(of, ahead_m, of.mean_m)
    allowed = STANDS * evidence.fastest_m_s * of.lasts_s + turned_m + NOISE * noise_m
    return _beyond(evidence, of, ahead_m, (least, most), allowed)


def _ahead_m(of: Motion, heading: Heading) -> FloatArray:
    """Measured way (K,) in the direction in which the robot mostly goes where treads go forwards.

    So that an offset of yaw, and axes that are exchanged, do not matter.
    """
    off = of.course_rad - middle_yaw(of, heading) - heading.offset_rad
    return np.asarray(of.distance_m * np.cos(off))


def _noise(of: Motion, measured: FloatArray, *columns: FloatArray) -> float:
    """Standard deviation of the measured motion (K,) by noise of poses, beside the columns (K,)."""
    fit = relation(measured, *columns)
    return 0.0 if fit is None else noise_of_ends(of, fit)


def _beyond(
    evidence: Evidence,
    of: Motion,
    measured: FloatArray,
    limits: tuple[FloatArray, FloatArray],
    allowed: FloatArray,
) -> tuple[float, float]:
    """Share of the motion (K,) that is outside of its limits, and of the windows that are."""
    least, most = limits
    over = np.maximum(measured - FARTHER * most, FARTHER * least - measured) - allowed
    known = np.isfinite(over) & ~evidence.left_out(of.start_s, of.end_s)
    known &= ~touched(odometry_gaps(evidence.run).spans_s, of.start_s, of.end_s)
    if known.sum() < LEAST_WINDOWS:
        return 0.0, 0.0
    over, whole = np.maximum(over[known], 0.0), float(np.sum(np.abs(measured[known])))
    return float(np.sum(over)) / max(whole, 1e-9), float(np.mean(over > 0))
