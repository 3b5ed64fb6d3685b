"""Late sensors, and clocks that run apart."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.once import once
from odometry.checks.findings.finding import Finding
from odometry.checks.imu.gyroscope import held_s
from odometry.checks.stamps.late_stamps import (
    clocks_apart,
    commands_or_stamps,
    gyroscope_late,
    pose_late,
    treads_apart,
)
from odometry.checks.statistics.lag import Lag, Signal, lag_between
from odometry.checks.statistics.measured_between import measured_between

LEAST_LAG_S = (
    0.15  # good lidar poses were found up to 0.11 s early after constant delays were removed
)
USUAL_PERIOD_S = 0.05  # of such logs; values of slower ones are held, and seem late, for longer
CERTAIN = 4.0  # standard deviations
MOST_LAG_S = 3.5
CLOCK, WIDEST_S = 0.03, 20.0  # relative difference of clocks that is searched for
LEAST_DRIFT_S = 0.2  # over the recording
LEAST_DRIFT = 1e-3  # relative: quartz clocks differ by less
TOGETHER = 0.7  # share of the pieces that have one lag, or one that grows evenly
ON_TIME = 0.5  # of the lag between two sensors, that the one on time has at most against poses
OF_PERIOD = 0.25  # of the pose period, by which interpolated poses may seem late


def timing(evidence: Evidence) -> Iterator[Finding]:
    """Lags of pose, treads and gyroscope against each other, and how they grow."""
    return found_in(evidence, lags_of(evidence))


def found_in(evidence: Evidence, lags: dict[tuple[str, str], Lag]) -> Iterator[Finding]:
    """The findings of `timing` by `lags_of` the evidence."""
    apart = drifting(evidence, lags)
    if apart:
        yield clocks_apart(evidence, apart)
        return
    held = held_s(evidence)
    late = {
        pair: lag
        for pair, lag in lags.items()
        if not _grows(evidence, lag)
        and _is_late(
            lag,
            max(
                OF_PERIOD * pose_period_s(evidence) * ("pose" in pair),
                LEAST_LAG_S + evidence.period_s - USUAL_PERIOD_S,
                held * ("gyroscope" in pair),
            ),
        )
    }
    yield from _late(evidence, lags, late)


@once
def lags_of(evidence: Evidence) -> dict[tuple[str, str], Lag]:
    """Lags of the first of two sensors behind the second, of those that can be estimated."""
    signals = headings_by_sensor(evidence)
    return {
        (late, early): lag
        for late, early in (("pose", "gyroscope"), ("pose", "treads"), ("treads", "gyroscope"))
        if late in signals
        and early in signals
        and (lag := _lag(evidence, signals, late, early)) is not None
    }


def headings_by_sensor(evidence: Evidence) -> dict[str, Signal]:
    """Heading of every sensor as a function of the stamp, turning the same way."""
    of = evidence.integrals
    found: dict[str, Signal] = {}
    if evidence.yaw_rate is not None:
        found["gyroscope"] = of.gyroscope_rad
    found["treads"] = lambda at_s: of.right_m(at_s) - of.left_m(at_s)
    if evidence.yaw_measured and evidence.run.pose is not None and evidence.poses_used is not None:
        yaw = evidence.run.pose["yaw"]
        known = np.isfinite(yaw) & evidence.poses_used
        stamps_s = evidence.run.pose.stamps_s[known]
        heading = np.unwrap(np.radians(yaw[known]) if evidence.yaw_in_degrees else yaw[known])
        found["pose"] = lambda at_s: measured_between(at_s, stamps_s, heading)
    return found


def pose_period_s(evidence: Evidence) -> float:
    """Usual time between poses; 0 where there are fewer than two."""
    if evidence.run.pose is None or len(evidence.run.pose) < 2:
        return 0.0
    return float(np.median(np.diff(evidence.run.pose.stamps_s)))


def _lag(
    evidence: Evidence, signals: dict[str, Signal], late_name: str, early_name: str
) -> Lag | None:
    start_s, end_s = float(evidence.stamps_s[0]), float(evidence.stamps_s[-1])
    period_s = pose_period_s(evidence) if "pose" in (late_name, early_name) else 0.0
    width_s = max(0.5, 2 * period_s, 2 * evidence.period_s)
    late, early = signals[late_name], signals[early_name]
    found = lag_between(late, early, (start_s, end_s), width_s, MOST_LAG_S)
    if found is None or found.pieces < 5:
        wide_s = min(MOST_LAG_S + CLOCK * (end_s - start_s), WIDEST_S)
        found = lag_between(late, early, (start_s, end_s), width_s, wide_s) or found
    if found is None or not _grows(evidence, found):
        return found
    return _with_growth_undone(late, early, found, (start_s, end_s), width_s) or found


def _with_growth_undone(
    late: Signal, early: Signal, first: Lag, span_s: tuple[float, float], width_s: float
) -> Lag | None:
    """The lag found again with its growth undone, which blurs it within each piece.

    None where the pieces then do not have one lag: what grew was chance.
    """
    middle_s, keeps = sum(span_s) / 2, 1 - first.drift

    def on_time(at_s: FloatArray) -> FloatArray:
        return late(middle_s + (at_s - middle_s + first.seconds) / keeps)

    left = lag_between(on_time, early, span_s, width_s, MOST_LAG_S)
    if left is None or left.pieces < first.pieces or left.together < TOGETHER:
        return None
    return replace(
        left,
        seconds=first.seconds + left.seconds - left.drift * first.seconds,
        drift=first.drift + left.drift * keeps,
    )


def drifting(evidence: Evidence, lags: Mapping[tuple[str, str], Lag]) -> dict[tuple[str, str], Lag]:
    """Pairs of different clocks whose lag grows; treads share theirs with what is in their file."""
    pairs = {pair: lag for pair, lag in lags.items() if _drifts(evidence, lag)}
    if evidence.gyroscope_file == "odometry.csv":
        pairs.pop(("treads", "gyroscope"), None)
    by_gyroscope, by_treads = (lags.get(("pose", other)) for other in ("gyroscope", "treads"))
    one_clock = evidence.gyroscope_file == "odometry.csv"
    if by_gyroscope and by_treads and one_clock and _differ(by_treads.drift, by_gyroscope.drift):
        return {}
    return pairs


def _differ(first: float, second: float) -> bool:
    return not 0.5 < first / second < 2.0


def _drifts(evidence: Evidence, lag: Lag) -> bool:
    return lag.pieces >= 5 and lag.together >= TOGETHER and _grows(evidence, lag)


def _grows(evidence: Evidence, lag: Lag) -> bool:
    return (
        abs(lag.drift) > CERTAIN * lag.drift_sigma
        and abs(lag.drift) * evidence.duration_s > max(LEAST_DRIFT_S, pose_period_s(evidence))
        and abs(lag.drift) > LEAST_DRIFT
    )


def _is_late(lag: Lag, allowed_s: float) -> bool:
    return (
        abs(lag.seconds) > max(LEAST_LAG_S, allowed_s)
        and abs(lag.seconds) > CERTAIN * lag.sigma_s
        and lag.together >= TOGETHER
    )


def _late(
    evidence: Evidence, lags: dict[tuple[str, str], Lag], late: dict[tuple[str, str], Lag]
) -> Iterator[Finding]:
    by_gyroscope, by_treads = late.get(("pose", "gyroscope")), late.get(("pose", "treads"))
    wheels = late.get(("treads", "gyroscope"))
    others = ("pose", "treads")
    agree = (wheels and others in lags) or (
        by_gyroscope and _is_on_time(lags, others, by_gyroscope)
    )
    if by_gyroscope and agree and not by_treads:
        yield gyroscope_late(evidence, replace(by_gyroscope, seconds=-by_gyroscope.seconds))
        return
    if by_gyroscope:
        yield pose_late(by_gyroscope, "the gyroscope")
    elif by_treads and not wheels:
        yield from _poses_or_treads(evidence, by_treads)
    if wheels and not by_gyroscope and _is_on_time(lags, ("pose", "treads"), wheels):
        yield gyroscope_late(evidence, replace(wheels, seconds=-wheels.seconds))
    elif wheels:
        decided = _is_on_time(lags, ("pose", "gyroscope"), wheels)
        yield treads_apart(evidence, wheels, "the gyroscope", decided=decided)


def _is_on_time(lags: dict[tuple[str, str], Lag], pair: tuple[str, str], than: Lag) -> bool:
    """Whether poses decide that a sensor is not the one that is late against another."""
    lag = lags.get(pair)
    if lag is None or lag.together < TOGETHER:
        return False
    return abs(lag.seconds) + 2 * lag.sigma_s < ON_TIME * abs(than.seconds)


def _poses_or_treads(evidence: Evidence, lag: Lag) -> Iterator[Finding]:
    """Without a gyroscope that says more: treads that the robot follows later, or late poses."""
    gyroscope = "gyroscope" in headings_by_sensor(evidence)
    if not gyroscope and lag.seconds > 0:
        kind, _ = commands_or_stamps(evidence, lag.seconds)
        if kind == "commands":
            yield treads_apart(
                evidence, replace(lag, seconds=-lag.seconds), "the poses", decided=True
            )
            return
    yield pose_late(lag, "the treads", gyroscope=gyroscope)
