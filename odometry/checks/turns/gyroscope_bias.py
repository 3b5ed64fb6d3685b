"""Bias of a gyroscope as the recording measures it: at rest, or against measured yaw."""

import numpy as np

from odometry.checks.evidence.evidence import Evidence

STATIONARY_M_S, STATIONARY = 0.005, 0.02  # at most, and of the ordinary fastest speed
LEAST_STATIONARY_S = 2.0


def measured_bias_rad_s(evidence: Evidence) -> float | None:
    """Bias [rad/s] by what it reads at rest, else against measured yaw; None without either."""
    found = stationary_bias(evidence) or bias_by_poses(evidence)
    return None if found is None else found[0]


def stationary_bias(evidence: Evidence) -> tuple[float, float, str] | None:
    """Bias [rad/s], its standard deviation, and from what: while both treads stand still."""
    assert evidence.yaw_rate is not None  # noqa: S101 - checked by the caller
    stamps_s, rates = evidence.yaw_rate
    still_m_s = min(STATIONARY_M_S, STATIONARY * evidence.fastest_m_s)
    still = np.abs(evidence.run.odometry.stack("v_left", "v_right")).max(axis=1) <= still_m_s
    rows = np.clip(np.searchsorted(evidence.stamps_s, stamps_s, side="right") - 1, 0, None)
    settled = still & np.roll(still, 1) & np.roll(still, round(0.5 / max(evidence.period_s, 1e-3)))
    at_rest = rates[settled[rows]]
    lasts_s = len(at_rest) * float(np.median(np.diff(stamps_s)))
    if lasts_s < LEAST_STATIONARY_S or len(at_rest) < 20:
        return None
    middle = float(np.median(at_rest))
    spread = 1.4826 * float(np.median(np.abs(at_rest - middle)))
    if spread > 0.05:
        return None
    return middle, 4 * spread / np.sqrt(len(at_rest)), f"while stationary ({lasts_s:.1f} s)"


def bias_by_poses(evidence: Evidence) -> tuple[float, float, str] | None:
    """The same against measured yaw, where the gyroscope turns by about as much."""
    found = evidence.pose_turn_by_gyroscope
    if found is None or not evidence.yaw_measured:
        return None
    if found.correlation < 0.9 or not 0.8 < found.slope < 1.25:
        return None
    return -float(found.coefficients[1]), 2 * float(found.sigmas[1]), "more than measured yaw turns"
