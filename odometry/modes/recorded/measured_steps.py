"""Steps from one measured pose to the next: travel and turn, and sums over windows of steps."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.modes.recorded.heading_check import without_spikes
from odometry.recording.run import Run
from odometry.recording.sensors import gyroscope_of
from odometry.windows.recorded.gaps import odometry_gaps
from odometry.windows.recorded.spans import touched
from odometry.windows.recorded.turns import continuous_yaw

LEAST_STEPS = 20  # of a run
LATE_S = np.arange(-2, 5) * 0.15  # of headings against the gyroscope: clocks are not always one

EVERY_S = 0.5  # from a window to the next
LEAST_IN_WINDOW = 10  # of a window


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


@dataclass(frozen=True)
class StepWindows:
    """Windows over K steps, each ended by a stamp.

    Attributes
    ----------
    ends_s : (W,)
    first, after : (W,)
        Its first step, and the one after its last.
    """

    ends_s: FloatArray
    first: IntArray
    after: IntArray

    def __len__(self) -> int:
        return len(self.ends_s)

    def sums(self, values: FloatArray) -> FloatArray:
        """Of values (..., K) in each window (..., W); NaN where one of them is."""
        known = np.isfinite(values)
        whole, missing = (
            np.concatenate([np.zeros((*of.shape[:-1], 1)), np.cumsum(of, axis=-1)], axis=-1)
            for of in (np.where(known, values, 0.0), ~known)
        )
        complete = missing[..., self.after] == missing[..., self.first]
        return np.where(complete, whole[..., self.after] - whole[..., self.first], np.nan)

    def in_force(self, stamps_s: FloatArray, holds_s: float) -> tuple[IntArray, BoolArray]:
        """The last window (N,) before each stamp; whether (N,) it is no older than `holds_s`."""
        last = np.searchsorted(self.ends_s, stamps_s, side="right") - 1
        return last, (last >= 0) & (stamps_s - self.ends_s[last] <= holds_s)


def step_windows(begin_s: FloatArray, end_s: FloatArray, window_s: float) -> StepWindows:
    """Windows of so long over steps (K,), those with fewer than LEAST_IN_WINDOW left out."""
    ends_s = np.arange(begin_s[0] + window_s, end_s[-1] + 1e-9, EVERY_S)
    first = np.searchsorted(begin_s, ends_s - window_s - 1e-9)
    after = np.searchsorted(end_s, ends_s + 1e-9, side="right")
    enough = after - first >= LEAST_IN_WINDOW
    return StepWindows(ends_s[enough], first[enough], after[enough])


def during(
    begin_s: FloatArray, end_s: FloatArray, stamps_s: FloatArray, rates: FloatArray
) -> FloatArray:
    """Integrals (..., K) of rates (..., N) at stamps over each step, by the trapezoidal rule."""
    means = (rates[..., 1:] + rates[..., :-1]) / 2 * np.diff(stamps_s)
    whole = np.concatenate([np.zeros((*rates.shape[:-1], 1)), np.cumsum(means, axis=-1)], axis=-1)
    at_end, at_begin = (_interpolated(at_s, stamps_s, whole) for at_s in (end_s, begin_s))
    return np.asarray(at_end - at_begin)


def _interpolated(at_s: FloatArray, stamps_s: FloatArray, values: FloatArray) -> FloatArray:
    rows = values.reshape(-1, values.shape[-1])
    found = np.array([np.interp(at_s, stamps_s, row) for row in rows])
    return found.reshape(*values.shape[:-1], len(at_s))
