"""Steps of the measured yaw against the gyroscope."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import IntArray
from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level, counted
from odometry.checks.spans import runs_of, within
from odometry.checks.steps import FAR_S, JITTER_S, JUMP_TIMES, SHOWN, moments, rate_of, step_sizes
from odometry.windows.gaps import odometry_gaps

LEAST_YAW_JUMP_RAD = np.radians(25)


def yaw_jumps(evidence: Evidence, rows: IntArray) -> Iterator[Finding]:
    """Steps of the measured yaw against the gyroscope."""
    pose = evidence.run.pose
    if pose is None or not evidence.yaw_measured or evidence.yaw_rate is None:
        return
    by_gyroscope = evidence.pose_turn_by_gyroscope
    if by_gyroscope is None or by_gyroscope.correlation < 0.9:
        return
    stamps_s = np.clip(pose.stamps_s[rows], evidence.stamps_s[0], evidence.stamps_s[-1])
    yaw = np.radians(pose["yaw"][rows]) if evidence.yaw_in_degrees else pose["yaw"][rows]
    heading = evidence.integrals.gyroscope_rad(stamps_s) * by_gyroscope.slope
    known = np.isfinite(yaw) & np.isfinite(heading)
    stamps_s, off = stamps_s[known], np.unwrap((yaw - heading)[known])
    step = step_sizes(stamps_s, np.stack([off, np.zeros_like(off)], axis=-1))
    measured = np.isfinite(step)
    if evidence.gyroscope_file == "odometry.csv":
        gaps_s = odometry_gaps(evidence.run).spans_s
        measured &= ~within(stamps_s, gaps_s + np.array([-FAR_S, FAR_S]))
    if measured.sum() < 20:
        return
    usual = 1.4826 * float(np.median(step[measured]))
    rate = np.abs(rate_of(heading[known], stamps_s))
    odd = measured & (step > np.maximum(JUMP_TIMES * usual, LEAST_YAW_JUMP_RAD + JITTER_S * rate))
    peaks = [begin + int(np.argmax(step[begin:end])) for begin, end in runs_of(odd)]
    if not peaks:
        return
    yield Finding(
        "yaw_jumps",
        Level.WARNING,
        f"yaw of pose.csv jumps against the gyroscope, and stays, {counted(len(peaks), 'time')}: "
        + ", ".join(
            f"{np.degrees(step[i]):.0f} degrees at {evidence.run_time_s(stamps_s[i]):.1f} s"
            for i in peaks[:SHOWN]
        ),
        "Yaw jumps: the heading of the reference was corrected or lost (magnetometer, antennas)",
        "Number the stretches between jumps in a column `window`, or cut with --from and --to",
        moments(evidence, stamps_s[peaks]),
    )
