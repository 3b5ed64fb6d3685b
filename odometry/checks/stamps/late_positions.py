"""Positions without yaw that are late: the shape of their path, or else their speed.

With a gyroscope the whole path is compared, as where a yaw is found for such positions. Without
one the speed between positions is compared with that of the treads: the course would say more, but
an antenna ahead of the centre turns it before the robot turns.
"""

from collections.abc import Callable, Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import WIDTH
from odometry.checks.evidence.once import once
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import changed
from odometry.checks.statistics.lag import Lag, Rate, lag_of_rates
from odometry.checks.statistics.measured_between import measured_between
from odometry.positions.timing import timings_of
from odometry.recording.run import Run
from odometry.windows.recorded.gaps import odometry_gaps

LEAST_WIDTH_S = 0.5
MOST_LAG_S = 3.5
LEAST_LAG_S = 0.4  # robots on sand follow their treads by up to 0.3 s
CERTAIN = 4.0  # standard deviations
SPINNING = (
    0.6  # m for each metre of the treads, below which treads spin, and the robot follows late
)
TOGETHER = 0.7  # share of the pieces that have one lag
# Between positions and yaw; real recordings whose treads hold have at most 0.22 s with four pieces
# or more, one of three pieces 0.4.
LEAST_APART_S, MOST_APART_S, LEAST_PIECES = 0.3, 1.5, 4
Between = Callable[[FloatArray, FloatArray, FloatArray], FloatArray]  # at, stamps, values
MOST_LOST = 0.1  # of the recording: speeds held in gaps of the odometry are of another time


def late_positions(evidence: Evidence) -> Iterator[Finding]:
    """Positions that are later, or earlier, than the treads: by their path, or by their speed."""
    by_path_s = path_delay_s(evidence)
    if by_path_s:
        yield _by_path(by_path_s)
        return
    lag = position_lag(evidence)
    if lag is None or lag.together < TOGETHER:
        return
    if abs(lag.seconds) >= max(LEAST_LAG_S, CERTAIN * lag.sigma_s):
        yield _by_speed(lag)


@once
def path_delay_s(evidence: Evidence) -> float:
    """How late positions without yaw are beside treads and gyroscope; 0 where it is not clear."""
    if evidence.yaw_measured or evidence.yaw_rate is None or evidence.run.pose is None:
        return 0.0
    return timings_of([evidence.run])[0].positions_late_s


def _by_path(late_s: float) -> Finding:
    word, opposite = ("late", "early") if late_s > 0 else ("early", "late")
    return Finding(
        "pose_late",
        Level.WARNING,
        f"positions are {abs(late_s):.2f} s {word}: shifted by this time, the path of treads and "
        "gyroscope fits their shape best",
        f"Stamps of pose.csv are {word} (a delay of the receiver or of its transport), or those of "
        f"odometry.csv and of the gyroscope are {opposite}",
        f"Subtract {late_s:+.2f} s from the stamps of the poses",
        mend=_moved(late_s),
    )


def _by_speed(lag: Lag) -> Finding:
    word, opposite = ("late", "early") if lag.seconds > 0 else ("early", "late")
    follows = (
        "; or the robot itself follows later (speeds that are commands, treads that spin when it "
        "speeds up)"
    )
    return Finding(
        "pose_late",
        Level.WARNING,
        f"the speed between positions is {abs(lag.seconds):.2f} +- {lag.sigma_s:.2f} s {word} "
        f"against that of the treads (correlation {lag.correlation:.2f})",
        f"Stamps of pose.csv are {word} (a delay of the receiver or of its transport), or those of "
        f"odometry.csv are {opposite}{follows * (lag.seconds > 0)}: without yaw these cannot be "
        "distinguished",
        f"If it is the poses, subtract {lag.seconds:+.2f} s from their stamps",
        mend=_moved(lag.seconds),
    )


def _moved(late_s: float) -> Callable[[Run], Run]:
    return changed("pose", "t", lambda stamps_s: stamps_s - late_s)


def position_lag(evidence: Evidence) -> Lag | None:
    """The lag of positions behind the treads; None with yaw, and where it cannot be estimated."""
    return None if evidence.yaw_measured else _speed_lag(evidence, MOST_LAG_S)


