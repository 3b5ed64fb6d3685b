"""Clocks that differ by what satellite time, or a time zone, differs from UTC."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import changed
from odometry.checks.statistics.measured_between import measured_between

# Seconds, and why: leap seconds since 2017; whole hours where recordings are as long.
LEAPS = {
    18.0: "GPS time is 18 s ahead of UTC (leap seconds)",
    19.0: "atomic time (TAI) is 19 s ahead of GPS time",
    37.0: "atomic time (TAI) is 37 s ahead of UTC (leap seconds)",
}
HOUR_S, MOST_HOURS = 3600.0, 3
AROUND_S, STEP_S, WIDTH_S = 45.0, 0.5, 1.0  # all offsets in between are tried as well
NEAR_S, PEAK_S = 0.75, 3.0  # of the best one to a leap; of what is one peak
CORRELATED, CLEARLY = 0.8, 0.2  # of the best one, and by how much more than elsewhere
LEAST_S = 40.0  # that both have in common
Signal = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class Offset:
    """A known offset of stamps, the correlation with it undone, and that of the stamps as is."""

    seconds: float
    correlation: float
    as_is: float


def clock_offsets(evidence: Evidence) -> Iterator[Finding]:
    """Stamps of positions, or of imu.csv, that fit the treads when moved by a known offset."""
    of, stamps_s = evidence.integrals, evidence.stamps_s

    def over(path: Signal) -> Signal:
        return lambda at_s: path(at_s + WIDTH_S / 2) - path(at_s - WIDTH_S / 2)

    pose, used = evidence.run.pose, evidence.poses_used
    if pose is not None and used is not None and used.sum() > 1:
        pose_s, columns = pose.stamps_s[used], pose.stack("x", "y")[used].T

        def moved_m(at_s: FloatArray) -> FloatArray:
            x, y = columns
            return np.hypot(
                over(lambda s: measured_between(s, pose_s, x))(at_s),
                over(lambda s: measured_between(s, pose_s, y))(at_s),
            )

        def driven_m(at_s: FloatArray) -> FloatArray:
            return np.abs(over(of.left_m)(at_s) + over(of.right_m)(at_s)) / 2

        found = _offset(stamps_s, pose_s, driven_m, moved_m)
        if found is not None:
            yield _finding("pose_late", "pose", "the speed between positions", found)
    rate = evidence.yaw_rate
    if rate is not None and evidence.gyroscope_file == "imu.csv":

        def turned_m(at_s: FloatArray) -> FloatArray:
            return over(of.right_m)(at_s) - over(of.left_m)(at_s)

        found = _offset(stamps_s, rate[0], turned_m, over(of.gyroscope_rad))
        if found is not None:
            yield _finding("gyroscope_late", "imu", "the yaw rate", found)


def _offset(
    stamps_s: FloatArray, other_s: FloatArray, treads: Signal, other: Signal
) -> Offset | None:
    """The known offset by which the other stamps fit; None where another one, or none, does."""
    at_s = np.arange(stamps_s[0] + WIDTH_S, stamps_s[-1] - WIDTH_S, STEP_S)
    reference = treads(at_s)
    as_is = _correlation(reference, other(at_s))
    if as_is > CORRELATED - CLEARLY:
        return None
    tried = np.arange(-AROUND_S, AROUND_S + STEP_S / 2, STEP_S)
    hours = [k * HOUR_S for k in range(-MOST_HOURS, MOST_HOURS + 1) if k]
    near = tried[np.abs(tried) < PEAK_S + STEP_S]
    shared = [h for h in hours if abs(h) + LEAST_S < np.ptp(stamps_s) + np.ptp(other_s)]
    tried = np.concatenate([tried, *(hour + near for hour in shared)])
    found = np.array([_correlation(reference, other(at_s + by_s)) for by_s in tried])
    best = int(np.argmax(found))
    known = [sign * leap for leap in LEAPS for sign in (1, -1)] + shared
    leap = min(known, key=lambda of: abs(of - tried[best]))
    rival = float(np.max(found[np.abs(tried - tried[best]) > PEAK_S], initial=-1.0))
    if abs(leap - tried[best]) > NEAR_S or found[best] < max(CORRELATED, rival + CLEARLY):
        return None
    return Offset(float(leap), float(found[best]), as_is)


def _correlation(one: FloatArray, other: FloatArray) -> float:
    known = np.isfinite(one) & np.isfinite(other)
    if known.sum() * STEP_S < LEAST_S or min(np.ptp(one[known]), np.ptp(other[known])) == 0:
        return -1.0
    return float(np.corrcoef(one[known], other[known])[0, 1])


def _finding(name: str, table: str, signal: str, offset: Offset) -> Finding:
    file, ahead_s = f"{table}.csv", offset.seconds
    size_s = abs(ahead_s)
    ahead, behind = (file, "odometry.csv") if ahead_s > 0 else ("odometry.csv", file)
    hours = size_s / HOUR_S
    why = LEAPS.get(size_s, f"time zones differ by {hours:.0f} hour{'s' * (hours > 1)}")
    return Finding(
        name,
        Level.WARNING,
        f"{signal} fits the treads when stamps of {file} are moved by {-ahead_s:+.0f} s "
        f"(correlation {offset.correlation:.2f}; {offset.as_is:.2f} as they are)",
        f"Two clocks: stamps of {ahead} are {size_s:.0f} s ahead of those of {behind}, as {why}",
        f"Add {-ahead_s:+.0f} s to the stamps of {file}, or mend the clock that is wrong",
        mend=changed(table, "t", lambda stamps_s: stamps_s - ahead_s),
    )
