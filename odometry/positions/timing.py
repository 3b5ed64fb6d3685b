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
from odometry.run import Run
from odometry.table import Table
from odometry.windows.config import WindowConfig
from odometry.windows.gyroscope_yaw import path_misfit
from odometry.windows.record import Record
from odometry.windows.stretches import position_record_with_yaw_rates

LONGEST_S, COARSE_S, FINE_S = 1.0, 0.1, 0.01
LENGTH_M = 20.0  # of the pieces of path in which positions are compared to find how late they are
# Shares of the misfit as recorded, at most; 0.92 and 0.97 in 26 recordings at 20 Hz as they are:
LATE_CLEARLY, MEANS_CLEARLY = 0.9, 0.9
BESIDE_TREADS = 0.95  # of the misfit with late treads alone
PERIODS = (0.5, -0.5)  # by which means after and before their stamps are early


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

    Zero where the positions do not clearly say otherwise, or no gyroscope was recorded.

    Raises
    ------
    WindowError
        If a run has too few positions.
    """
    records = [position_record_with_yaw_rates(run, WindowConfig()) for run in runs]
    late_s = [positions_late_s(record) for record in records]
    periods = _periods_early(records, late_s)
    return tuple(
        Timing(late, periods * _period_s(record))
        for late, record in zip(late_s, records, strict=True)
    )


def positions_late_s(record: Record) -> float:
    """How late positions are beside treads and gyroscope, by less than LONGEST_S; early negative.

    0 where the positions do not clearly say so, or no gyroscope was recorded.
    """
    rates = record.inputs.yaw_rate_rad_s
    if rates is None:
        return 0.0
    speeds = record.inputs.tread_speeds_m_s.mean(axis=1)

    def misfit(late_s: float, turns_late_s: float) -> float:
        moved = _delayed(record, speeds, late_s), _delayed(record, rates, turns_late_s)
        return path_misfit(record, *moved, LENGTH_M)

    tried = np.arange(-LONGEST_S, LONGEST_S + COARSE_S / 2, COARSE_S)
    coarse = [misfit(late_s, late_s) for late_s in tried]
    best = int(np.argmin(coarse))
    if best in (0, len(tried) - 1) or coarse[best] > LATE_CLEARLY * misfit(0.0, 0.0):
        return 0.0
    if coarse[best] > BESIDE_TREADS * min(misfit(late_s, 0.0) for late_s in tried):
        return 0.0
    near = tried[best] + np.arange(-COARSE_S, COARSE_S + FINE_S / 2, FINE_S)
    return float(near[np.argmin([misfit(late_s, late_s) for late_s in near])])


def _periods_early(records: Sequence[Record], positions_late_s: Sequence[float]) -> float:
    """By how many periods yaw rates are early: one of PERIODS, or 0."""
    rises, positions = np.zeros(len(PERIODS)), 1
    for record, late_s in zip(records, positions_late_s, strict=True):
        rates = record.inputs.yaw_rate_rad_s
        if rates is None:
            continue
        speeds = _delayed(record, record.inputs.tread_speeds_m_s.mean(axis=1), late_s)
        tried_s = [late_s, *(late_s + periods * _period_s(record) for periods in PERIODS)]
        misfits = [path_misfit(record, speeds, _delayed(record, rates, of_s)) for of_s in tried_s]
        rises += len(record.poses) * np.log(np.divide(misfits[1:], misfits[0]))
        positions += len(record.poses)
    best = int(np.argmin(rises))
    return PERIODS[best] if rises[best] < positions * np.log(MEANS_CLEARLY) else 0.0


def _period_s(record: Record) -> float:
    rates = record.run.yaw_rate
    return 0.0 if rates is None else float(np.median(np.diff(rates.stamps_s)))


def _delayed(record: Record, rates: FloatArray, late_s: float) -> FloatArray:
    """Rates (N,) in force from each stamp on, later by some time; means up to the next stamp."""
    steps_s = np.diff(record.stamps_s)
    summed = np.append(0.0, np.cumsum(rates[:-1] * steps_s))
    moved = np.interp(record.stamps_s - late_s, record.stamps_s, summed)
    return np.append(np.diff(moved) / steps_s, 0.0)
