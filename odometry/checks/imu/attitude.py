"""Roll and pitch against gravity."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.statistics.relation import Relation, relation

GRAVITY_M_S2 = 9.81
SMOOTH_S = 2.0
LEAST_SPREAD_RAD = np.radians(0.8)  # of roll or pitch, from which gravity says something
STEEP_RAD = np.radians(50)  # no skid-steer robot drives there


def attitude(evidence: Evidence) -> Iterator[Finding]:
    """Roll and pitch in degrees, with the wrong sign, exchanged; accelerations without gravity."""
    odometry = evidence.run.odometry
    angles = {name: odometry[name] for name in ("roll", "pitch") if name in odometry}
    angles = {name: angle for name, angle in angles.items() if np.isfinite(angle).any()}
    if not angles:
        return
    steep = {name: float(np.nanquantile(np.abs(angle), 0.95)) for name, angle in angles.items()}
    worst = max(steep, key=lambda name: steep[name])
    if steep[worst] > STEEP_RAD:
        yield Finding(
            "attitude_in_degrees",
            Level.WARNING,
            f"{worst} is up to {np.nanmax(np.abs(angles[worst])):.3g} rad",
            "Roll and pitch are in degrees, or of a sensor that is mounted turned (upside down)",
            "Convert roll and pitch to radians in the robot frame",
        )
        return
    if set(angles) == {"roll", "pitch"} and {"accel_x", "accel_y"} <= set(odometry.columns):
        yield from _against_gravity(evidence, angles["roll"], angles["pitch"])


def _against_gravity(evidence: Evidence, roll: FloatArray, pitch: FloatArray) -> Iterator[Finding]:
    """accel_x = -g sin(pitch), accel_y = g cos(pitch) sin(roll), less what the motion adds."""
    odometry = evidence.run.odometry
    forward = evidence.speeds_m_s.mean(axis=1)
    turn_rate = _turn_rate(evidence)
    expected = (-GRAVITY_M_S2 * np.sin(pitch), GRAVITY_M_S2 * np.cos(pitch) * np.sin(roll))
    measured = (
        odometry["accel_x"] - np.gradient(forward, evidence.stamps_s),
        odometry["accel_y"] - forward * turn_rate,
    )
    smooth = [_smoothed(evidence, values) for values in (*expected, *measured)]
    if not all(np.isfinite(values).any() for values in smooth):
        return
    slow = np.abs(_smoothed(evidence, forward * turn_rate)) < 0.3
    if (swapped := _swapped(smooth, slow)) is not None:
        yield swapped
        return
    names = ("pitch", "roll")
    for i, name in enumerate(names):
        wanted, seen = smooth[i], smooth[2 + i]
        spread = float(np.nanquantile(wanted, 0.95) - np.nanquantile(wanted, 0.05)) / 2
        if spread < GRAVITY_M_S2 * LEAST_SPREAD_RAD:
            continue
        fit = relation(np.where(slow, seen, np.nan), wanted, np.ones(len(wanted)))
        yield from _slope(name, fit)


def _swapped(smooth: list[FloatArray], slow: BoolArray) -> Finding | None:
    """Whether accel_x follows roll and accel_y pitch, and not the other way round."""
    by_pitch, by_roll, x, y = smooth
    ones = np.ones(len(x))
    explained = []
    for expected, measured in ((by_pitch, x), (by_roll, y), (by_roll, x), (by_pitch, y)):
        middle = np.median(measured[np.isfinite(measured)])
        fit = relation(np.where(slow, measured - middle, np.nan), expected, ones)
        explained.append(0.0 if fit is None else fit.correlation * (abs(fit.slope) > 0.5))
    straight, crossed = min(explained[:2]), min(explained[2:])
    if crossed < 0.8 or max(explained[:2]) > 0.5:
        return None
    return Finding(
        "attitude_swapped",
        Level.WARNING,
        f"accel_x follows roll and accel_y pitch (correlations {explained[2]:.2f} and "
        f"{explained[3]:.2f}, straight {straight:.2f})",
        "Roll and pitch are swapped, or the IMU is turned by 90 degrees about its z axis",
        "Exchange roll and pitch, or state the attitude of the IMU in [sensors]",
    )


def _slope(name: str, fit: Relation | None) -> Iterator[Finding]:
    if fit is None or not fit.certain(0, 8.0):
        return
    axis = "accel_x" if name == "pitch" else "accel_y"
    seen = f"{axis} follows gravity by {name} {fit.slope:+.2f} +- {fit.slope_sigma:.2f} times"
    if fit.slope < -0.5:
        positive = "nose down" if name == "pitch" else "right side down"
        yield Finding(
            "attitude_sign",
            Level.WARNING,
            f"{seen} (expected +1)",
            f"{name} has the wrong sign ({positive} is positive here), or {axis} has",
            f"Negate {name}, or {axis}",
        )
    elif fit.slope > 5:
        yield Finding(
            "attitude_unit",
            Level.WARNING,
            f"{seen} (expected +1)",
            f"{name} is too small: another unit than radians",
            "Convert roll and pitch to radians",
        )


def _turn_rate(evidence: Evidence) -> FloatArray:
    if evidence.yaw_rate is None:
        width = evidence.run.robot.track_width
        return np.asarray(np.diff(evidence.speeds_m_s, axis=1)[:, 0] / (1.8 * width))
    stamps_s, rates = evidence.yaw_rate
    return np.asarray(np.interp(evidence.stamps_s, stamps_s, rates))


def _smoothed(evidence: Evidence, values: FloatArray) -> FloatArray:
    """Means over SMOOTH_S, one for each such time: independent samples."""
    per = max(1, round(SMOOTH_S / max(evidence.period_s, 1e-3)))
    count = len(values) // per
    blocks = values[: count * per].reshape(count, per)
    return np.asarray(blocks.mean(axis=1))
