"""When positions without yaw, and the yaw rates beside them, were measured.

The path of treads and gyroscope has the shape of the positions where it is sampled as late as they
are. Late treads alone are told apart: the gyroscope then agrees with the positions as they are. A
recorded yaw rate is that at its stamp, or a mean up to the next stamp or from the one before.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.stats import t

from odometry.arrays import FloatArray, usual_period_s
from odometry.errors import OdometryError
from odometry.recording.run import Run, with_stamps
from odometry.tables.table import Table
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.gyroscope_yaw import PathShape, Turned
from odometry.windows.recorded.record import Record
from odometry.windows.stretches.stretches import position_record_with_yaw_rates

LONGEST_S, COARSE_S, FINE_S = 1.0, 0.1, 0.01
TRIED_S = np.arange(-LONGEST_S, LONGEST_S + COARSE_S / 2, COARSE_S)
IN_TIME = len(TRIED_S) // 2
# Pieces of path that are compared [m]: long ones alone are late where a robot slides in turns.
LENGTHS_M = (5.0, 10.0, 20.0, 40.0)
PERIODS = (0.0, 0.5, -0.5)  # by which rates at their stamps, means after and before them are early
# Shares of the misfit as recorded, at most: in the geometric mean over lengths, and over each.
LATE_CLEARLY, LATE_EACH = 0.9, 0.95
BESIDE_TREADS = 0.97  # of the misfit with late treads alone, whatever the rates mean
SURE, OF_MEANING = 0.95, (0, 2)  # places of the lengths by which a meaning surely fits better
EXACT_M = 1e-9  # misfits below are rounding, as of a robot that stands


class Timing(NamedTuple):
    """By how much positions are late beside treads and gyroscope [s], and yaw rates early [s]."""

    positions_late_s: float = 0.0
    rates_early_s: float = 0.0

    def undone(self, run: Run) -> Run:
        """The run with positions and yaw rates at the stamps at which they were measured."""
        rates = run.yaw_rate
        if self.positions_late_s and run.pose is not None:
            run = with_stamps(run, "pose", run.pose.stamps_s - self.positions_late_s)
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
    known = [of for of in compared if of is not None]
    meaning = max(_meaning(known, place) for place in OF_MEANING)[1] if known else 0
    return tuple(Timing() if of is None else of.timing(meaning) for of in compared)


def _meaning(compared: Sequence["_Compared"], place: int) -> tuple[float, int]:
    """How surely the best meaning of yaw rates fits better than rates at their stamps, and which.

    By the lower bound of the gain of log-likelihood over pieces of path of one of LENGTHS_M; 0 and
    0 where it is less.
    """
    gains = np.concatenate([of.gains(place) for of in compared], axis=1)
    best, count = int(np.argmax(gains.sum(axis=1))), gains.shape[1]
    if count < 2 or not best:
        return 0.0, 0
    reach = t.ppf(SURE, count - 1) * np.sqrt(count) * gains[best].std(ddof=1)
    sure = float(gains[best].sum() - reach)
    return (sure, best) if sure > 0 else (0.0, 0)


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
    mean_logs : (3, 2, D)
        Logarithm of the misfit, mean over LENGTHS_M. For each of PERIODS and of TRIED_S:
        positions late, and treads alone.
    """

    def __init__(self, record: Record, rates_rad_s: FloatArray) -> None:
        self._record = record
        self._travel_m = _summed(record, record.inputs.tread_speeds_m_s.mean(axis=1))
        self._turns_rad = _summed(record, rates_rad_s)
        self._early_s = [periods * _period_s(record) for periods in PERIODS]
        self._shape = PathShape(record, LENGTHS_M)
        self._logs = np.array([self._logs_of(early_s) for early_s in self._early_s])
        self.mean_logs = self._logs.mean(axis=-1)

    def gains(self, place: int) -> FloatArray:
        """By how much (3, P) each meaning is more likely in each piece than rates at their stamps.

        Each with the delay that fits it best, of positions or of treads alone.
        """
        logarithms = []
        for early_s, mean_logs in zip(self._early_s, self.mean_logs, strict=True):
            treads_alone, delay = np.unravel_index(np.argmin(mean_logs), mean_logs.shape)
            late_s = float(TRIED_S[delay])
            turned = self._turned(early_s if treads_alone else late_s + early_s)
            misfits_m, counts = self._shape.of_pieces(self._driven(late_s), turned)[place]
            logarithms.append(counts * np.log(np.maximum(misfits_m, EXACT_M)))
        return np.asarray(logarithms[0] - np.array(logarithms), dtype=np.float64)

    def timing(self, meaning: int) -> "Timing":
        """How late positions are, for one meaning of the yaw rates; 0 where that is not clear."""
        of_positions, of_treads = self.mean_logs[meaning, 0], self.mean_logs[:, 1]
        early_s, best = self._early_s[meaning], int(np.argmin(of_positions))
        by_length = self._logs[meaning, 0]
        clear = (
            0 < best < len(TRIED_S) - 1
            and of_positions[best] <= of_positions[IN_TIME] + np.log(LATE_CLEARLY)
            and of_positions[best] <= of_treads.min() + np.log(BESIDE_TREADS)
            and (by_length[best] <= by_length[IN_TIME] + np.log(LATE_EACH)).all()
        )
        if not clear:
            return Timing(0.0, early_s)
        near_s = TRIED_S[best] + np.arange(-COARSE_S, COARSE_S + FINE_S / 2, FINE_S)
        logs = [
            self._log_misfits(self._driven(late_s), self._turned(late_s + early_s)).mean()
            for late_s in near_s
        ]
        return Timing(float(near_s[np.argmin(logs)]), early_s)

    def _logs_of(self, early_s: float) -> FloatArray:
        """Logarithms (2, D, L) of misfits, for one meaning of yaw rates; see `mean_logs`."""
        at_stamps, found = self._turned(early_s), []
        for late_s in TRIED_S:
            speeds = self._driven(late_s)
            each = (self._turned(late_s + early_s), at_stamps)
            found.append([self._log_misfits(speeds, turned) for turned in each])
        return np.swapaxes(found, 0, 1)

    def _log_misfits(self, speeds: FloatArray, turned: Turned) -> FloatArray:
        return np.log(np.maximum(self._shape.misfits_m(speeds, turned), EXACT_M))

    def _driven(self, late_s: float) -> FloatArray:
        """Mean tread speeds (N,), later by a time."""
        return _delayed(self._record, self._travel_m, late_s)

    def _turned(self, late_s: float) -> Turned:
        return self._shape.turned(_delayed(self._record, self._turns_rad, late_s))


def _period_s(record: Record) -> float:
    rates = record.run.yaw_rate
    return 0.0 if rates is None else usual_period_s(rates.stamps_s)


def _summed(record: Record, rates: FloatArray) -> FloatArray:
    """Sums (N,) up to each stamp of rates (N,) in force from each stamp on."""
    return np.append(0.0, np.cumsum(rates[:-1] * np.diff(record.stamps_s)))


def _delayed(record: Record, summed: FloatArray, late_s: float) -> FloatArray:
    """Rates (N,) of sums, later by some time; means up to the next stamp."""
    moved = np.interp(record.stamps_s - late_s, record.stamps_s, summed)
    return np.append(np.diff(moved) / np.diff(record.stamps_s), 0.0)
