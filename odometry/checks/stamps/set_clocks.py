"""Clocks that run apart, or one that was set: a lag that grows evenly, or in one step."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.stamps.late_stamps import CLEARLY
from odometry.checks.stamps.rates_by_delay import (
    GRID_S,
    MOST_TIMES,
    PARTS,
    STEP_S,
    centred,
    left_by,
    left_by_growing,
    moment_of,
    rate,
    two_delays,
    width_s,
)
from odometry.checks.stamps.timing import headings_by_sensor
from odometry.checks.statistics.lag import Lag

GROWTHS = np.linspace(0.6, 1.4, 9)  # of the growth that was found
AROUND_S = 0.3  # of the lags that were found, at either end of the recording


def step_of_lag(evidence: Evidence, pair: tuple[str, str], lag: Lag) -> tuple[str, bool]:
    """Words where one step of a lag that grows explains the turns about as well; "" elsewhere.

    Parameters
    ----------
    evidence : Evidence
    pair : (late, early)
        Names of `headings_by_sensor`.
    lag : Lag

    Returns
    -------
    words : str
    clearly : bool
        Whether the step explains them clearly better.
    """
    begin_s, end_s = evidence.stamps_s[[0, -1]]
    reach_s = abs(lag.drift) * (end_s - begin_s) / 2 + AROUND_S
    delays_s = lag.seconds + np.arange(-reach_s, reach_s + STEP_S, STEP_S)
    found = left_by_delays(evidence, pair, delays_s)
    if found is None:
        return "", False
    at_s, squares, _ = found
    middle_s = float(evidence.stamps_s[[0, -1]].mean())
    growing_s = (lag.seconds + of * lag.drift * (at_s - middle_s) for of in GROWTHS)
    grown = left_by_growing(squares, delays_s, growing_s)
    stepped, before, after, share = two_delays(squares)
    if stepped > grown / CLEARLY:
        return "", False
    moment_s = evidence.run_time_s(moment_of(at_s, share))
    words = (
        f"a lag of {delays_s[before]:+.2f} s before {moment_s:.0f} s of run time, and of "
        f"{delays_s[after]:+.2f} s after, as of a clock that was set"
    )
    return words, stepped < CLEARLY * grown


def left_by_delays(
    evidence: Evidence, pair: tuple[str, str], delays_s: FloatArray
) -> tuple[FloatArray, FloatArray, float] | None:
    """Stamps (N,), squares (D, N) of the rates that each delay leaves there, and squares of all.

    None where too little is known.
    """
    signals = headings_by_sensor(evidence)
    over_s = width_s(evidence, pair)
    begin_s, end_s = evidence.stamps_s[[0, -1]]
    every = 1 + int((end_s - begin_s) / GRID_S) // MOST_TIMES
    at_s = np.arange(begin_s, end_s, every * GRID_S)
    late, early = (signals[name] for name in pair)
    by_delay = np.stack([rate(early, at_s - delay_s, over_s) for delay_s in delays_s])
    measured = rate(late, at_s, over_s)
    known = np.isfinite(by_delay).all(axis=0) & np.isfinite(measured)
    if known.sum() < PARTS:
        return None
    by_delay, measured = centred(by_delay[:, known]), centred(measured[known])
    best = by_delay[int(np.argmin(left_by(measured, by_delay)))]
    gain = float(best @ measured / (best @ best))
    squares = (measured - gain * by_delay) ** 2
    return at_s[known], squares, float(np.sum(measured**2))
