"""Recordings of an IMU as others would give them: filters, mountings, units, faults of axes."""

from collections.abc import Callable

import numpy as np
from scipy.signal import bilinear, butter, lfilter, sosfilt, sosfilt_zi

from odometry.arrays import FloatArray
from odometry.feel.recorded.signals import AXES

RATE_HZ = 100.0  # of the recordings
Change = Callable[[FloatArray], FloatArray]


def average(samples: int) -> Change:
    """A moving average of so many samples."""
    weights = np.full(samples, 1 / samples)

    def change(axes: FloatArray) -> FloatArray:
        padded = np.hstack([np.repeat(axes[:, :1], samples - 1, axis=1), axes])
        return np.array([np.convolve(one, weights, "valid") for one in padded])

    return change


def low_pass(order: int, corner: float, rows: slice = slice(None)) -> Change:
    """A Butterworth filter of some axes; its corner in shares of the sampling rate."""
    sos = butter(order, corner, fs=1.0, output="sos")

    def change(axes: FloatArray) -> FloatArray:
        start = sosfilt_zi(sos)[:, None, :] * axes[None, rows, :1]
        found = axes.copy()
        found[rows] = sosfilt(sos, axes[rows], axis=1, zi=start)[0]
        return found

    return change


def half_as_often(axes: FloatArray) -> FloatArray:
    """Every other sample, and straight lines between them."""
    at = np.arange(axes.shape[1])
    return np.array([np.interp(at, at[::2], one[::2]) for one in axes])


def turned(axes: FloatArray) -> FloatArray:
    """The IMU mounted with its x to the left."""
    return axes[[1, 0, 2, 4, 3, 5]] * np.array([-1, 1, 1, -1, 1, 1])[:, None]


def rotated(axis: int, degrees: float) -> Change:
    """The IMU turned about one of its axes."""
    one, other = (axis + 1) % 3, (axis + 2) % 3
    rotation, angle = np.eye(3), np.deg2rad(degrees)
    rotation[[one, other], [one, other]] = np.cos(angle)
    rotation[one, other], rotation[other, one] = -np.sin(angle), np.sin(angle)
    return lambda axes: np.vstack([rotation @ axes[GYRO], rotation @ axes[ACCEL]])


def times(factor: float, *rows: int) -> Change:
    """Some axes by a factor, their means as well."""
    factors = np.where(np.isin(np.arange(len(AXES)), rows), factor, 1.0)
    return lambda axes: axes * factors[:, None]


def clipped(most: float, rows: slice) -> Change:
    """Some axes within their range."""
    return on_rows(rows, lambda of: np.clip(of, -most, most))


def rounded(step: float, rows: slice) -> Change:
    """Some axes in whole steps."""
    return on_rows(rows, lambda of: np.round(of / step) * step)


def noisy(size: float, rows: slice) -> Change:
    """White noise added to some axes."""
    rng = np.random.default_rng(3)
    return on_rows(rows, lambda of: of + size * rng.normal(size=of.shape))


def dead(row: int, share: float) -> Change:
    """An axis that stays at one number after a share of the run."""
    return on_rows(
        slice(row, row + 1),
        lambda of: np.where(np.arange(of.shape[1]) < share * of.shape[1], of, of[:, :1]),
    )


def damped(hz: float, ratio: float) -> Change:
    """Mounted on rubber: the transmissibility of a mass on a spring and a damper."""
    turn = 2 * np.pi * hz
    above, below = bilinear([2 * ratio * turn, turn**2], [1, 2 * ratio * turn, turn**2], fs=RATE_HZ)

    def change(axes: FloatArray) -> FloatArray:
        return axes[:, :1] + lfilter(above, below, axes - axes[:, :1], axis=1)

    return change


def everything(factor: float) -> Change:
    """All vibration by a factor: other tyres, pressure or load."""
    return scaled(factor, slice(None))


def slow_part(factor: float, below_hz: float) -> Change:
    """Vibration below a frequency by a factor: a heavier robot."""
    part = low_pass(2, below_hz / RATE_HZ)
    return lambda axes: axes + (factor - 1) * (part(axes) - axes.mean(axis=1, keepdims=True))


def tone(hz: float, accel_m_s2: float, gyro_rad_s: float, harmonics: int = 1) -> Change:
    """An engine that runs: a tone in all axes, with its harmonics."""
    phases = np.random.default_rng(11).uniform(0, 2 * np.pi, (harmonics, len(AXES), 1))
    size = np.array([gyro_rad_s] * 3 + [accel_m_s2] * 3)[:, None]

    def change(axes: FloatArray) -> FloatArray:
        turns = 2 * np.pi * hz * np.arange(axes.shape[1]) / RATE_HZ
        waves = [np.sin(n * turns + of) / n for n, of in enumerate(phases, start=1)]
        return axes + size * np.sum(waves, axis=0)

    return change


def bursts(share: float, samples: int, lost: Callable[[FloatArray, int], FloatArray]) -> Change:
    """A share of the samples lost in bursts; `lost` gives the axes (A, 1) at a burst's start."""

    def change(axes: FloatArray) -> FloatArray:
        found, count = axes.copy(), axes.shape[1]
        rng = np.random.default_rng(11)
        for at in rng.integers(1, count - samples, int(share * count / samples)):
            found[:, at : at + samples] = lost(axes, int(at))
        return found

    return change


