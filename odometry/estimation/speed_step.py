"""Steps in which tread speeds come: few encoder ticks in a short time, or digits of a log."""

from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.recording.run import Run

DIGITS = 1e-5  # of the fastest speed: less are last digits of ticks over uneven stamps
LEAST_CHANGES = 15  # of a tread speed, and as a share of the rows: else it is a held command
CHANGING = 0.005
SEVERAL = 0.1  # share of the rows with more than one tick
# Of the ordinary fastest speed: steps that matter, and those that the mean speeds may have over the
# time for which treads and gyroscope are compared. Real recordings put into steps of 0.02 gain
# nothing from it, of 0.1 they do.
MATTERS, EVEN, ORDINARY, LONGEST_S = 0.03, 0.01, 0.99, 0.5


def with_speed_step(run: Run, config: IcrEkfConfig) -> tuple[IcrEkfConfig, tuple[FilterEvent, ...]]:
    """The settings of a filter with `compare_s` for the steps of the tread speeds of a run.

    Unless it is stated, or `config` is `causal` or does not watch its sensors; with the event of
    that.
    """
    if config.compare_s or config.causal or not config.watch_sensors or run.yaw_rate is None:
        return config, ()
    speeds_m_s, stamps_s = run.odometry.stack("v_left", "v_right"), run.odometry.stamps_s
    step_m_s = speed_step_m_s(speeds_m_s)
    fastest_m_s = float(np.nanquantile(np.abs(speeds_m_s), ORDINARY))
    if not step_m_s > MATTERS * fastest_m_s:
        return config, ()
    period_s = float(np.median(np.diff(stamps_s)))
    compare_s = round(min(period_s * step_m_s / (EVEN * fastest_m_s), LONGEST_S), 3)
    event = FilterEvent(
        "coarse_speeds",
        float(stamps_s[0]),
        float(stamps_s[-1]),
        f"tread speeds come in steps of {step_m_s:.2g} m/s: what they say of the turn is compared "
        f"with the gyroscope over {compare_s:.2g} s at once",
        (step_m_s,),
    )
    return replace(config, compare_s=compare_s), (event,)


def speed_step_m_s(speeds_m_s: FloatArray) -> float:
    """The smaller step of both treads (N, 2) [m/s]; 0 where there is none."""
    return min(filter(None, map(step_of, speeds_m_s.T)), default=0.0)


def step_of(values: FloatArray) -> float | None:
    """The step of which all changes are multiples; None where there is none, or few changes."""
    changes = np.abs(np.diff(values))
    changes = changes[changes > DIGITS * np.abs(values).max(initial=0.0)]
    if len(changes) < max(LEAST_CHANGES, CHANGING * len(values)):
        return None
    return _step_of_sizes(changes)


def tick_of(values: FloatArray, periods_s: FloatArray) -> float | None:
    """The way [m] of which those of all rows (N,) are multiples; None where there is none.

    An encoder's tick, where stamps are uneven and speeds (N,) come in no step. Rows that nearly
    all have one way show none: their one speed is held.
    """
    ways_m = np.abs(values * periods_s)
    moved = ways_m[ways_m > DIGITS * ways_m.max(initial=0.0)]
    tick_m = _step_of_sizes(moved) if len(moved) >= LEAST_CHANGES else None
    return tick_m if tick_m and np.mean(moved > 1.5 * tick_m) > SEVERAL else None


def _step_of_sizes(sizes: FloatArray) -> float | None:
    step = float(np.quantile(sizes, 0.02))
    counts = sizes / step
    single = float(np.mean(np.abs(counts - 1) < 0.05))
    whole = float(np.mean(np.abs(counts - np.round(counts)) < 0.05 + 0.01 * counts))
    return step if whole > 0.95 and single > 0.1 else None
