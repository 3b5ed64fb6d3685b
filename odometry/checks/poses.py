"""What is odd about single stretches and samples of the measured poses."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level
from odometry.checks.spans import constant_spans, runs_of

FROZEN_S = 1.5
REPEATED = 0.3  # share of poses equal to the one before while the treads move
FASTER = 2.0  # times what the treads say, from which a step is a jump
LEAST_JUMP_M = 0.4
AROUND_S = 0.7  # of a jump, within which jitter of stamps is over
OUTLIERS = 0.05  # share of poses that go out and back, from which it is a warning


def poses(evidence: Evidence) -> Iterator[Finding]:
    """Frozen and repeated poses, jumps and outliers."""
    if evidence.positions_measured is None or evidence.run.pose is None:
        return
    rows = np.flatnonzero(evidence.positions_measured)
    stamps_s = evidence.run.pose.stamps_s[rows]
    positions = evidence.run.pose.stack("x", "y")[rows]
    travel_m = _travel(evidence, stamps_s)
    frozen = list(_frozen(evidence, stamps_s, positions, travel_m))
    yield from frozen
    if not frozen:
        yield from _repeated(evidence, positions, travel_m)
    yield from _jumps(evidence, stamps_s, positions, travel_m)


def _travel(evidence: Evidence, stamps_s: FloatArray) -> FloatArray:
    """Tread travel (M,) up to each pose: the faster tread counts."""
    speeds = np.abs(evidence.speeds_m_s).max(axis=1)
    summed = np.concatenate([[0.0], np.cumsum(speeds[:-1] * np.diff(evidence.stamps_s))])
    return np.asarray(np.interp(stamps_s, evidence.stamps_s, summed))


def _frozen(
    evidence: Evidence, stamps_s: FloatArray, positions: FloatArray, travel_m: FloatArray
) -> Iterator[Finding]:
    period_s = float(np.median(np.diff(stamps_s)))
    spans = constant_spans(stamps_s, positions, max(FROZEN_S, 3 * period_s))
    driven_m = np.interp(spans, stamps_s, travel_m)
    moved_m = driven_m[:, 1] - driven_m[:, 0] if len(spans) else np.empty(0)
    odd = moved_m > 0.3 * evidence.fastest_m_s * (spans[:, 1] - spans[:, 0])
    spans, moved_m = spans[odd], moved_m[odd]
    if not len(spans):
        return
    lasts_s = float(np.sum(spans[:, 1] - spans[:, 0]))
    yield Finding(
        "frozen_poses",
        Level.WARNING,
        f"poses repeat the same position for {lasts_s:.1f} s in {len(spans)} stretches (first at "
        f"{evidence.run_time_s(spans[0, 0]):.1f} s) while the treads travel {moved_m.sum():.2f} m",
        "Poses are frozen: the reference was lost and its last value went on; or the robot was "
        "stuck while its treads turned",
        "Leave these poses empty",
        tuple((evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in spans),
    )


def _repeated(
    evidence: Evidence, positions: FloatArray, travel_m: FloatArray
) -> Iterator[Finding]:
    moving = np.diff(travel_m) > 0.2 * np.quantile(np.diff(travel_m), 0.9)
    same = (np.diff(positions, axis=0) == 0).all(axis=1)
    if moving.sum() < 20:
        return
    share = float(same[moving].mean())
    if share > REPEATED:
        longest = int(np.max(np.diff(runs_of(same), axis=1)))
        yield Finding(
            "repeated_poses",
            Level.WARNING,
            f"{100 * share:.0f} % of the poses repeat the one before while the treads move (up to "
            f"{longest} times)",
            "Poses are repeated: the reference is slower than its log, which holds the last value "
            "(frozen between updates)",
            "Keep the rows in which the pose is new",
        )


def _jumps(
    evidence: Evidence, stamps_s: FloatArray, positions: FloatArray, travel_m: FloatArray
) -> Iterator[Finding]:
    steps = np.diff(positions, axis=0)
    far = np.hypot(*steps.T)
    scale = _scale(far, travel_m)
    if scale is None:
        return
    allowed = np.maximum(FASTER * scale * np.diff(travel_m), LEAST_JUMP_M * scale)
    usual = float(np.quantile(np.maximum(far - scale * np.diff(travel_m), 0.0), 0.9))
    step_s = np.diff(stamps_s)
    same_window = _same_window(evidence)
    odd = (far > allowed + 6 * usual) & same_window & (step_s < 5 * np.median(step_s) + 1.0)
    odd[odd] = _stays(stamps_s, positions, travel_m * scale, np.flatnonzero(odd))
    if not odd.any():
        return
    back = _comes_back(steps, odd)
    jumps = np.flatnonzero(odd & ~back)
    outliers = np.flatnonzero(odd & back)
    if len(jumps):
        yield _jump_finding(evidence, stamps_s, far, jumps)
    if len(outliers):
        share = len(outliers) / 2 / len(positions)
        yield Finding(
            "pose_outliers",
            Level.WARNING,
            f"{(len(outliers) + 1) // 2} poses lie up to {far[outliers].max():.3g} m away from their "
            f"neighbours and come back ({100 * share:.2g} % of the poses)",
            "Outliers of the reference (multipath, a wrong match)",
            "Leave these poses empty; the filter's gate refuses them and fits weigh them down",
            tuple((evidence.run_time_s(s), evidence.run_time_s(s)) for s in stamps_s[outliers]),
        )


def _jump_finding(
    evidence: Evidence, stamps_s: FloatArray, far: FloatArray, jumps: FloatArray
) -> Finding:
    places = ", ".join(
        f"{far[i]:.3g} m at {evidence.run_time_s(stamps_s[i + 1]):.1f} s" for i in jumps[:3]
    )
    return Finding(
        "pose_jumps",
        Level.WARNING,
        f"{len(jumps)} steps between poses are farther than the treads can go, and stay: {places}"
        + (" ..." if len(jumps) > 3 else ""),
        "Poses jump: the reference was relocalised, or its map or fix changed",
        "Number the stretches between jumps in a column `window`, or cut with --from and --to",
        tuple((evidence.run_time_s(s),) * 2 for s in stamps_s[jumps + 1]),
    )


def _scale(far: FloatArray, travel_m: FloatArray) -> float | None:
    """Units of position per metre of tread travel; None where the treads hardly move."""
    driven = np.diff(travel_m)
    moving = driven > 0.5 * np.quantile(driven, 0.9)
    if moving.sum() < 10 or driven.sum() <= 0:
        return None
    return max(float(np.median(far[moving] / driven[moving])), 1e-9)


def _same_window(evidence: Evidence) -> BoolArray:
    pose = evidence.run.pose
    rows = evidence.positions_measured
    if pose is None or rows is None or "window" not in pose:
        count = 0 if rows is None else int(rows.sum())
        return np.ones(max(count - 1, 0), dtype=np.bool_)
    return np.asarray(np.diff(np.nan_to_num(pose["window"][rows])) == 0)


def _stays(
    stamps_s: FloatArray, positions: FloatArray, travel_m: FloatArray, steps: IntArray
) -> BoolArray:
    """Whether a step is no jitter of stamps: poses some time around it are too far apart as well.

    Late poses come in bursts, whose steps are large and whose sum is right.
    """
    before = np.searchsorted(stamps_s, stamps_s[steps] - AROUND_S, side="right") - 1
    after = np.searchsorted(stamps_s, stamps_s[steps + 1] + AROUND_S)
    before, after = np.clip(before, 0, None), np.clip(after, None, len(stamps_s) - 1)
    step_m = np.hypot(*(positions[steps + 1] - positions[steps]).T)
    there = np.minimum(
        np.hypot(*(positions[after] - positions[steps]).T) - (travel_m[after] - travel_m[steps]),
        np.hypot(*(positions[steps + 1] - positions[before]).T)
        - (travel_m[steps + 1] - travel_m[before]),
    )
    near = step_m - (travel_m[steps + 1] - travel_m[steps])
    gained = np.hypot(*(positions[after] - positions[before]).T)
    allowed = travel_m[after] - travel_m[before]
    out_and_back = there < 0.3 * near
    return np.asarray((gained - allowed > 0.4 * near) | (out_and_back & (near > 2 * allowed)))


def _comes_back(steps: FloatArray, odd: BoolArray) -> BoolArray:
    """Whether each step (M - 1,) is undone by another odd one among the next five, or undoes one."""
    back = np.zeros(len(odd), dtype=np.bool_)
    rows = np.flatnonzero(odd)
    for i in rows:
        for j in rows[(rows > i) & (rows <= i + 5)]:
            net = float(np.hypot(*steps[i : j + 1].sum(axis=0)))
            if net < 0.4 * float(np.hypot(*steps[i])):
                back[[i, j]] = True
                break
    return back
