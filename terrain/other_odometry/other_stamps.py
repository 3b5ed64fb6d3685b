"""Whether the stamps of another program's poses are late, by its turns and the odometer's."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.statistics.lag import Signal, lag_between
from odometry.trajectory import Trajectory

MOST_SHIFT_S = 3.5
LEAST_SHIFT_S = 0.15
LEAST_WIDTH_S = 0.5  # over which turn rates are taken
CERTAIN, TOGETHER, CORRELATED = 4.0, 0.7, 0.8
UNLIKE, REPEATED = 0.3, 0.7  # correlation of turns with later ones: changed, and back again
# `lag_between` compares pieces of 8 s and more. Shorter runs are stretched to TIMES their time, so
# that 4 s are enough: of 272 stretches of 19 and 24 s of real recordings one is then called late
# or early that is not.
SHORT_S, TIMES = 31.0, 2.0
MOST_SHORT_S, LEAST_SHORT_S, CORRELATED_SHORT = 1.0, 0.2, 0.9


def late_by_s(other: Trajectory, odometer: Trajectory) -> float | None:
    """By how much a trajectory's stamps are late; None unless that is plain.

    Pieces of the time that both cover must have the same shift, far from zero by their own
    scatter: a drive that hardly turns determines none.
    """
    begin_s = max(each.stamps_s[0] for each in (other, odometer))
    end_s = min(each.stamps_s[-1] for each in (other, odometer))
    period_s = max(float(np.median(np.diff(each.stamps_s))) for each in (other, odometer))
    width_s = max(LEAST_WIDTH_S, 2 * period_s)
    times, most_s, least_s, correlated = 1.0, MOST_SHIFT_S, LEAST_SHIFT_S, CORRELATED
    if end_s - begin_s < SHORT_S:
        times, most_s, least_s, correlated = TIMES, MOST_SHORT_S, LEAST_SHORT_S, CORRELATED_SHORT
    span_s = (begin_s + most_s, end_s - most_s)
    if span_s[1] - span_s[0] < 3 * width_s:
        return None
    headings = _heading(other, times), _heading(odometer, times)
    slower_s = (times * span_s[0], times * span_s[1])
    lag = lag_between(*headings, slower_s, times * width_s, times * most_s)
    if lag is None or lag.correlation < correlated or lag.together < TOGETHER:
        return None
    least_s = max(least_s, period_s, CERTAIN * lag.sigma_s / times)
    return lag.seconds / times if abs(lag.seconds) / times > least_s else None


def _heading(trajectory: Trajectory, times: float) -> Signal:
    """Heading [rad] at so many times its stamps, whole turns counted; NaN outside."""
    yaw = np.unwrap(trajectory.poses[:, 2])

    def at(stamps_s: FloatArray) -> FloatArray:
        return np.interp(stamps_s / times, trajectory.stamps_s, yaw, left=np.nan, right=np.nan)

    return at


def late_note(late_s: float, odometer: Trajectory) -> str:
    """What is said of stamps that are late, or early, by so much, or by a period of our turns."""
    way, sign = ("late", "-") if late_s > 0 else ("early", "+")
    period_s = repeated_after_s(odometer)
    other = (
        f" Our turns repeat about every {period_s:.0f} s: it may be off by so much more, or less."
        if period_s
        else ""
    )
    return (
        f"its stamps seem {way} by {abs(late_s):.2f} s: shifted by {sign}{abs(late_s):.2f} s its "
        f"turns follow the odometer's best, in all parts of the run.{other} Nothing is shifted: "
        "the errors hold the shift as well"
    )


def repeated_after_s(odometer: Trajectory) -> float | None:
    """After how long [s] the turns of a drive repeat, of at most half of it; None if never.

    A shift of stamps by that is none that turns could show.
    """
    at_s = np.arange(odometer.stamps_s[0], odometer.stamps_s[-1], LEAST_WIDTH_S)
    turns = np.diff(np.interp(at_s, odometer.stamps_s, np.unwrap(odometer.poses[:, 2])))
    alike = np.array([_correlation(turns[k:], turns[:-k]) for k in range(1, len(turns) // 2)])
    unlike = np.flatnonzero(alike < UNLIKE)
    if not len(unlike):
        return None
    best = unlike[0] + int(np.argmax(alike[unlike[0] :]))
    return (best + 1) * LEAST_WIDTH_S if alike[best] > REPEATED else None


def _correlation(one: FloatArray, other: FloatArray) -> float:
    spread = float(one.std() * other.std())
    return float(np.mean((one - one.mean()) * (other - other.mean()))) / spread if spread else 1.0