def resonant(hz: float, gain: float, width: float) -> Change:
    """A part that rings: a peak added to the response."""
    turn = 2 * np.pi * hz
    above, below = bilinear([gain * width * turn, 0], [1, width * turn, turn**2], fs=RATE_HZ)
    return lambda axes: axes + lfilter(above, below, axes - axes.mean(axis=1, keepdims=True))


def on_rows(rows: slice, of: Change) -> Change:
    """A change of some axes alone."""

    def change(axes: FloatArray) -> FloatArray:
        found = axes.copy()
        found[rows] = of(axes[rows])
        return found

    return change


def scaled(factor: float, rows: slice) -> Change:
    """Some axes by a factor, their means aside."""

    def change(axes: FloatArray) -> FloatArray:
        found, mean = axes.copy(), axes[rows].mean(axis=1, keepdims=True)
        found[rows] = mean + factor * (axes[rows] - mean)
        return found

    return change


GYRO, ACCEL = slice(0, 3), slice(3, 6)
ALTERED: dict[str, Change] = {
    "as it is": lambda axes: axes,
    "average of 3": average(3),
    "average of 5": average(5),
    "average of 7": average(7),
    "average of 11": average(11),
    "1st order, .05": low_pass(1, 0.05),
    "1st order, .2": low_pass(1, 0.2),
    "2nd order, .3": low_pass(2, 0.3),
    "4th order, .4": low_pass(4, 0.4),
    "gyro, 2nd, .15": low_pass(2, 0.15, GYRO),
    "accel, 2nd, .15": low_pass(2, 0.15, ACCEL),
    "half the rate": half_as_often,
    "x to the left": turned,
    "accel twice": scaled(2.0, ACCEL),
    "gyro in degrees/s": lambda axes: np.vstack([np.rad2deg(axes[GYRO]), axes[ACCEL]]),
    "accel in g": lambda axes: np.vstack([axes[GYRO], axes[ACCEL] / 9.81]),
    "x and z swapped": lambda axes: axes[[2, 1, 0, 5, 4, 3]],
    "constant": lambda axes: np.repeat(axes[:, :1], axes.shape[1], axis=1),
    "turned by 20": rotated(2, 20),
    "turned by 45": rotated(2, 45),
    "turned by 180": rotated(2, 180),
    "pitched by 20": rotated(1, 20),
    "pitched by 40": rotated(1, 40),
    "rolled by 20": rotated(0, 20),
    "upside down": rotated(0, 180),
    "x and y swapped": lambda axes: axes[[1, 0, 2, 4, 3, 5]],
    "gyro x, y swapped": lambda axes: axes[[1, 0, 2, 3, 4, 5]],
    "left-handed": times(-1, 1, 4),
    "sign of gyro_x": times(-1, 0),
    "sign of gyro_z": times(-1, 2),
    "gyro doubled": times(2, 0, 1, 2),
    "gyro halved": times(0.5, 0, 1, 2),
    "accel doubled": times(2, 3, 4, 5),
    "no gravity": on_rows(ACCEL, lambda of: of - of.mean(axis=1, keepdims=True)),
    "gyro_x dead": dead(0, 0.0),
    "accel_z dead, half": dead(5, 0.5),
    "clipped at 2 g": clipped(19.62, ACCEL),
    "clipped at 1 g": clipped(9.81, ACCEL),
    "clipped at .1 rad/s": clipped(0.1, GYRO),
    "damper, 8 Hz": damped(8, 0.3),
    "damper, 25 Hz": damped(25, 0.1),
    "accel noise .5": noisy(0.5, ACCEL),
    "gyro noise .05": noisy(0.05, GYRO),
    "gyro in .01 rad/s": rounded(0.01, GYRO),
    "gyro in .02 rad/s": rounded(0.02, GYRO),
    "accel in 1 m/s2": rounded(1.0, ACCEL),
    "all x .5": everything(0.5),
    "all x 2": everything(2.0),
    "below 10 Hz x .5": slow_part(0.5, 10.0),
    "below 10 Hz x 1.5": slow_part(1.5, 10.0),
    "tone of 12 Hz": tone(12.0, 0.5, 0.02),
    "tone of 25 Hz": tone(25.0, 0.5, 0.02),
    "13 Hz, harmonics": tone(13.0, 1.0, 0.04, harmonics=3),
    "resonance of 8 Hz": resonant(8.0, 1.0, 0.3),
    "resonance of 12 Hz": resonant(12.0, 1.5, 0.15),
    "lost, 10 %": bursts(0.1, 20, lambda axes, _: np.full((len(axes), 1), np.nan)),
    "held, 5 %": bursts(0.05, 10, lambda axes, at: axes[:, at - 1 : at]),
    "zeros, .5 %": bursts(0.005, 1, lambda axes, _: np.zeros((len(axes), 1))),
    "each sample twice": lambda axes: np.repeat(axes[:, ::2], 2, axis=1)[:, : axes.shape[1]],
}
