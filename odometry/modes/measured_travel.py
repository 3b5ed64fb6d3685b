"""Travel of the robot by measured poses, step by step, in its own frame."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.modes.heading_check import without_spikes
from odometry.run import Run
from odometry.sensors import gyroscope_of
from odometry.windows.gaps import odometry_gaps
from odometry.windows.spans import touched
from odometry.windows.turns import continuous_yaw

LEAST_STEPS = 20  # of a run


@dataclass(frozen=True)
class MeasuredTravel:
    """Steps from a measured position to the next that is chained to it.

    Attributes
    ----------
    begin_s, end_s : (K,)
    ahead_m : (K,)
        Forward by the measured heading; NaN where it was not measured.
    turned_m : (K, 2)
        In a frame that turns by the gyroscope, from an unknown direction on; NaN without a
        gyroscope.
    noise_m : float
        Standard deviation of a position.
    """

    begin_s: FloatArray
    end_s: FloatArray
    ahead_m: FloatArray
    turned_m: FloatArray
    noise_m: float


def measured_travel(run: Run) -> MeasuredTravel | None:
    """The steps of a run within its odometry; None without LEAST_STEPS of them."""
    if run.pose is None:
        return None
    odometry_s = run.odometry.stamps_s
    places_m = run.pose.stack("x", "y")
    inside = (run.pose.stamps_s >= odometry_s[0]) & (run.pose.stamps_s <= odometry_s[-1])
    rows = np.flatnonzero(np.isfinite(places_m).all(axis=1) & inside)
    if len(rows) <= LEAST_STEPS:
        return None
    stamps_s, places_m = run.pose.stamps_s[rows], places_m[rows]
    yaw_rad = continuous_yaw(run)[rows]
    chained = ~touched(odometry_gaps(run).spans_s, stamps_s[:-1], stamps_s[1:])
    if "window" in run.pose:
        chained &= np.diff(run.pose["window"][rows]) == 0
    if chained.sum() < LEAST_STEPS:
        return None
    steps_m = np.diff(places_m, axis=0) @ [1.0, 1.0j]
    ahead_m = (steps_m * np.exp(-0.5j * (yaw_rad[1:] + yaw_rad[:-1]))).real
    by_gyroscope = steps_m * np.exp(-1j * _turned_rad(run, (stamps_s[1:] + stamps_s[:-1]) / 2))
    # third differences of a smooth way are noise, of 20 times the variance
    third = np.abs(np.diff(places_m, 3, axis=0))
    return MeasuredTravel(
        stamps_s[:-1][chained],
        stamps_s[1:][chained],
        ahead_m[chained],
        np.column_stack([by_gyroscope.real, by_gyroscope.imag])[chained],
        float(np.median(third)) / 0.6745 / np.sqrt(20.0),
    )


def _turned_rad(run: Run, stamps_s: FloatArray) -> FloatArray:
    """What the gyroscope turned up to each stamp; NaN without one."""
    yaw_rate = run.yaw_rate
    gyroscope = None if yaw_rate is None else gyroscope_of(without_spikes(yaw_rate))
    if gyroscope is None:
        return np.full(len(stamps_s), np.nan)
    begin_s = np.full(len(stamps_s), gyroscope.stamps_s[0])
    return np.asarray(gyroscope.between(begin_s, stamps_s)[0])
