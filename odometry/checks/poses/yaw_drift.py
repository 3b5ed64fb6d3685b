"""Yaw that parts from the course of the positions at a constant rate."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.heading import far_and_straight, middle_rad
from odometry.checks.evidence.once import once
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import Mend
from odometry.checks.turns.gyroscope_bias import stationary_bias
from odometry.recording.run import Run

MOST_RAD_S, LEAST_RAD_S = 0.15, 0.01
STEP_RAD = 0.25  # over the recording, between two rates that are tried
LEAST_RAD = 0.5  # over the recording
LEAST_WINDOWS, MANY_WINDOWS = 20, 30
EXPLAINS = 0.4  # share of what is missing to full agreement that is left with the drift undone
AGREED = 0.9  # concentration with the drift undone
SAME = 0.25  # share by which two rates of one drift may differ


@dataclass(frozen=True)
class Drift:
    """A rate [rad/s] by which the course turns against yaw, and from how many windows."""

    rate_rad_s: float
    windows: int


def yaw_drifts(evidence: Evidence) -> Iterator[Finding]:
    """Course and yaw part at a rate at which yaw parts from the gyroscope too, or this at rest."""
    drift = course_drift(evidence)
    if drift is None:
        return
    rate, by_gyroscope = -drift.rate_rad_s, evidence.pose_turn_by_gyroscope
    rest = stationary_bias(evidence) if evidence.yaw_rate is not None else None
    if by_gyroscope is not None and _same(float(by_gyroscope.coefficients[1]), rate):
        other = "and against gyro_z"
    elif rest is not None and _same(rest[0], rate):
        other = "and gyro_z reads that rate at rest: yaw integrates its bias"
    else:
        return
    yield Finding(
        "yaw_drifts",
        Level.WARNING,
        f"yaw of pose.csv turns by {rate:+.4f} rad/s against the course of its positions, {other}",
        "Yaw drifts: it is the heading of an inertial sensor that was not corrected",
        "Take yaw from the reference that measured the positions, or leave it empty",
        mend=_with_yaw_turned(drift.rate_rad_s),
    )


def course_drifts(evidence: Evidence) -> str:
    """The same where no other sensor says which of both drifts."""
    drift = course_drift(evidence)
    if drift is None or drift.windows < MANY_WINDOWS:
        return ""
    return f"the course of pose.csv turns by {drift.rate_rad_s:+.4f} rad/s against its yaw"


@once
def course_drift(evidence: Evidence) -> Drift | None:
    """The rate with which course and yaw agree best; None where they do as well without one."""
    m = evidence.motion
    far = far_and_straight(m, evidence.turn_rad(m)) if evidence.yaw_measured else None
    if far is None or far.sum() < LEAST_WINDOWS:
        return None
    at_s = (m.start_s + m.end_s)[far] / 2
    off = (np.exp(1j * (m.course_rad - middle_rad(m.yaw_rad))) * np.sign(m.mean_m))[far]
    lasts_s = float(np.ptp(at_s))
    count = int(MOST_RAD_S * lasts_s / STEP_RAD)
    rates = np.asarray(np.arange(-count, count + 1) * STEP_RAD / max(lasts_s, 1e-9), dtype=float)
    agree = _agreements(off, at_s - at_s[0], rates)
    best = int(np.argmax(agree))
    rate = float(rates[best])
    if agree[best] < AGREED or 1 - agree[best] > EXPLAINS * (1 - agree[count]):
        return None
    if abs(rate) < LEAST_RAD_S or abs(rate) * lasts_s < LEAST_RAD:
        return None
    return Drift(rate, len(at_s))


def _agreements(off: AnyArray, at_s: FloatArray, rates: FloatArray) -> FloatArray:
    """Concentrations (R,) of directions (K,) that are turned back at evenly spaced rates (R,)."""
    turned = off * np.exp(-1j * rates[0] * at_s)
    further = np.exp(-1j * (rates[-1] - rates[0]) / max(len(rates) - 1, 1) * at_s)
    agree = np.empty(len(rates))
    for place in range(len(rates)):
        agree[place] = abs(turned.mean())
        turned = turned * further
    return agree


def _same(one: float, other: float) -> bool:
    return abs(one - other) < SAME * max(abs(one), abs(other))


def _with_yaw_turned(rate_rad_s: float) -> Mend:
    def mend(run: Run) -> Run:
        assert run.pose is not None  # noqa: S101 - the cause is one of poses
        yaw = run.pose["yaw"] + rate_rad_s * (run.pose.stamps_s - run.began_s)
        return replace(run, pose=replace(run.pose, columns={**run.pose.columns, "yaw": yaw}))

    return mend
