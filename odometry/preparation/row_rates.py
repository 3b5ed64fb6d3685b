"""Yaw rates of slow rows of odometry.csv: means over a row, or samples at its stamp."""

import math
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.stamps.timing import TOGETHER, lags_of
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.positions.timing import timings_of
from odometry.recording.run import Run
from odometry.windows.recorded.measured_poses import lacks_yaw

SLOW_S = 0.15  # between rows: half of a faster row is a delay like others
CLEARLY = 0.5  # of what is left of the turn by treads when rates are samples at the stamps
FEWEST = 20  # rows
EARLY_S = 0.05  # usual for poses of real recordings beside the gyroscope
SIGMAS = 3.0  # of the lag, by which it lies nearer to one of both than to the other


def with_row_rates(run: Run, config: IcrEkfConfig) -> tuple[Run, tuple[FilterEvent, ...]]:
    """The run with the yaw rates of odometry.csv at the middle of rows whose means they are.

    A tread speed holds until the next stamp. Where the rows are 0.15 s and more apart and a yaw
    rate is of that time as well, it belongs to the middle of its row: taken at the stamp, the
    gyroscope would lead treads and poses by half a row. Measured poses decide: the yaw by its lag
    behind the rates, positions without yaw by the shape of their path. Where they do not, rates
    are means that go with the speeds of their own rows clearly better than the means of two
    neighbours do. Unless `config` is `causal` or does not watch its sensors; with the event of
    that.
    """
    odometry = run.odometry
    if config.causal or not config.watch_sensors or run.imu is not None or "gyro_z" not in odometry:
        return run, ()
    stamps_s = odometry.stamps_s
    if len(stamps_s) < FEWEST:
        return run, ()
    lasts_s = np.append(np.diff(stamps_s), np.nan)
    period_s = float(np.nanmedian(lasts_s))
    if period_s < SLOW_S:
        return run, ()
    are_means = _by_poses(run, period_s)
    by = "the poses" if are_means else "the treads of its own row"
    if are_means is None:
        are_means = _by_treads(odometry["v_right"] - odometry["v_left"], odometry["gyro_z"])
    if not are_means:
        return run, ()
    middle_s = stamps_s + np.fmin(lasts_s, period_s) / 2
    columns = {"t": middle_s, "gyro_z": odometry["gyro_z"]}
    event = FilterEvent(
        "row_rates",
        float(stamps_s[0]),
        float(stamps_s[-1]),
        f"rows of odometry.csv are {period_s:.2g} s apart, and gyro_z goes with {by} as the mean "
        "over its row: it was taken as that",
        (period_s,),
    )
    return replace(run, imu=replace(odometry, columns=columns)), (event,)


def _by_poses(run: Run, period_s: float) -> bool | None:
    """Whether rates are means over their rows, by the poses; None where these do not say."""
    if lacks_yaw(run):
        return timings_of([run])[0].rates_early_s > 0 or None
    lag = lags_of(Evidence(run)).get(("pose", "gyroscope"))  # of rates that hold over their rows
    if lag is None or lag.together < TOGETHER:
        return None
    nearer_s = lag.seconds + EARLY_S + period_s / 4
    return None if abs(nearer_s) < SIGMAS * lag.sigma_s else nearer_s > 0


def _by_treads(treads: FloatArray, rates: FloatArray) -> bool:
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
