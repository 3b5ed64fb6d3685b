"""Bias, range and axis of the gyroscope."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.checks.imu.held_rates import HELD, LIVELY, SAME, dead, held_in_turns, limit_of
from odometry.checks.imu.rate_wander import rate_wander
from odometry.checks.statistics.outliers import spikes
from odometry.checks.turns.gyroscope_bias import bias_by_poses, stationary_bias

LEAST_BIAS_RAD_S = 0.003
LARGE_BIAS_RAD_S = 0.1
LEAST_DRIFT_RAD_S, SURELY = 0.01, 2.0  # times what is said of both rates
CERTAIN = 4.0
CLIPPED = 0.01  # share of rows at the very largest rate
LEAST_HOLDS, LONG_HOLD_S = 20, 0.3  # from which a rate that is held makes headings late
EVEN = 1.5  # ratio of a long to a short hold below which they have one pace
OFTEN = 0.3  # share of these holds in which the treads change


def gyroscope(evidence: Evidence) -> Iterator[Finding]:
    """A bias (a note), clipping, held values, dead stretches, corrupt samples."""
    if evidence.yaw_rate is None:
        return
    yield from _bias(evidence)
    yield from _clipped(evidence)
    yield from _held(evidence)
    yield from dead(evidence)
    yield from _absurd(evidence)


def _bias(evidence: Evidence) -> Iterator[Finding]:
    found = stationary_bias(evidence) or bias_by_poses(evidence)
    if found is None or drifts_at_rest(evidence):  # rest and poses contradict each other
        return
    bias, sigma, how = found
    if abs(bias) < LARGE_BIAS_RAD_S and rate_wander(evidence) is not None:
        return  # there is no one bias
    if abs(bias) < LEAST_BIAS_RAD_S or abs(bias) < CERTAIN * sigma:
        return
    large, at_rest = abs(bias) > LARGE_BIAS_RAD_S, how.startswith("while stationary")
    if large and at_rest:
        yield _turns_at_rest(bias, how)
        return
    yield Finding(
        "gyroscope_bias",
        Level.WARNING if large else Level.NOTE,
        f"gyro_z reads {bias:+.4f} +- {sigma:.4f} rad/s {how}",
        ("The gyroscope has a bias" if at_rest else "The gyroscope has a bias, or yaw drifts")
        + (" far above what is usual (units, or not at rest)" if large else ""),
        "Subtract it where the yaw rate is used; some seconds at rest measure it",
    )


def _turns_at_rest(rate_rad_s: float, how: str) -> Finding:
    return Finding(
        "turns_at_rest",
        Level.WARNING,
        f"gyro_z reads {rate_rad_s:+.3f} rad/s in the median {how} by the treads",
        "Either the treads read zero while the robot moves (odometry is lost, both hold the mean "
        "of a turn on the spot, the robot is carried or pushed); or the gyroscope has a bias far "
        "above what is usual",
        "Leave these stretches out: --from and --to",
    )


def drifts_at_rest(evidence: Evidence) -> str:
    """Measured yaw that turns steadily against a gyroscope that reads another rate at rest."""
    if evidence.yaw_rate is None or (rest := stationary_bias(evidence)) is None:
        return ""
    if (by_poses := bias_by_poses(evidence)) is None:
        return ""
    apart = rest[0] - by_poses[0]
    if abs(apart) < LEAST_DRIFT_RAD_S + SURELY * (rest[1] + by_poses[1]):
        return ""
    return (
        f"measured yaw turns by {apart:+.3f} rad/s besides what gyro_z reads, which is "
        f"{rest[0]:+.3f} rad/s at rest (poses that drift round, a gyroscope that is wrong in "
        "turns, or treads that read zero while the robot turns)"
    )


def _clipped(evidence: Evidence) -> Iterator[Finding]:
    assert evidence.yaw_rate is not None  # noqa: S101 - checked by the caller
    rates = evidence.yaw_rate[1]
    largest = float(np.abs(rates).max())
    at_top = np.abs(np.abs(rates) - largest) < SAME
    lively = len(np.unique(np.round(rates[~at_top], 6))) > LIVELY
    if largest > 0 and at_top.mean() > CLIPPED and at_top.sum() > 10 and lively:
        yield Finding(
            "gyroscope_clipped",
            Level.WARNING,
            f"{100 * at_top.mean():.1f} % of gyro_z are exactly +-{largest:.4g} rad/s",
            "The gyroscope is clipped (saturates): its full-scale range is too small",
            "Choose a larger range; do not use these rows",
        )
    elif limit := limit_of(evidence, odd := held_in_turns(evidence)):
        lasts_s = sum(end_s - begin_s for begin_s, end_s in odd)
        yield Finding(
            "gyroscope_clipped",
            Level.WARNING,
            f"gyro_z is exactly +{limit:.4g} or -{limit:.4g} rad/s for {lasts_s:.1f} s while the "
            "treads turn the robot",
            "The gyroscope is clipped (saturates) in a part: its full-scale range is too small",
            "Choose a larger range; do not use these rows",
            tuple((evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in odd),
        )


def held_s(evidence: Evidence) -> float:
    """How long each yaw rate is repeated that is renewed at an even, slow pace; 0 elsewhere."""
    if evidence.yaw_rate is None:
        return 0.0
    stamps_s, rates = evidence.yaw_rate
    renewed_s = stamps_s[1:][np.diff(rates) != 0]
    if len(renewed_s) < LEAST_HOLDS:
        return 0.0
    short_s, usual_s, long_s = np.quantile(np.diff(renewed_s), [0.1, 0.5, 0.9])
    slow = usual_s > LONG_HOLD_S and usual_s > 2.5 * float(np.median(np.diff(stamps_s)))
    even = long_s < EVEN * short_s
    return float(usual_s) if slow and even and _treads_change(evidence, renewed_s) else 0.0


def _held(evidence: Evidence) -> Iterator[Finding]:
    """A rate that is renewed far more rarely than it is logged."""
    if not (lasts_s := held_s(evidence)):
        return
    yield Finding(
        "gyroscope_held",
        Level.WARNING,
        f"gyro_z is renewed only every {lasts_s:.2g} s and repeated in the rows between, while "
        "the speeds of the treads change",
        "The gyroscope is read more slowly than it is logged: the log holds its last value, which "
        "is late, and turns between two readings are lost",
        "Log the yaw rate at 10 Hz or more, or leave gyro_z empty",
    )


def _treads_change(evidence: Evidence, renewed_s: FloatArray) -> bool:
    """Whether the treads change their turn within many of the times between these stamps."""
    rows = np.unique(
        np.searchsorted(evidence.stamps_s, renewed_s).clip(0, len(evidence.stamps_s) - 1)
    )
    turning = np.diff(evidence.speeds_m_s, axis=1)[:, 0]
    changed = np.maximum.reduceat(turning, rows) - np.minimum.reduceat(turning, rows)
    return bool(np.mean(changed > HELD * evidence.fastest_m_s) > OFTEN)


def _absurd(evidence: Evidence) -> Iterator[Finding]:
    found = evidence.run.yaw_rate
    assert found is not None  # noqa: S101 - checked by the caller
    rates = found.yaw_rate_rad_s
    far = spikes(rates) & (np.abs(rates) > 3 * np.quantile(np.abs(rates), 0.99) + 1.0)
    if far.any():
        yield Finding(
            "absurd_yaw_rate",
            Level.WARNING,
            f"gyro_z of {found.file} jumps out and back in {counted(int(far.sum()), 'sample')}, "
            f"up to {rates[far][np.argmax(np.abs(rates[far]))]:.4g} rad/s",
            "Single corrupt samples of the gyroscope (outliers, spikes)",
            "Remove these rows",
            tuple((evidence.run_time_s(s),) * 2 for s in found.stamps_s[far]),
        )