def apart_from_yaw(evidence: Evidence, of_yaw: Lag | None) -> str | None:
    """Words where positions are late behind the treads by surely more, or less, than yaw is.

    Empty where both are of one time, None where it is not known.
    """
    lag = lag_beside_yaw(evidence, of_yaw)
    if lag is None or of_yaw is None:
        return None
    sigma_s = float(np.hypot(lag.sigma_s, of_yaw.sigma_s))
    apart_s = lag.seconds - of_yaw.seconds
    if abs(apart_s) < max(LEAST_APART_S, CERTAIN * sigma_s):
        return "" if abs(apart_s) < LEAST_APART_S else None
    return (
        "positions and yaw of pose.csv, or mean and difference of the treads, are not of one time: "
        f"their speed is {lag.seconds:+.2f} s "
        f"late against that of the treads, and their turns are {of_yaw.seconds:+.2f} s"
    )


def lag_beside_yaw(evidence: Evidence, of_yaw: Lag | None) -> Lag | None:
    """The lag of positions behind the treads where yaw has one, too; None where it is not sure."""
    if of_yaw is None or not evidence.yaw_measured or of_yaw.together < TOGETHER:
        return None
    lost_s = float(np.sum(np.diff(odometry_gaps(evidence.run).spans_s)))
    if lost_s > MOST_LOST * float(np.ptp(evidence.stamps_s)):
        return None
    lag = _speed_lag(evidence, max(MOST_APART_S, abs(of_yaw.seconds) + 2 * LEAST_APART_S))
    sure = lag is not None and lag.together >= TOGETHER and lag.pieces >= LEAST_PIECES
    return lag if sure else None


def _speed_lag(evidence: Evidence, most_s: float) -> Lag | None:
    pose, used = evidence.run.pose, evidence.poses_used
    if pose is None or used is None or used.sum() < 2:
        return None
    if (evidence.metres_per_metre or 1.0) < SPINNING:
        return None
    stamps_s = pose.stamps_s[used]
    period_s = max(float(np.median(np.diff(stamps_s))), evidence.period_s)
    return lag_of_rates(
        _speed(stamps_s, pose.stack("x", "y")[used], measured_between),
        _speed(evidence.stamps_s, reckoned_m(evidence), _held_between),
        (float(evidence.stamps_s[0]), float(evidence.stamps_s[-1])),
        max(LEAST_WIDTH_S, 2 * period_s),
        most_s,
    )


def _speed(stamps_s: FloatArray, positions_m: FloatArray, between: Between) -> Rate:
    """Distance between the positions (M, 2) at both ends of a width, over the width."""

    def at(at_s: FloatArray) -> FloatArray:
        return np.stack([between(at_s, stamps_s, column) for column in positions_m.T], axis=-1)

    return lambda at_s, width_s: np.asarray(
        np.hypot(*(at(at_s + width_s / 2) - at(at_s - width_s / 2)).T) / width_s
    )


def _held_between(at_s: FloatArray, stamps_s: FloatArray, values: FloatArray) -> FloatArray:
    """Of speeds, which hold until the next stamp: no step is a gap. NaN outside."""
    return np.asarray(np.interp(at_s, stamps_s, values, left=np.nan, right=np.nan))


def reckoned_m(evidence: Evidence) -> FloatArray:
    """Positions (N, 2) by the treads and the gyroscope, at the stamps of odometry.csv."""
    stamps_s, of = evidence.stamps_s, evidence.integrals
    turns_rad = evidence.turn_rad(evidence.uniform)
    if np.isfinite(turns_rad).all() and len(turns_rad):
        edges_s = np.append(evidence.uniform.start_s[:1], evidence.uniform.end_s)
        heading = np.interp(stamps_s, edges_s, np.append(0.0, np.cumsum(turns_rad)))
    else:
        width_m = WIDTH * evidence.run.robot.track_width
        heading = (of.right_m(stamps_s) - of.left_m(stamps_s)) / width_m
    step_m = evidence.speeds_m_s.mean(axis=1)[:-1] * np.diff(stamps_s)
    steps = np.stack([np.cos(heading[:-1]), np.sin(heading[:-1])], axis=-1) * step_m[:, None]
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
