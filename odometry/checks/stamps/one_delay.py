"""Whether a sensor is later than another by one delay.

A filter makes it slower, rows of two sources give it two delays at once, and a clock that is set
gives it one delay before and another one after.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.stamps.late_stamps import CLEARLY, CONSTANTS_S, NAMES
from odometry.checks.stamps.rates_by_delay import (
    GRID_S,
    MOST_TIMES,
    PARTS,
    STEP_S,
    centred,
    left_by,
    rate,
    two_delays,
    width_s,
)
from odometry.checks.stamps.timing import headings_by_sensor
from odometry.checks.statistics.lag import Lag, Signal

REACH_S = 0.6  # of delays around the lag that was found
LEAST_LAG_S = 0.1  # with less there is nothing to tell a delay from a filter
FILTER_S = 6.0  # time constants after which nothing is left of a value
# Shares of the squares that one delay leaves, or that delay over a wider window. Of 130 pairs of
# sensors with one delay a filter left 1.05 and more, two delays one after the other 0.95 and more;
# a filter of most pairs with one 0.02 to 0.86, and two delays 0.25 to 0.70 of clocks that were set
# (simulations with random drives and noise).
SLOWER, STEPS = 0.9, 0.8
WIDER = (2.0, 4.0)  # times that width, over which noise of the early sensor is less as well
LEAST_LEFT = 1e-3  # of the squared turns: with less one delay explains all there is


@dataclass(frozen=True)
class Answer:
    """How one sensor answers to the turns that another one measures.

    `left` is the share of the squared turns that the best delay leaves. `slower` and `stepped` are
    what a low-pass filter of `constant_s`, and two delays before and after a moment, leave of that.
    """

    late: str
    early: str
    left: float
    slower: float
    wider: float
    constant_s: float
    stepped: float
    before_s: float
    after_s: float
    moment_s: float

    @property
    def is_slower(self) -> bool:
        """Whether a filter explains surely more than one delay, noise of the early one or not."""
        share = self.slower / min(self.wider, 1.0)
        return self.left > LEAST_LEFT and share < min(SLOWER, self.stepped)

    @property
    def is_stepped(self) -> bool:
        """Whether two delays, one after the other, explain surely more than one."""
        return self.left > LEAST_LEFT and self.stepped < STEPS and not self.is_slower

    @property
    def slowly(self) -> str:
        """The cause where a filter explains it."""
        return (
            f"Turns of the {self.late} follow those of the {self.early} more slowly, not later by "
            "one delay: values that are smoothed (a low-pass filter of about "
            f"{self.constant_s:.2g} s leaves {100 * self.slower:.0f} % of what the best delay "
            "leaves), or rows of two sources, one later than the other"
        )

    @property
    def in_steps(self) -> str:
        """What is known where the delay is another one before and after a moment."""
        return (
            f"turns of the {self.late} are {self.before_s:+.2f} s behind those of the {self.early} "
            f"before {self.moment_s:.0f} s of run time, and {self.after_s:+.2f} s after, as by a "
            "clock that was set or stamps that jump"
        )


def answers(
    evidence: Evidence, sensor: str, lags: Mapping[tuple[str, str], Lag]
) -> Iterator[Answer]:
    """How a sensor and each other one follow each other, where one of both is late.

    Parameters
    ----------
    evidence : Evidence
    sensor : str
        "pose", "treads" or "gyroscope".
    lags : dict of (late, early) to Lag
    """
    signals = headings_by_sensor(evidence)
    for (first, second), lag in lags.items():
        if sensor not in (first, second) or abs(lag.seconds) < LEAST_LAG_S:
            continue
        late, early = (first, second) if lag.seconds > 0 else (second, first)
        found = _answer(evidence, (late, early), signals, abs(lag.seconds))
        if found is not None:
            yield found


def is_one_delay(found: Sequence[Answer]) -> bool:
    """Whether one delay explains the turns of a pair clearly better than a filter."""
    return any(answer.slower > 1 / CLEARLY and not answer.is_stepped for answer in found)


def _answer(
    evidence: Evidence,
    pair: tuple[str, str],
    signals: Mapping[str, Signal],
    lag_s: float,
) -> Answer | None:
    late, early = (signals[name] for name in pair)
    over_s = width_s(evidence, pair)
    grid_s = np.arange(evidence.stamps_s[0], evidence.stamps_s[-1], GRID_S)
    some = slice(round(FILTER_S / GRID_S), None, 1 + len(grid_s) // MOST_TIMES)
    at_s = grid_s[some]
    delays_s = lag_s + np.arange(-REACH_S, REACH_S + STEP_S / 2, STEP_S)
    by_delay, *wider = (
        np.stack([rate(early, at_s - delay_s, times * over_s) for delay_s in delays_s])
        for times in (1.0, *WIDER)
    )
    now = np.nan_to_num(rate(early, grid_s, over_s))
    by_filter = np.stack([_filtered(now, constant_s)[some] for constant_s in CONSTANTS_S])
    rows = [rate(late, at_s, over_s)[None], by_delay, by_filter, *wider]
    known = np.all([np.isfinite(of).all(axis=0) for of in rows], axis=0)
    if known.sum() < PARTS:
        return None
    measured, by_delay, by_filter, *wider = (centred(of[:, known]) for of in rows)
    one, slow = left_by(measured[0], by_delay), left_by(measured[0], by_filter)
    best = int(np.argmin(one))
    if not one[best] > 0:
        return None
    gain = float(by_delay[best] @ measured[0] / np.sum(by_delay[best] ** 2))
    stepped, before, after, share = two_delays((measured[0] - gain * by_delay) ** 2)
    return Answer(
        NAMES[pair[0]],
        NAMES[pair[1]],
        float(one[best] / np.sum(measured**2)),
        float(slow.min() / one[best]),
        float(min(left_by(measured[0], of).min() for of in wider) / one[best]),
        CONSTANTS_S[int(np.argmin(slow))],
        stepped / float(one[best]),
        float(delays_s[before]),
        float(delays_s[after]),
        evidence.run_time_s(float(at_s[known][int(share * known.sum())])),
    )


def _filtered(rates: FloatArray, constant_s: float) -> FloatArray:
    """Rates (N,) on the grid through a lag of first order."""
    kernel = np.exp(-np.arange(0.0, FILTER_S * constant_s, GRID_S) / constant_s)
    return np.convolve(rates, kernel / kernel.sum())[: len(rates)]
