"""Poses that repeat the one before: a reference that was lost, or one slower than its log."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level, counted
from odometry.windows.spans import constant_spans, runs_of

FROZEN_S = 1.5
FROZEN_M = 5.0  # that the robot drives meanwhile by its treads, however slowly
OFTEN = 10  # stretches of repeated poses, from which the log repeats by habit
REPEATED = 0.3  # share of poses equal to the one before while the treads move


def frozen_poses(
    evidence: Evidence, stamps_s: FloatArray, positions: FloatArray, travel_m: FloatArray
) -> Iterator[Finding]:
    """Times in which poses stay and the treads go on.

    Parameters
    ----------
    evidence : Evidence
    stamps_s : (M,)
    positions : (M, 2)
    travel_m : (M,)
        Of the treads, up to each pose.
    """
    period_s = float(np.median(np.diff(stamps_s)))
    spans = constant_spans(stamps_s, positions, max(FROZEN_S, 3 * period_s))
    driven_m = np.interp(spans, stamps_s, travel_m)
    moved_m = driven_m[:, 1] - driven_m[:, 0] if len(spans) else np.empty(0)
    odd = moved_m > 0.15 * evidence.fastest_m_s * (spans[:, 1] - spans[:, 0])
    odd |= _along_m(evidence, spans) > FROZEN_M
    spans, moved_m = spans[odd], moved_m[odd]
    if not len(spans):
        return
    lasts_s = float(np.sum(spans[:, 1] - spans[:, 0]))
    yield Finding(
        "frozen_poses",
        Level.WARNING,
        f"poses repeat the same position for {lasts_s:.1f} s in {counted(len(spans), 'place')} "
        f"(first at {evidence.run_time_s(spans[0, 0]):.1f} s) while the treads travel "
        f"{moved_m.sum():.2f} m",
        "Poses are frozen: the reference was lost and its last value went on; or the robot was "
        "stuck while its treads turned",
        "Leave these poses empty",
        tuple((evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in spans),
    )


def _along_m(evidence: Evidence, spans_s: FloatArray) -> FloatArray:
    """Way (K,) of the middle between the treads in each of the times (K, 2), without sign."""
    speed_m_s = np.abs(evidence.speeds_m_s.mean(axis=1))
    way_m = np.append(0.0, np.cumsum(speed_m_s[:-1] * np.diff(evidence.stamps_s)))
    return np.asarray(np.diff(np.interp(spans_s, evidence.stamps_s, way_m), axis=1)[:, 0])


def repeated_poses(positions: FloatArray, travel_m: FloatArray) -> Iterator[Finding]:
    """Many poses that repeat the one before, again and again: no single loss of the reference."""
    moving = np.diff(travel_m) > 0.2 * np.quantile(np.diff(travel_m), 0.9)
    same = (np.diff(positions, axis=0) == 0).all(axis=1)
    if moving.sum() < 20:
        return
    share = float(same[moving].mean())
    stretches = [(first, last) for first, last in runs_of(same) if moving[first:last].any()]
    if share > REPEATED and len(stretches) > OFTEN:
        longest = int(np.max(np.diff(stretches, axis=1)))
        yield Finding(
            "repeated_poses",
            Level.WARNING,
            f"{100 * share:.0f} % of the poses repeat the one before while the treads move (up to "
            f"{counted(longest, 'time')})",
            "Poses are repeated: the reference is slower than its log, which holds the last value "
            "(frozen between updates)",
            "Keep the rows in which the pose is new",
        )
