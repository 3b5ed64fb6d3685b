"""Treads that turn while the robot does not."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.treads.tread_motion import BLOCKED, is_read, moves_differently, times
from odometry.checks.turns.gyroscope_bias import measured_bias_rad_s
from odometry.windows.recorded.blocked_turns import BLOCKED_S, STANDS
from odometry.windows.recorded.spans import runs_of

TURNS = 0.1  # of the ordinary fastest speed, by which the treads differ in a turn
TURNED = 0.3  # share of an ideal drive's turn, by which the gyroscope shows one
MOST_BIAS_RAD_S = 0.03  # of a gyroscope whose bias was not measured
LEAST_WINDOWS = 4  # elsewhere, in which the gyroscope shows turns


def blocked_turns(evidence: Evidence) -> Iterator[Finding]:
    """The treads turn the robot on the spot for seconds, and a gyroscope that works reads no turn.

    In other turns a tread that is scaled wrongly would be one. The gyroscope works where it reads
    turns of the treads elsewhere; where poses turn, it is the one at fault.
    """
    m = evidence.uniform
    if evidence.yaw_rate is None or not len(m):
        return
    share = _share_by_gyroscope(evidence, m)
    if np.sum(share > TURNED) < LEAST_WINDOWS:
        return
    on_the_spot = np.abs(m.difference_m) > np.abs(m.mean_m)
    runs = runs_of(on_the_spot & (np.abs(share) < STANDS))
    spans_s = np.column_stack([m.start_s[runs[:, 0]], m.end_s[runs[:, 1] - 1]])
    odd = [
        span
        for span in spans_s[np.ptp(spans_s, axis=1) >= BLOCKED_S]
        if is_read(evidence, span) and not _poses_turn(evidence, span)
    ]
    if odd:
        slips = not any(moves_differently(evidence, span) for span in odd)
        in_run_time = [(evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in odd]
        yield Finding(
            "turn_blocked",
            Level.NOTE if slips else Level.WARNING,
            f"the treads turn on the spot {times(in_run_time)} of run time, while the gyroscope "
            "reads that the robot does not turn",
            f"Either {BLOCKED[0].lower()}{BLOCKED[1:]}; or the treads read wrong there: odometry "
            "is lost and the log repeats its last values, or a tread has lost its sign, its scale "
            "or its slow speeds (a dead zone)",
            "Cut the recording with --from and --to",
            tuple(in_run_time),
        )


def _share_by_gyroscope(evidence: Evidence, m: Motion) -> FloatArray:
    """The share (K,) that the gyroscope says; NaN where a bias nobody measured hides slow turns."""
    bias_rad_s = measured_bias_rad_s(evidence)
    share = _turned_share(evidence, m, m.gyroscope_rad - (bias_rad_s or 0.0) * m.lasts_s)
    if bias_rad_s is not None:
        return share
    ideal_rad_s = np.abs(m.difference_m) / evidence.run.robot.track_width / m.lasts_s
    return np.where(TURNED * ideal_rad_s > MOST_BIAS_RAD_S, share, np.nan)


def _turned_share(evidence: Evidence, motion: Motion, turn_rad: FloatArray) -> FloatArray:
    """Measured turn (K,) as a share of that of an ideal drive; NaN where the treads do not turn."""
    asked = np.abs(motion.difference_m) > TURNS * evidence.fastest_m_s * motion.lasts_s
    ideal_rad = np.where(asked, motion.difference_m / evidence.run.robot.track_width, np.nan)
    return np.asarray(turn_rad / ideal_rad)


def _poses_turn(evidence: Evidence, span: FloatArray) -> bool:
    m = evidence.turn_motion
    inside = (m.start_s >= span[0]) & (m.end_s <= span[1])
    share = _turned_share(evidence, m, evidence.pose_turn_rad)[inside]
    share = share[np.isfinite(share)]
    return len(share) > 0 and bool(np.median(share) > STANDS)
