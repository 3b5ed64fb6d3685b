"""Accelerations along axes that are turned about z: an IMU mounted sideways or backwards."""

import math
from collections.abc import Iterator

import numpy as np

from odometry.arrays import ComplexArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.feel.recorded.signals import ACCEL, in_robot_frame
from odometry.recording.run import Run
from odometry.tables.table import Table

BLOCK_S = 0.5  # longer than vibration and stamps that are off, shorter than slopes and legs
TURNED = math.radians(45.0)
SIGMAS, UNSURE_RAD = 4.0, math.radians(15.0)
SIZES = 0.4, 2.5  # of measured accelerations over those of the treads: else another unit, or slip
PARTS, FEWEST = 20, 100  # of a jackknife; blocks
ALIKE = 0.7  # correlation of turns by gyroscope and treads: else one of them is at fault
# Correlation with what an IMU off the centre feels: 1 in arcs of one radius, which cannot tell; on
# 35 real recordings 0.34 at most.
APART = 0.8
ROUNDS = 5


def turned_axes(evidence: Evidence) -> Iterator[Finding]:
    """accel_x and accel_y against what treads and gyroscope say of the motion.

    On wheels a robot accelerates along x by the change of its speed, and to the left by speed
    times yaw rate, whatever robot it is. Both as one complex number, measured over expected, have
    the angle by which the axes are turned. An IMU that is mounted off the centre feels what turns
    do at its place (angular acceleration, yaw rate squared); that is fitted along with it. What
    slopes add changes slowly: differences from block to block hold little of it.
    """
    found = _accelerations(evidence)
    if found is None:
        return
    changes = np.diff(found, axis=1)
    changes = changes[:, np.isfinite(changes).all(axis=0)]
    if changes.shape[1] < FEWEST or _alike(*changes[:2]) > APART:
        return
    factor = _factor(*changes)
    parts = np.array_split(np.arange(changes.shape[1]), PARTS)
    left_out = [_factor(*np.delete(changes, part, axis=1)) for part in parts]
    angles = np.angle(np.array(left_out) / factor)
    sigma = math.sqrt((PARTS - 1) / PARTS * float(np.sum(angles**2)))
    angle = -float(np.angle(factor))
    is_sure = sigma < UNSURE_RAD and abs(angle) - SIGMAS * sigma > TURNED / 2
    if not is_sure or abs(angle) < TURNED or not SIZES[0] < abs(factor) < SIZES[1]:
        return
    yield _finding(evidence, angle, sigma)


def _finding(evidence: Evidence, angle: float, sigma: float) -> Finding:
    degrees = f"{math.degrees(angle):.0f} +- {math.degrees(sigma):.0f} degrees"
    if evidence.run.imu is None:
        remedy = "Turn accel_x and accel_y to the robot's axes"
    elif evidence.run.sensors.imu_rad is None:
        remedy = f"State [sensors] imu = [0, 0, {angle:.2f}], or the quarter turn next to it"
    else:
        remedy = f"Correct [sensors] imu by a turn of {angle:.2f} rad about z"
    return Finding(
        "imu_axes",
        Level.NOTE,
        f"accelerations of {_table(evidence.run).file.name} agree with treads and gyroscope once "
        f"their axes are turned by {degrees} about z",
        "The IMU is mounted sideways or backwards. Yaw rates are right all the same; models of "
        "inertia by measured accelerations would err, and feel beside runs of another mounting",
        remedy,
    )


def _table(run: Run) -> Table:
    """The one that has the accelerations."""
    return run.odometry if run.imu is None else run.imu


def _accelerations(evidence: Evidence) -> ComplexArray | None:
    """Those of the centre, of a place 1 m ahead of it beside that, and measured ones (3, N).

    In blocks, x + i y; None without them, or where turns differ.
    """
    run = evidence.run
    table = _table(run)
    columns = {name: table[name] for name in ACCEL if name in table}
    if run.imu is not None and run.sensors.imu_rad is not None:
        columns = in_robot_frame(columns, np.array(run.sensors.imu_rad))
    if not {"accel_x", "accel_y"} <= set(columns) or evidence.yaw_rate is None:
        return None
    at_s = evidence.stamps_s
    edges_s = np.arange(at_s[0], at_s[-1], BLOCK_S)
    forward = evidence.speeds_m_s.mean(axis=1)
    difference = _means(at_s, np.diff(evidence.speeds_m_s, axis=1)[:, 0], edges_s)
    rates = _means(*evidence.yaw_rate, edges_s)
    known = np.isfinite(difference) & np.isfinite(rates)
    turns = difference[known], rates[known]
    if known.sum() < FEWEST or min(map(np.ptp, turns)) == 0 or np.corrcoef(*turns)[0, 1] < ALIKE:
        return None
    change = np.diff(np.interp(edges_s, at_s, forward)) / BLOCK_S
    expected = change + 1j * _means(at_s, forward, edges_s) * rates
    speeding_up = np.diff(np.interp(edges_s, *evidence.yaw_rate)) / BLOCK_S
    x, y = (_means(table.stamps_s, columns[name], edges_s) for name in ("accel_x", "accel_y"))
    return np.array([expected, 1j * speeding_up - rates**2, x + 1j * y])


def _alike(one: ComplexArray, other: ComplexArray) -> float:
    """Correlation of two signals (N,), whatever the angle between them."""
    sizes = float(np.linalg.norm(one) * np.linalg.norm(other))
    return abs(complex(np.vdot(one, other))) / sizes if sizes else 0.0


def _means(stamps_s: FloatArray, values: FloatArray, edges_s: FloatArray) -> FloatArray:
    """Means (N - 1,) of values between edges (N,); NaN where there are none."""
    block = np.searchsorted(edges_s, stamps_s, side="right") - 1
    count = len(edges_s) - 1
    used = (block >= 0) & (block < count) & np.isfinite(values)
    sums, numbers = (
        np.bincount(block[used], weights, minlength=count) for weights in (values[used], None)
    )
    return np.where(numbers > 0, sums / np.maximum(numbers, 1), np.nan)


def _factor(expected: ComplexArray, ahead: ComplexArray, measured: ComplexArray) -> complex:
    """Complex factor of expected in measured (N,), bumps weighed down."""
    columns = np.column_stack([expected, expected.conj(), ahead])  # axes that are mirrored, apart
    weights = np.ones(len(expected))
    for _ in range(ROUNDS):
        by = weights[:, None] * columns
        fitted = np.linalg.lstsq(by, weights * measured, rcond=None)[0]
        off = np.abs(measured - columns @ fitted)
        limit = 1.5 * float(np.median(off))
        weights = 1 / np.sqrt(np.maximum(1.0, off / limit)) if limit > 0 else weights
    return complex(fitted[0])
