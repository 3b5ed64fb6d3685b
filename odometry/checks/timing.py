"""Late sensors, and clocks that run apart."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level
from odometry.checks.lag import Lag, Signal, lag_between

LEAST_LAG_S = (
    0.15  # good lidar poses were found up to 0.11 s early after constant delays were removed
)
CERTAIN = 4.0  # standard deviations
MOST_LAG_S = 2.0
CLOCK = 0.03  # relative difference of clocks that is searched for
LEAST_DRIFT_S = 0.2  # over the recording
LEAST_DRIFT = 1e-3  # relative: quartz clocks differ by less
OF_PERIOD = 0.25  # of the pose period, by which interpolated poses may seem late


def timing(evidence: Evidence) -> Iterator[Finding]:
    """Lags of pose, treads and gyroscope against each other, and how they grow."""
    signals = _headings(evidence)
    lags = {
        (late, early): lag
        for late, early in (("pose", "gyroscope"), ("pose", "treads"), ("treads", "gyroscope"))
        if late in signals
        and early in signals
        and (lag := _lag(evidence, signals, late, early)) is not None
    }
    drifting = _drifting(evidence, lags)
    if drifting:
        yield from _clocks(evidence, drifting)
        return
    late = {
        pair: lag
        for pair, lag in lags.items()
        if _is_late(lag, OF_PERIOD * _pose_period_s(evidence) * ("pose" in pair))
    }
    yield from _late(lags, late)


def _headings(evidence: Evidence) -> dict[str, Signal]:
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
        found["pose"] = lambda at_s: _between(at_s, stamps_s, heading)
    return found


def _between(at_s: FloatArray, stamps_s: FloatArray, heading: FloatArray) -> FloatArray:
    return np.asarray(np.interp(at_s, stamps_s, heading, left=np.nan, right=np.nan))


def _pose_period_s(evidence: Evidence) -> float:
    if evidence.run.pose is None or len(evidence.run.pose) < 2:
        return 0.0
    return float(np.median(np.diff(evidence.run.pose.stamps_s)))


def _lag(
    evidence: Evidence, signals: dict[str, Signal], late_name: str, early_name: str
) -> Lag | None:
    start_s, end_s = float(evidence.stamps_s[0]), float(evidence.stamps_s[-1])
    period_s = _pose_period_s(evidence) if "pose" in (late_name, early_name) else 0.0
    width_s = max(0.5, 2 * period_s, 2 * evidence.period_s)
    late, early = signals[late_name], signals[early_name]
    found = lag_between(late, early, (start_s, end_s), width_s, MOST_LAG_S)
    if found is not None and found.pieces >= 5:
        return found
    wide_s = MOST_LAG_S + CLOCK * (end_s - start_s)
    return lag_between(late, early, (start_s, end_s), width_s, min(wide_s, 20.0)) or found


def _drifting(evidence: Evidence, lags: dict[tuple[str, str], Lag]) -> dict[tuple[str, str], Lag]:
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
    return (
        lag.pieces >= 5
        and abs(lag.drift) > CERTAIN * lag.drift_sigma
        and abs(lag.drift) * evidence.duration_s > max(LEAST_DRIFT_S, _pose_period_s(evidence))
        and abs(lag.drift) > LEAST_DRIFT
    )


def _is_late(lag: Lag, allowed_s: float) -> bool:
    return (
        abs(lag.seconds) > max(LEAST_LAG_S, allowed_s) and abs(lag.seconds) > CERTAIN * lag.sigma_s
    )


def _clocks(evidence: Evidence, drifting: dict[tuple[str, str], Lag]) -> Iterator[Finding]:
    counts = {
        name: sum(name in pair for pair in drifting) for name in ("pose", "treads", "gyroscope")
    }
    odd = max(counts, key=lambda name: counts[name])
    (late, early), lag = next((p, v) for p, v in drifting.items() if odd in p)
    yield Finding(
        "clocks_apart",
        Level.WARNING,
        f"the lag of {late} behind {early} grows by {1000 * lag.drift:+.2f} "
        f"+- {1000 * lag.drift_sigma:.2f} ms per second "
        f"({lag.drift * evidence.duration_s:+.2f} s over the recording)",
        f"Clocks run apart: that of the {_file(odd)} has a drift of {100 * lag.drift:+.2f} % "
        "against the other",
        "Stamp all files by one clock (log time, or clocks that are synchronised)",
    )


def _late(lags: dict[tuple[str, str], Lag], late: dict[tuple[str, str], Lag]) -> Iterator[Finding]:
    by_gyroscope, by_treads = late.get(("pose", "gyroscope")), late.get(("pose", "treads"))
    wheels = late.get(("treads", "gyroscope"))
    if by_gyroscope and wheels and not by_treads and ("pose", "treads") in lags:
        yield _finding("gyroscope_late", "gyroscope", "pose and treads", _reversed(by_gyroscope))
    elif by_gyroscope or (by_treads and not wheels):
        lag = by_gyroscope or by_treads
        assert lag is not None  # noqa: S101 - one of them is
        other = "the gyroscope" if by_gyroscope else "the treads"
        yield _finding("pose_late", "pose", other, lag)
        if wheels and abs(wheels.seconds) > LEAST_LAG_S:
            yield _finding("treads_late", "treads", "the gyroscope", wheels)
    elif wheels:
        yield _finding("treads_late", "treads", "the gyroscope", wheels)


def _reversed(lag: Lag) -> Lag:
    return Lag(-lag.seconds, lag.sigma_s, -lag.drift, lag.drift_sigma, lag.correlation, lag.pieces)


def _file(sensor: str) -> str:
    names = {"pose": "poses", "treads": "treads", "gyroscope": "gyroscope"}
    return names[sensor]


def _finding(name: str, sensor: str, other: str, lag: Lag) -> Finding:
    word, opposite = ("late", "early") if lag.seconds > 0 else ("early", "late")
    more = ""
    if {sensor, other} == {"pose", "the treads"}:
        more = f"; or those of the treads are {opposite}: without a gyroscope this cannot be told"
        if lag.seconds > 0:
            more += " (v_left and v_right may be commands, which the robot follows later)"
    elif name == "treads_late" and lag.seconds < 0:
        more = "; or v_left and v_right are commands, which the robot follows later"
    elif name == "treads_late":
        more = "; or the speeds are smoothed (a low-pass filter)"
    if sensor == "pose":
        more += "; or yaw is bent by something else (magnetic), which can look alike"
    return Finding(
        name,
        Level.WARNING,
        f"the yaw rate of {_file(sensor)} is {abs(lag.seconds):.3f} +- {lag.sigma_s:.3f} s {word} "
        f"against {other} (correlation {lag.correlation:.2f})",
        f"Stamps of {_file(sensor)} are {word}: a delay of the sensor, its filter or its "
        f"transport, or stamps at arrival{more}",
        f"Subtract {lag.seconds:+.3f} s from the stamps of the {_file(sensor)}",
    )
