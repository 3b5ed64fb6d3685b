"""Where the sensors sit on the robot, which yaw rate is preferred, and the angle that it turned."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from odometry.arrays import FloatArray, usual_period_s
from odometry.errors import RunFolderError
from odometry.geometry.se3 import rotation_from_roll_pitch_yaw
from odometry.tables.table import Table

FARTHEST_M = 100.0  # of an antenna from the robot's origin; beyond it the numbers are millimetres
GYRO_AXES = ("gyro_x", "gyro_y", "gyro_z")
Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Sensors:
    """The table `[sensors]` of run.toml.

    Attributes
    ----------
    pose_m : (x, y, z) or None
        Place of the antenna or reference of pose.csv in the robot frame; None where not stated.
    imu_rad : (roll, pitch, yaw) or None
        Attitude of the axes of imu.csv in the robot frame, R = Rz(yaw) Ry(pitch) Rx(roll); None
        where not stated: they are those of the robot.
    """

    pose_m: Triple | None = None
    imu_rad: Triple | None = None


class YawRate(NamedTuple):
    """Measured yaw rates, counter-clockwise.

    Attributes
    ----------
    stamps_s : (N,)
    yaw_rate_rad_s : (N,)
        Finite.
    file : str
        Name of the file that they stand in.
    odometry_s : (R,)
        Stamps of the tread speeds beside them.
    """

    stamps_s: FloatArray
    yaw_rate_rad_s: FloatArray
    file: str
    odometry_s: FloatArray


def sensors_of(settings: Mapping[str, Any], where: str) -> Sensors:
    """The table `[sensors]` of run.toml; keys that the format does not name are ignored.

    Raises
    ------
    RunFolderError
        Naming `where` and the key: no three finite numbers, a place farther than FARTHEST_M or an
        angle of more than a turn.
    """
    table = settings.get("sensors", {})
    if not isinstance(table, Mapping):
        raise RunFolderError(f"{where}: sensors = {table!r}, expected a table [sensors]")
    return Sensors(
        _triple(table, "pose", "x, y, z in metres", FARTHEST_M, where),
        _triple(table, "imu", "roll, pitch, yaw in radians", 2 * math.pi, where),
    )


def preferred_yaw_rate(imu: Table | None, odometry: Table, sensors: Sensors) -> YawRate | None:
    """The yaw rate of imu.csv where it has one, else gyro_z of odometry.csv, else None.

    Rows without a number are dropped. The axes of imu.csv are turned into the robot frame by
    `sensors.imu_rad`, which needs all three; where one is absent and roll or pitch is stated,
    imu.csv gives no yaw rate.
    """
    tables = [(imu, _imu_rates(imu, sensors), "imu.csv")] if imu is not None else []
    if "gyro_z" in odometry:
        tables.append((odometry, odometry["gyro_z"], "odometry.csv"))
    for table, rates, file in tables:
        there = np.isfinite(rates)
        if there.all():
            return YawRate(table.stamps_s, rates, file, odometry.stamps_s)
        if there.any():
            return YawRate(table.stamps_s[there], rates[there], file, odometry.stamps_s)
    return None


def _imu_rates(imu: Table, sensors: Sensors) -> FloatArray:
    """Yaw rate (N,) of imu.csv about the robot's z, NaN where it is not known."""
    roll_pitch_yaw = np.array(sensors.imu_rad or (0.0, 0.0, 0.0))
    if "gyro_z" in imu and not roll_pitch_yaw[:2].any():
        return imu["gyro_z"]
    if all(axis in imu for axis in GYRO_AXES):
        z_of_robot = rotation_from_roll_pitch_yaw(roll_pitch_yaw)[2]  # in the sensor's axes
        return np.asarray(imu.stack(*GYRO_AXES) @ z_of_robot)
    return np.full(len(imu), np.nan)


def _triple(
    table: Mapping[str, Any], key: str, words: str, largest: float, where: str
) -> Triple | None:
    if key not in table:
        return None
    match table[key]:
        case [int() | float() as a, int() | float() as b, int() | float() as c] if all(
            not isinstance(one, bool) and abs(one) <= largest for one in (a, b, c)
        ):
            return float(a), float(b), float(c)
    raise RunFolderError(
        f"{where}: [sensors] {key} = {table[key]!r}, expected three finite numbers {words}, "
        f"none above {largest:.4g} in size"
    )


