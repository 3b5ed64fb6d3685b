"""Turn of the robot by measured headings, step by step, and by the gyroscope."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.modes.heading_check import without_spikes
from odometry.run import Run
from odometry.sensors import gyroscope_of
from odometry.windows.turns import continuous_yaw

LEAST_STEPS = 20  # of a run
LATE_S = np.arange(-2, 5) * 0.15  # of headings against the gyroscope: clocks are not always one


@dataclass(frozen=True)
class MeasuredTurn:
    """Steps from a measured heading to the next that is chained to it.

    Attributes
    ----------
    begin_s, end_s : (K,)
    heading_rad : (K,)
    gyroscope_rad : (L, K)
        For headings that are LATE_S (L,); NaN where it is silent.
    noise_rad : float
        Standard deviation of a heading.
    """

    begin_s: FloatArray
    end_s: FloatArray
    heading_rad: FloatArray
    gyroscope_rad: FloatArray
    noise_rad: float


def measured_turn(run: Run) -> MeasuredTurn | None:
    """The steps of a run; None without a gyroscope or LEAST_STEPS of them."""
    yaw_rate = run.yaw_rate
    gyroscope = None if yaw_rate is None else gyroscope_of(without_spikes(yaw_rate))
    if gyroscope is None or run.pose is None:
        return None
    known = np.isfinite(run.pose["yaw"])
    if known.sum() <= LEAST_STEPS:
        return None
    stamps_s, yaw_rad = run.pose.stamps_s[known], continuous_yaw(run)[known]
    chained = np.ones(len(stamps_s) - 1, dtype=np.bool_)
    if "window" in run.pose:
        chained &= np.diff(run.pose["window"][known]) == 0
    if chained.sum() < LEAST_STEPS:
        return None
    begin_s, end_s = stamps_s[:-1][chained], stamps_s[1:][chained]
    turned = []
    for late_s in LATE_S:
        turn_rad, _, _, silent_s = gyroscope.between(begin_s - late_s, end_s - late_s)
        turned.append(np.where(silent_s > 0, np.nan, turn_rad))
    # third differences of a smooth turn are noise, of 20 times the variance
    third = np.abs(np.diff(yaw_rad, 3))
    noise_rad = float(np.median(third)) / 0.6745 / np.sqrt(20.0)
    return MeasuredTurn(begin_s, end_s, np.diff(yaw_rad)[chained], np.array(turned), noise_rad)
