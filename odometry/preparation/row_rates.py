"""Yaw rates of slow rows of odometry.csv: means over a row, or samples at its stamp."""

import math
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.run import Run

SLOW_S = 0.15  # between rows: half of a faster row is a delay like others
CLEARLY = 0.5  # of what is left of the turn by treads when rates are samples at the stamps
FEWEST = 20  # rows


def with_row_rates(run: Run, config: IcrEkfConfig) -> tuple[Run, tuple[FilterEvent, ...]]:
    """The run with the yaw rates of odometry.csv at the middle of rows whose means they are.

    A tread speed holds until the next stamp. Where the rows are 0.15 s and more apart and a yaw
    rate goes with the speeds of its own row, clearly better than the mean of two neighbours does,
    it is of that time as well, and belongs to the middle of its row: taken at the stamp, the
    gyroscope would lead treads and poses by half a row. Unless `config` is `causal` or does not
    watch its sensors; with the event of that.
    """
    odometry = run.odometry
    if config.causal or not config.watch_sensors or run.imu is not None or "gyro_z" not in odometry:
        return run, ()
    stamps_s = odometry.stamps_s
    if len(stamps_s) < FEWEST:
        return run, ()
    lasts_s = np.append(np.diff(stamps_s), np.nan)
    period_s = float(np.nanmedian(lasts_s))
    treads = odometry["v_right"] - odometry["v_left"]
    if period_s < SLOW_S or not _are_means(treads, odometry["gyro_z"]):
        return run, ()
    middle_s = stamps_s + np.fmin(lasts_s, period_s) / 2
    columns = {"t": middle_s, "gyro_z": odometry["gyro_z"]}
    event = FilterEvent(
        "row_rates",
        float(stamps_s[0]),
        float(stamps_s[-1]),
        f"rows of odometry.csv are {period_s:.2g} s apart, and gyro_z goes with the treads of its "
        "own row: it was taken as the mean over the row",
        (period_s,),
    )
    return replace(run, imu=replace(odometry, columns=columns)), (event,)


def _are_means(treads: FloatArray, rates: FloatArray) -> bool:
    """Whether yaw rates (N,) go with the difference of the treads (N,) of their own rows."""
    between = (rates[1:] + rates[:-1]) / 2
    own, before, after = (
        _left(treads[1:-1], of_rows) for of_rows in (rates[1:-1], between[:-1], between[1:])
    )
    return own < CLEARLY * min(before, after)


def _left(treads: FloatArray, rates: FloatArray) -> float:
    """Standard deviation that a line over the treads leaves of the rates; infinite for none."""
    known = np.isfinite(treads) & np.isfinite(rates)
    treads, rates = treads[known], rates[known]
    if len(treads) < FEWEST or not np.std(treads) * np.std(rates) > 0:
        return np.inf
    correlation = float(np.corrcoef(treads, rates)[0, 1])
    return float(np.std(rates)) * math.sqrt(max(1 - correlation**2, 0.0))
