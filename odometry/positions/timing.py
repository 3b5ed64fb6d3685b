"""When positions without yaw, and the yaw rates beside them, were measured.

The path of treads and gyroscope has the shape of the positions where it is sampled as late as they
are. Late treads alone are told apart: the gyroscope then agrees with the positions as they are. A
recorded yaw rate is that at its stamp, or a mean up to the next stamp or from the one before.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import OdometryError
from odometry.run import Run
from odometry.table import Table
from odometry.windows.config import WindowConfig
from odometry.windows.gyroscope_yaw import path_misfit
from odometry.windows.record import Record
from odometry.windows.stretches import position_record_with_yaw_rates

LONGEST_S, COARSE_S, FINE_S = 1.0, 0.1, 0.01
TRIED_S = np.arange(-LONGEST_S, LONGEST_S + COARSE_S / 2, COARSE_S)
IN_TIME = len(TRIED_S) // 2
LENGTH_M, SHORT_M = 20.0, 5.0  # of the pieces of path that are compared
PERIODS = (0.0, 0.5, -0.5)  # by which rates at their stamps, means after and before them are early
# Shares of the misfit as recorded, at most; 0.92 and 0.97 in 26 recordings at 20 Hz as they are:
LATE_CLEARLY, MEANS_CLEARLY = 0.9, 0.9
EXACT_M = 1e-9  # misfits below are rounding, as of a robot that stands
SHORT_APART_S = 0.15  # a robot that slides in its turns is late over 20 m alone
BESIDE_TREADS = 0.95  # of the misfit with late treads alone, whatever the rates mean


class Timing(NamedTuple):
    """By how much positions are late beside treads and gyroscope [s], and yaw rates early [s]."""

    positions_late_s: float = 0.0
    rates_early_s: float = 0.0

    def undone(self, run: Run) -> Run:
        """The run with positions and yaw rates at the stamps at which they were measured."""
        rates = run.yaw_rate
        if self.positions_late_s and run.pose is not None:
            columns = {**run.pose.columns, "t": run.pose.stamps_s - self.positions_late_s}
            run = replace(run, pose=replace(run.pose, columns=columns))
        if self.rates_early_s and rates is not None:
            stamps_s, lines = rates.stamps_s + self.rates_early_s, np.arange(len(rates.stamps_s))
            columns = {"t": stamps_s, "gyro_z": rates.yaw_rate_rad_s}
            sensors = {**run.settings.get("sensors", {}), "imu": [0.0, 0.0, 0.0]}  # robot axes
            imu = Table(run.folder / rates.file, columns, lines)
            run = replace(run, imu=imu, settings={**run.settings, "sensors": sensors})
        return run


def timings_of(runs: Sequence[Run]) -> tuple[Timing, ...]:
    """Timing of runs of one recorder: what a yaw rate means is the same in all of them.

    Zero where the positions do not clearly say otherwise or are too few, or no gyroscope was
    recorded.
    """
    compared = [_compared(run) for run in runs]
    rises, positions = np.zeros(len(PERIODS)), 1
    for of in compared:
        if of is not None:
            least = np.maximum(of.misfits_m.min(axis=(1, 2)), EXACT_M)
            rises += of.positions * np.log(least / least[0])
            positions += of.positions
    best = int(np.argmin(rises))
    if rises[best] > positions * np.log(MEANS_CLEARLY):
        best = 0
    return tuple(Timing() if of is None else of.timing(best) for of in compared)


def _compared(run: Run) -> "_Compared | None":
    try:
        record = position_record_with_yaw_rates(run, WindowConfig())
    except OdometryError:
        return None
    rates = record.inputs.yaw_rate_rad_s
    return None if rates is None else _Compared(record, rates)


class _Compared:
    """One record against its positions, for each meaning of its yaw rates and each delay.

    Attributes
    ----------
    positions : int
    misfits_m : (3, 2, D)
        For each of PERIODS and of TRIED_S: positions late, and treads alone.
    """

    def __init__(self, record: Record, rates_rad_s: FloatArray) -> None:
        self.positions = len(record.poses)
        self._record = record
        self._rates = rates_rad_s
        self._speeds = record.inputs.tread_speeds_m_s.mean(axis=1)
        self._early_s = [periods * _period_s(record) for periods in PERIODS]
        self.misfits_m = np.array(
            [
                [
                    [self._misfit_m(late_s, late_s + early_s) for late_s in TRIED_S],
                    [self._misfit_m(late_s, early_s) for late_s in TRIED_S],
                ]
                for early_s in self._early_s
            ]
        )

    def timing(self, meaning: int) -> "Timing":
        """How late positions are, for one meaning of the yaw rates; 0 where that is not clear."""
        of_positions, of_treads = self.misfits_m[meaning, 0], self.misfits_m[:, 1]
        early_s, best = self._early_s[meaning], int(np.argmin(of_positions))
        clear = (
            0 < best < len(TRIED_S) - 1
            and of_positions[best] <= LATE_CLEARLY * of_positions[IN_TIME]
            and of_positions[best] <= BESIDE_TREADS * of_treads.min()
        )
        if not clear or not self._late_in_short_pieces(TRIED_S[best], early_s):
            return Timing(0.0, early_s)
        near_s = TRIED_S[best] + np.arange(-COARSE_S, COARSE_S + FINE_S / 2, FINE_S)
        misfits_m = [self._misfit_m(late_s, late_s + early_s) for late_s in near_s]
        return Timing(float(near_s[np.argmin(misfits_m)]), early_s)

    def _late_in_short_pieces(self, found_s: float, early_s: float) -> bool:
        """Whether pieces of SHORT_M say the same: positions are late over any length."""
        short = [self._misfit_m(late_s, late_s + early_s, SHORT_M) for late_s in TRIED_S]
        return bool(abs(TRIED_S[np.argmin(short)] - found_s) <= SHORT_APART_S)

    def _misfit_m(self, late_s: float, turns_late_s: float, length_m: float = LENGTH_M) -> float:
        speeds = _delayed(self._record, self._speeds, late_s)
        rates = _delayed(self._record, self._rates, turns_late_s)
        return path_misfit(self._record, speeds, rates, length_m)


def _period_s(record: Record) -> float:
    rates = record.run.yaw_rate
    return 0.0 if rates is None else float(np.median(np.diff(rates.stamps_s)))


def _delayed(record: Record, rates: FloatArray, late_s: float) -> FloatArray:
    """Rates (N,) in force from each stamp on, later by some time; means up to the next stamp."""
    steps_s = np.diff(record.stamps_s)
    summed = np.append(0.0, np.cumsum(rates[:-1] * steps_s))
    moved = np.interp(record.stamps_s - late_s, record.stamps_s, summed)
    return np.append(np.diff(moved) / steps_s, 0.0)