# Between two samples the turn is not known after both. A slow log is not silent from row to row;
# beside faster treads, which say how the robot turns meanwhile, a slow gyroscope is.
SILENT_S, SILENT_PERIODS = 0.5, 2.5
QUARTERS = np.arange(4) / 4


@dataclass(frozen=True)
class Gyroscope:
    """Integrals over the yaw rate of a run, up to each of G samples.

    Attributes
    ----------
    stamps_s : (G,)
    integrals : (G, 4)
        Turn [rad] by the trapezoidal rule, its gross size [rad], how far the rule can be off
        [rad], and time without samples [s].
    """

    stamps_s: FloatArray
    integrals: FloatArray

    def between(self, begin_s: FloatArray, end_s: FloatArray) -> FloatArray:
        """Integrals (4, K) from stamps (K,) to others; zero where there are no samples."""
        turn, gross, off, silent_s = (
            np.interp(end_s, self.stamps_s, column) - np.interp(begin_s, self.stamps_s, column)
            for column in self.integrals.T
        )
        outside_s = np.maximum(self.stamps_s[0] - begin_s, 0.0)
        outside_s = outside_s + np.maximum(end_s - self.stamps_s[-1], 0.0)
        return np.stack([turn, gross, off, silent_s + outside_s])

    def mean_rates_rad_s(self, stamps_s: FloatArray) -> FloatArray:
        """Mean yaw rate (N,) from the stamp before to each of N stamps.

        NaN at the first, and where samples are missing for more than half of the time.
        """
        turn_rad, _, _, silent_s = self.between(stamps_s[:-1], stamps_s[1:])
        steps_s = np.diff(stamps_s)
        return np.append(np.nan, np.where(silent_s > steps_s / 2, np.nan, turn_rad / steps_s))


def gyroscope_of(yaw_rate: YawRate | None) -> Gyroscope | None:
    """The integrals over measured yaw rates; None without two samples."""
    if yaw_rate is None or len(yaw_rate.stamps_s) < 2:
        return None
    integrals = np.zeros((4, len(yaw_rate.stamps_s)))
    period_s = min(usual_period_s(yaw_rate.stamps_s), usual_period_s(yaw_rate.odometry_s))
    silent_s = max(SILENT_S, SILENT_PERIODS * period_s)
    every = _steps(yaw_rate.stamps_s, yaw_rate.yaw_rate_rad_s, silent_s)
    for of, steps in zip(integrals, every, strict=True):
        np.cumsum(steps, out=of[1:])
    whole = Gyroscope(yaw_rate.stamps_s, integrals.T)
    return whole if silent_s <= SILENT_S else _in_quarters(whole, yaw_rate.yaw_rate_rad_s)


def _in_quarters(gyroscope: Gyroscope, rates_rad_s: FloatArray) -> Gyroscope:
    """The same turns, between samples (G,) as well by rates that change evenly.

    By the mean rate a slow gyroscope would seem to hold one value from sample to sample.
    """
    before, steps_s = gyroscope.stamps_s[:-1, None], np.diff(gyroscope.stamps_s)[:, None]
    stamps_s = np.append((before + steps_s * QUARTERS).ravel(), gyroscope.stamps_s[-1])
    turn, *others = gyroscope.integrals.T
    bow = np.diff(rates_rad_s)[:, None] / 2 * steps_s * (QUARTERS**2 - QUARTERS)
    columns = [np.interp(stamps_s, gyroscope.stamps_s, each) for each in (turn, *others)]
    columns[0] += np.append(bow.ravel(), 0.0)
    return Gyroscope(stamps_s, np.column_stack(columns))


def step_integrals(stamps_s: FloatArray, rates_rad_s: FloatArray) -> FloatArray:
    """Integrals (G - 1, 4), as a `Gyroscope` has them, from each sample to the next.

    Silent after SILENT_S, however slow the samples are: what comes is not known.
    """
    return np.column_stack(list(_steps(stamps_s, rates_rad_s, SILENT_S)))


def _steps(stamps_s: FloatArray, rates_rad_s: FloatArray, silent_s: float) -> Iterator[FloatArray]:
    steps_s = np.diff(stamps_s)
    yield (rates_rad_s[1:] + rates_rad_s[:-1]) / 2 * steps_s
    yield (np.abs(rates_rad_s[1:]) + np.abs(rates_rad_s[:-1])) / 2 * steps_s
    yield np.abs(np.diff(rates_rad_s)) / 2 * steps_s
    yield np.where(steps_s > silent_s, steps_s, 0.0)
