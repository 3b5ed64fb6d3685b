"""Poses that are late by less than `timing` warns of, which `run` undoes.

Poses of real recordings are up to 0.2 s early against the gyroscope and at most 0.03 s late.
"""

from collections.abc import Iterator

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.stamps.latencies import changing
from odometry.checks.stamps.timing import CERTAIN, TOGETHER, found_in, lags_of, pose_period_s
from odometry.checks.statistics.lag import Lag

LEAST_LATE_S, LEAST_LATE_PERIODS = 0.05, 0.25
OF_GYROSCOPE = 0.5  # of a delay, by which treads may be late too; then it is the gyroscope's


def slightly_late(evidence: Evidence) -> Iterator[Finding]:
    """A note on late poses where nothing else is late."""
    lags = lags_of(evidence)
    lag = short_delay(evidence, lags)
    if lag is None or any(found_in(evidence, lags)) or changing(evidence):
        return
    yield Finding(
        "pose_late",
        Level.NOTE,
        f"the yaw rate of poses is {lag.seconds:.3f} +- {lag.sigma_s:.3f} s late against the "
        "gyroscope",
        "Stamps of poses are a little late: a delay of the sensor, its filter or its transport. "
        "run takes them at the stamps of measurement, live and other commands do not",
        f"Subtract {lag.seconds:+.3f} s from the stamps of the poses (live: [filter] pose_delay_s)",
    )


def short_delay(evidence: Evidence, lags: dict[tuple[str, str], Lag]) -> Lag | None:
    """The delay of late poses alone; None where poses may be early, or it is not sure."""
    lag, of_treads = lags.get(("pose", "gyroscope")), lags.get(("treads", "gyroscope"))
    if lag is None or lag.together < TOGETHER:
        return None
    least_s = max(LEAST_LATE_S, LEAST_LATE_PERIODS * pose_period_s(evidence), CERTAIN * lag.sigma_s)
    if lag.seconds < least_s:
        return None
    if of_treads is not None and of_treads.seconds > OF_GYROSCOPE * lag.seconds:
        return None
    return lag
