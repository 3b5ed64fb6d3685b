"""Steps in which tread speeds come: few encoder ticks in a short time, or digits of a log."""

from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.run import Run

DIGITS = 1e-5  # of the fastest speed: less are last digits of ticks over uneven stamps
LEAST_CHANGES = 15  # of a tread speed, and as a share of the rows: else it is a held command
CHANGING = 0.005
# Of the ordinary fastest speed, from which a step matters: without a correction steps of 0.025 m/s
# at 50 Hz widened y_left - y_right by 4 to 18 % of a robot that turns now and then at 1 m/s, and
# the error goes with the square of the step.
MATTERS, ORDINARY = 0.005, 0.99


def with_speed_step(run: Run, config: IcrEkfConfig) -> tuple[IcrEkfConfig, tuple[FilterEvent, ...]]:
    """The settings of a filter with the step of the tread speeds of a run, and what was noticed.

    Unless it is stated, or `config` is `causal` or does not watch its sensors.
    """
    if config.speed_step_m_s or config.causal or not config.watch_sensors:
        return config, ()
    speeds_m_s = run.odometry.stack("v_left", "v_right")
    step_m_s = speed_step_m_s(speeds_m_s)
    fastest_m_s = float(np.nanquantile(np.abs(speeds_m_s), ORDINARY))
    if not step_m_s or step_m_s < MATTERS * fastest_m_s:
        return config, ()
    stamps_s = run.odometry.stamps_s
    event = FilterEvent(
        "coarse_speeds",
        float(stamps_s[0]),
        float(stamps_s[-1]),
        f"tread speeds come in steps of {step_m_s:.2g} m/s: what they say of the ICRs beside the "
        "gyroscope is taken at their means over half a second",
        (step_m_s,),
    )
    return replace(config, speed_step_m_s=step_m_s), (event,)


def speed_step_m_s(speeds_m_s: FloatArray) -> float:
    """The smaller step of both treads (N, 2) [m/s]; 0 where there is none."""
    return min(filter(None, map(step_of, speeds_m_s.T)), default=0.0)


def step_of(values: FloatArray) -> float | None:
    """The step of which all changes are multiples; None where there is none, or few changes."""
    changes = np.abs(np.diff(values))
    changes = changes[changes > DIGITS * np.abs(values).max(initial=0.0)]
    if len(changes) < max(LEAST_CHANGES, CHANGING * len(values)):
        return None
    step = float(np.quantile(changes, 0.02))
    counts = changes / step
    single = float(np.mean(np.abs(counts - 1) < 0.05))
    whole = float(np.mean(np.abs(counts - np.round(counts)) < 0.05 + 0.01 * counts))
    return step if whole > 0.95 and single > 0.1 else None
