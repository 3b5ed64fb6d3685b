"""Two recordings in one file: poses begin anew, at another place, while the robot stands."""

from collections.abc import Iterator, Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.geometry.angles import wrap

FARTHER, LEAST_M = 3.0, 1.0  # than the treads travel meanwhile, and at least
NOISE = 8.0  # standard deviations of the positions
STAYS, BESIDE = 0.7, 3  # share of the step that lasts, by medians of so many poses on each side
LEAST_TURN_RAD = 0.15  # of yaw over the step, where it is measured
REST_S, AT_REST = 0.3, 0.05  # of the ordinary fastest speed, so long before and after
MOST = 3  # files that are joined are few: more steps are those of a poor reference
SEAM_S = 3.0  # around such a moment, in which other findings follow from it
AT_SEAMS = frozenset(
    {"pose_jumps", "yaw_jumps", "treads_frozen", "pose_outliers", "odometry_gap", "pose_outage"}
)


def joined_recordings(evidence: Evidence) -> Iterator[Finding]:
    """Moments at which position and yaw are suddenly others, of a robot that stands.

    A robot that is carried, and a reference that begins anew, have the same effect.
    """
    spans = list(_steps_at_rest(evidence))
    if not 0 < len(spans) <= MOST:
        return
    yaw = " and yaw" if evidence.yaw_measured else ""
    yield Finding(
        "recordings_joined",
        Level.WARNING,
        f"positions{yaw} begin anew {counted(len(spans), 'time')}, first at {spans[0][0]:.1f} s, "
        "while both treads stand",
        "Two recordings are joined in one file, each with poses of its own origin; or the robot "
        "was carried, driven while nothing was logged, or its reference restarted (a reset, a "
        "relocalisation), while it stood: these cannot be distinguished",
        "Cut the recording there with --from and --to",
        tuple(spans),
    )


def without_seams(findings: Sequence[Finding]) -> list[Finding]:
    """The findings without those of such moments alone."""
    joined = (finding for finding in findings if finding.name == "recordings_joined")
    seams = [span for finding in joined for span in finding.spans_s]
    return [f for f in findings if f.name not in AT_SEAMS or not _all_at(f.spans_s, seams)]


def _all_at(spans_s: Sequence[tuple[float, float]], seams_s: Sequence[tuple[float, float]]) -> bool:
    """Whether every span lies at one of the seams; False where there is none."""
    return bool(spans_s) and all(
        any(begin - SEAM_S <= span[0] and span[1] <= end + SEAM_S for begin, end in seams_s)
        for span in spans_s
    )


def _steps_at_rest(evidence: Evidence) -> Iterator[tuple[float, float]]:
    """Run time [s] of the poses before and after each step."""
    if evidence.run.pose is None or evidence.positions_measured is None:
        return
    kept = evidence.positions_measured & ~evidence.pose_outliers
    pose = evidence.run.pose.rows(np.flatnonzero(kept))
    positions, stamps_s = pose.stack("x", "y"), pose.stamps_s
    far_m = np.hypot(*np.diff(positions, axis=0).T)
    scale = max(evidence.metres_per_metre or 1.0, 1.0)
    reach_m = LEAST_M + FARTHER * scale * _travel_since_new_m(evidence, stamps_s, positions)
    odd = np.flatnonzero(far_m > reach_m + NOISE * evidence.position_sigma_m)
    for row in odd[(odd >= BESIDE - 1) & (odd < len(far_m) - BESIDE + 1)]:
        before, after = (
            np.median(positions[first : first + BESIDE], axis=0)
            for first in (row - BESIDE + 1, row + 1)
        )
        turn = wrap(pose["yaw"][row + 1] - pose["yaw"][row])
        if np.hypot(*(after - before)) < STAYS * far_m[row] or abs(turn) < LEAST_TURN_RAD:
            continue
        if _stands(evidence, stamps_s[row : row + 2]):
            begin_s, end_s = map(evidence.run_time_s, stamps_s[row : row + 2].tolist())
            yield begin_s, end_s


def _travel_since_new_m(
    evidence: Evidence, stamps_s: FloatArray, positions: FloatArray
) -> FloatArray:
    """Tread travel (M - 1,) up to each position but the first, since that before it was new.

    A reference that held its position goes on where the robot is by then.
    """
    is_new = np.append(True, (np.diff(positions, axis=0) != 0).any(axis=1))
    new_since = np.maximum.accumulate(np.where(is_new, np.arange(len(positions)), 0))
    travel_m = evidence.travel_m(stamps_s)
    return np.asarray(travel_m[1:] - travel_m[new_since[:-1]])


def _stands(evidence: Evidence, span_s: FloatArray) -> bool:
    """Whether both treads stand just before, within and just after a span of stamps."""
    begin_s, end_s = span_s
    t, speeds = evidence.stamps_s, np.abs(evidence.speeds_m_s).max(axis=1)
    near = (t > begin_s - REST_S) & (t < end_s + REST_S)
    sides = (near & (t <= begin_s + evidence.period_s), near & (t >= end_s - evidence.period_s))
    still = speeds < AT_REST * evidence.fastest_m_s
    return bool(all(side.any() for side in sides) and still[near].all())
