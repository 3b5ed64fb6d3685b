"""What is odd about single stretches and samples of the measured poses."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.checks.poses.coarse_part import coarse_part
from odometry.checks.poses.far_sensor import far_sensor
from odometry.checks.poses.held_poses import PoseTrack, frozen_poses, pose_bursts, repeated_poses
from odometry.checks.poses.pose_jumps import jumps
from odometry.checks.poses.sudden_steps import pose_steps
from odometry.checks.poses.yaw_jumps import yaw_jumps

OUTLIERS = 0.01  # share of poses that go out and back, from which it is a warning
CLOSER = 0.75  # of the usual time to the neighbours, that outliers have where rows are mixed
MIXED = "; or poses of two times are mixed there (stamps that went back and were sorted)"
LEAST_S, LEAST_PERIODS = 5.0, 10.0  # an outage is longer than both
LEAST_M = 1.0  # that the treads travel meanwhile


def poses(evidence: Evidence) -> Iterator[Finding]:
    """Frozen and repeated poses, jumps and outliers."""
    if evidence.positions_measured is None or evidence.run.pose is None:
        return
    yield from _outliers(evidence)
    all_stamps_s = evidence.run.pose.stamps_s
    rows = np.flatnonzero(evidence.positions_measured & ~evidence.pose_outliers)
    known = (all_stamps_s >= evidence.stamps_s[0]) & (all_stamps_s <= evidence.stamps_s[-1])
    of_yaw = rows[known[rows]]
    if coarse := coarse_part(evidence):  # its positions seem to be held, and to jump
        rows = rows[~coarse.span.holds(all_stamps_s[rows])]
    stamps_s = all_stamps_s[rows]
    positions = evidence.run.pose.stack("x", "y")[rows]
    travel_m = evidence.travel_m(stamps_s)
    track = PoseTrack(stamps_s, positions, travel_m)
    repeated = list(repeated_poses(track))
    frozen = list(frozen_poses(evidence, track))
    yield from repeated or frozen
    yield from pose_bursts(evidence, track)
    spans_s = [*evidence.left_out_s, *(span for finding in frozen for span in finding.spans_s)]
    inside = known[rows]  # of the time of the treads
    sudden = [
        *yaw_jumps(evidence, of_yaw),
        *jumps(evidence, rows[inside], travel_m[inside], np.array(spans_s).reshape(-1, 2)),
    ]
    yield from sudden
    yield from far_sensor(evidence)
    if not (sudden or repeated or frozen):
        yield from pose_steps(evidence, rows[inside])


def _outliers(evidence: Evidence) -> Iterator[Finding]:
    pose, found = evidence.run.pose, np.flatnonzero(evidence.pose_outliers)
    if pose is None or evidence.positions_measured is None:
        return
    if coarse := coarse_part(evidence):
        found = found[~coarse.span.holds(pose.stamps_s[found])]
    if not len(found):
        return
    measured = np.flatnonzero(evidence.positions_measured)
    others = np.flatnonzero(evidence.positions_measured & ~evidence.pose_outliers)
    beside = others[np.clip(np.searchsorted(others, found) - 3, 0, None)]
    away = np.hypot(*(pose.stack("x", "y")[found] - pose.stack("x", "y")[beside]).T)
    share = len(found) / len(measured)
    usual_s = float(np.median(np.diff(pose.stamps_s)))
    inner = np.clip(found, 1, len(pose) - 2)
    beside_s = (pose.stamps_s[inner + 1] - pose.stamps_s[inner - 1]) / 2
    mixed = float(np.median(beside_s)) < CLOSER * usual_s
    yield Finding(
        "pose_outliers",
        Level.WARNING if share > OUTLIERS or len(found) > 5 else Level.NOTE,
        f"{counted(len(found), 'pose')} ({100 * share:.3g} %) up to {away.max():.3g} m away from "
        "the neighbours, and back again",
        f"{'Either outliers' if mixed else 'Outliers'} of the reference (multipath, a wrong match)"
        + MIXED * mixed,
        "Leave these poses empty; the filter's gate refuses them and fits weigh them down",
        tuple((evidence.run_time_s(s),) * 2 for s in pose.stamps_s[found]),
    )


def pose_outages(evidence: Evidence) -> Iterator[Finding]:
    """A reference that was lost, and said nothing meanwhile."""
    if evidence.run.pose is None or evidence.positions_measured is None:
        return
    stamps_s = evidence.run.pose.stamps_s[evidence.positions_measured]
    inside = (stamps_s >= evidence.stamps_s[0]) & (stamps_s <= evidence.stamps_s[-1])
    stamps_s = stamps_s[inside]
    if len(stamps_s) < 2:
        return
    lasts_s = np.diff(stamps_s)
    driven_m = np.diff(evidence.travel_m(stamps_s))
    long = lasts_s > max(LEAST_S, LEAST_PERIODS * float(np.median(lasts_s)))
    rows = np.flatnonzero(long & (driven_m > LEAST_M))
    if not len(rows):
        return
    spans = [(evidence.run_time_s(stamps_s[i]), evidence.run_time_s(stamps_s[i + 1])) for i in rows]
    yield Finding(
        "pose_outage",
        Level.NOTE,
        f"pose.csv has no positions for {lasts_s[rows].sum():.1f} s in "
        f"{counted(len(rows), 'place')} (first from {spans[0][0]:.1f} s on, for "
        f"{lasts_s[rows[0]]:.1f} s) while the treads travel {driven_m[rows].sum():.3g} m",
        "The reference was lost for a while (an outage), or its rows were",
        "Nothing to do: windows do not cross it, and the filter goes on by the odometer",
        tuple(spans),
    )
