"""A robot that is carried on while it drives: a ferry, a train, or a reference that drifts."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.statistics.relation import relation

DRIFT = 0.15  # of the fastest tread speed: slower drifts are left to slip
HOLDS = 0.9  # correlation, and least ratio, of turns
SURE = 10.0  # standard deviations
STEEP_RAD, DOWN = np.radians(5.0), np.cos(np.radians(30.0))  # of the terrain, of the drift
EXPLAINS = 0.5  # share of the squares that are left with a constant velocity beside the treads


def carried_along(evidence: Evidence) -> str:
    """Words where positions move on in one direction whatever the treads do; "" elsewhere.

    Displacements in the frame of the poses are those of the treads along the measured yaw, and a
    constant velocity. A robot that slides down a slope does so, and is no fault.
    """
    m = evidence.motion
    if not _yaw_holds(evidence):
        return ""
    yaw = np.angle(np.exp(1j * m.yaw_rad).sum(axis=1))
    axes = np.stack([np.cos(yaw), np.sin(yaw)])
    course = np.stack([np.cos(m.course_rad), np.sin(m.course_rad)])
    moved, driven = (m.distance_m * course).ravel(), (m.mean_m * axes).ravel()
    nothing = np.zeros_like(m.lasts_s)
    steady = (np.concatenate(c) for c in ((m.lasts_s, nothing), (nothing, m.lasts_s)))
    alone, both = relation(moved, driven), relation(moved, driven, *steady)
    if alone is None or both is None or not (both.certain(1, SURE) or both.certain(2, SURE)):
        return ""
    drift_m_s = float(np.hypot(*both.coefficients[1:]))
    if drift_m_s < DRIFT * evidence.fastest_m_s:
        return ""
    if 1 - both.explained > EXPLAINS * (1 - alone.explained):
        return ""
    if _is_downhill(evidence, yaw, both.coefficients[1:] / drift_m_s):
        return ""
    return (
        f"positions move on by {drift_m_s:.2g} m/s in one direction whatever the treads do (a "
        "robot that is carried or slides down a slope, or a reference that drifts)"
    )


def _is_downhill(evidence: Evidence, yaw: FloatArray, drift: FloatArray) -> bool:
    """Whether roll and pitch say that a direction (2,) of the map goes down a steep slope.

    The normal of the terrain leans downhill: its horizontal part is the sine of the slope.
    """
    odometry, m = evidence.run.odometry, evidence.motion
    if "roll" not in odometry or "pitch" not in odometry:
        return False
    middle_s = (m.start_s + m.end_s) / 2
    roll, pitch = (np.interp(middle_s, evidence.stamps_s, odometry[n]) for n in ("roll", "pitch"))
    ahead, aside = np.sin(pitch) * np.cos(roll), -np.sin(roll)
    leans = (ahead + 1j * aside) * np.exp(1j * yaw)
    down = complex(np.nanmean(leans)) if np.isfinite(leans).any() else 0j
    along = float(down.real * drift[0] + down.imag * drift[1])
    return bool(abs(down) > np.sin(STEEP_RAD) and along > DOWN * abs(down))


def _yaw_holds(evidence: Evidence) -> bool:
    """Whether measured yaw turns as the gyroscope does, or else as the treads."""
    fit, treads = evidence.pose_turn_by_gyroscope, evidence.pose_turn_by_difference
    if not evidence.yaw_measured or (fit is None and treads is None):
        return False
    if fit is not None:
        return fit.correlation > HOLDS and abs(fit.slope - 1) < 1 - HOLDS
    return treads is not None and treads.correlation > HOLDS and treads.slope > 0
