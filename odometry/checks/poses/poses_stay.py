"""Poses that stay while the treads drive on: those that windows leave out, as a note."""

from collections.abc import Iterator, Sequence

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.poses.pose_jumps import slip_episode
from odometry.checks.treads.tread_motion import times
from odometry.errors import WindowError
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.record import Record, position_record_of, record_of
from odometry.windows.recorded.spans import runs_of
from odometry.windows.recorded.stuck import NEAR_M, stuck_poses

MOVING = 0.05  # of the ordinary fastest speed: slower, the robot stands before or after
BESIDE_S = 2.0  # of what was said: the moment of an episode lies anywhere in it
SAID = frozenset({"slip_episodes", "turn_blocked"})


def poses_stay(evidence: Evidence, found: Sequence[Finding]) -> Iterator[Finding]:
    """A note of each stretch of which nothing is `found` yet, where nothing is warned of.

    Where treads, stamps or poses are wrong all along, poses seem to stay as well, and of scaled
    positions those that move seem to.
    """
    if any(finding.level is not Level.NOTE for finding in found):
        return
    said_s = [span for finding in found if finding.name in SAID for span in finding.spans_s]
    spans_s = [span for span in _stretches(evidence) if not _is_beside(span, said_s)]
    if spans_s:
        yield slip_episode(
            f"the treads drive on while the poses stay within {NEAR_M:g} m, {times(spans_s)} of "
            "run time",
            tuple(spans_s),
        )


def _stretches(evidence: Evidence) -> Iterator[tuple[float, float]]:
    """Run time [s] in which treads drive while poses stay."""
    record = _record(evidence)
    if record is None:
        return
    speeds_m_s = np.abs(evidence.speeds_m_s).max(axis=1)
    driving_s = evidence.stamps_s[speeds_m_s > MOVING * evidence.fastest_m_s]
    for first, after in runs_of(stuck_poses(record)):
        stay_s = record.pose_s[[first, after - 1]]
        inside_s = driving_s[slice(*np.searchsorted(driving_s, stay_s))]
        if len(inside_s):
            yield evidence.run_time_s(inside_s[0]), evidence.run_time_s(inside_s[-1])


def _record(evidence: Evidence) -> Record | None:
    """Odometry and poses as windows are cut from them; None with too few poses."""
    try:
        if evidence.yaw_measured:
            return record_of(evidence.run, WindowConfig())
        return position_record_of(evidence.run, WindowConfig())
    except WindowError:
        return None


def _is_beside(span_s: tuple[float, float], said_s: Sequence[tuple[float, float]]) -> bool:
    begin_s, end_s = span_s
    return any(b <= end_s + BESIDE_S and e >= begin_s - BESIDE_S for b, e in said_s)
