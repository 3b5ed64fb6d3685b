"""Steps of the measured yaw against the gyroscope."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted, disagreement
from odometry.checks.poses.steps import (
    FAR_S,
    JITTER_S,
    JUMP_TIMES,
    first_ones,
    jumps_by_itself,
    moments,
    rate_of,
    step_sizes,
)
from odometry.windows.recorded.gaps import odometry_gaps
from odometry.windows.recorded.spans import runs_of, within

LEAST_JUMP_RAD = np.radians(25)
LEAST_STEPS = 20
HALF_TURN_RAD = np.radians(30)  # a jump that is off by less is half a turn
WAY_M = 0.05  # from a jump on, of the treads' travel that says which way the robot drives
AS_COURSE = (
    "Yaw is the course over ground, which turns round where the robot reverses: not the heading "
    "(a receiver without a second antenna or a compass)",
    "Leave yaw empty: positions alone are used then",
)
CORRECTED = (
    "Yaw jumps: the heading of the reference was corrected, lost or held for a while "
    "(magnetometer, antennas), or has another meaning in a part of the run; or "
    "two recordings are joined there",
    "Number the stretches between jumps in a column `window`, or cut with --from and --to",
)

ACROSS_WRAP = (
    "Either yaw was interpolated or averaged across its wrap (from pi to -pi, from 2 pi to 0): "
    "rows between lie on neither side; or yaw jumps (a reference that was corrected)",
    "Interpolate sine and cosine of yaw, or log the rows that were measured",
)
# Of a full turn: the range of raw yaw around a wrap, and a step within it that a wrap is.
WRAPS, STEPS = 0.8, 0.75


def yaw_jumps(evidence: Evidence, rows: IntArray) -> Iterator[Finding]:
    """Steps of the measured yaw against the gyroscope, and whether the yaw itself makes them.

    `rows` (M,) are those of pose.csv that are checked.
    """
    pose = evidence.run.pose
    if pose is None or not evidence.yaw_measured or evidence.yaw_rate is None:
        return
    by_gyroscope = evidence.pose_turn_by_gyroscope
    if by_gyroscope is None or by_gyroscope.correlation < 0.9:
        return
    of_rate_s = evidence.yaw_rate[0]
    rows = rows[within(pose.stamps_s[rows], np.array([[of_rate_s[0], of_rate_s[-1]]]))]
    stamps_s = pose.stamps_s[rows]
    yaw = np.radians(pose["yaw"][rows]) if evidence.yaw_in_degrees else pose["yaw"][rows]
    heading = evidence.integrals.gyroscope_rad(stamps_s) * by_gyroscope.slope
    known = np.isfinite(yaw) & np.isfinite(heading)
    stamps_s, yaw, heading = stamps_s[known], np.unwrap(yaw[known]), heading[known]
    step = _steps(evidence, stamps_s, np.unwrap(yaw - heading))
    measured = np.isfinite(step)
    if measured.sum() < LEAST_STEPS:
        return
    usual = 1.4826 * float(np.median(step[measured]))
    rate = np.abs(rate_of(heading, stamps_s))
    odd = measured & (step > np.maximum(JUMP_TIMES * usual, LEAST_JUMP_RAD + JITTER_S * rate))
    peaks = [begin + int(np.argmax(step[begin:end])) for begin, end in runs_of(odd)]
    own = [i for i in peaks if jumps_by_itself(stamps_s, yaw[:, None], i, float(step[i]))]
    if own:
        yield _jumps(evidence, stamps_s[own], step[own], _across_wraps(evidence, stamps_s[own]))
    elif peaks:
        yield disagreement(
            f"yaw of pose.csv and the gyroscope differ by {np.degrees(step[peaks[0]]):.0f} "
            f"degrees within {2 * FAR_S:g} s at {evidence.run_time_s(stamps_s[peaks[0]]):.1f} s; "
            "yaw itself has no jump there"
        )


def _steps(evidence: Evidence, stamps_s: FloatArray, off_rad: FloatArray) -> FloatArray:
    """`step_sizes` (M,) of yaw less gyroscope; NaN where the gyroscope was not recorded."""
    step = step_sizes(stamps_s, np.stack([off_rad, np.zeros_like(off_rad)], axis=-1))
    gaps_s = evidence.silent_s
    if evidence.gyroscope_file == "odometry.csv":
        gaps_s = np.concatenate([gaps_s, odometry_gaps(evidence.run).spans_s])
    step[within(stamps_s, gaps_s + np.array([-FAR_S, FAR_S]))] = np.nan
    return step


def _across_wraps(evidence: Evidence, at_s: FloatArray) -> int:
    """Moments around which raw yaw goes over its whole range in rows between both ends."""
    assert evidence.run.pose is not None  # noqa: S101 - checked by the caller
    stamps_s, raw = evidence.run.pose.stamps_s, evidence.run.pose["yaw"]
    full = 360.0 if evidence.yaw_in_degrees else 2 * np.pi
    parts = (raw[(stamps_s > s - FAR_S) & (stamps_s < s + FAR_S)] for s in at_s.tolist())
    whole = [part for part in parts if np.ptp(part) > WRAPS * full]
    return sum(float(np.abs(np.diff(part)).max()) < STEPS * full for part in whole)


def _jumps(evidence: Evidence, at_s: FloatArray, steps_rad: FloatArray, wraps: int) -> Finding:
    turned = np.abs(steps_rad - np.pi) < HALF_TURN_RAD
    reverses = sum(_reverses(evidence, stamp_s) for stamp_s in at_s[turned].tolist())
    sizes = [f"{degrees:.0f} degrees" for degrees in np.degrees(steps_rad)]
    places = first_ones(evidence, at_s, sizes)
    cause = AS_COURSE if 2 * reverses > len(at_s) else CORRECTED
    return Finding(
        "yaw_jumps",
        Level.WARNING,
        f"yaw of pose.csv jumps against the gyroscope, and stays, {counted(len(at_s), 'time')}: "
        f"{places}",
        *(ACROSS_WRAP if 2 * wraps > len(at_s) else cause),
        moments(evidence, at_s),
    )


def _reverses(evidence: Evidence, stamp_s: float) -> bool:
    """Whether the robot drives the other way after a stamp than it did before, with any pause."""
    of, here = evidence.integrals, int(np.searchsorted(evidence.stamps_s, stamp_s))
    travel_m = (of.left_m(evidence.stamps_s) + of.right_m(evidence.stamps_s)) / 2
    ahead_m = travel_m - travel_m[min(here, len(travel_m) - 1)]
    far = np.abs(ahead_m) > WAY_M
    before, after = np.flatnonzero(far[:here]), np.flatnonzero(far[here:]) + here
    return bool(len(before) and len(after) and ahead_m[before[-1]] * ahead_m[after[0]] > 0)
