"""The gyroscope held against the headings of measured poses: its bias and its scale.

Yaw rate alone cannot distinguish a gyroscope whose scale is off from another terrain, nor, in a
turn to one side, a bias. Measured headings can: what the gyroscope turned less what they turned
grows with time by its bias, and with the turn by its scale. Each window is a linear least squares
fit of that difference; poses that are late add a part in proportion to the yaw rate, which is
fitted as well.
"""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.geometry.angles import wrap
from odometry.recording.run import Run
from odometry.recording.sensors import YawRate, gyroscope_of
from odometry.windows.recorded.measured_poses import YAW_FOUND

WINDOW_S, EVERY_S = 5.0, 0.5
LEAST_POSES, LEAST_SHARE = 15, 0.8  # of a window, and of its time
FREE = np.array([0.05, 0.5, 0.3])  # prior deviations of bias [rad/s], scale error, delay [s]
SCALE_IS_RIGHT = np.array([0.1, 0.02, 0.3])  # the same where the scale is taken to be right
MOST_CORRELATED = 0.95  # of neighbouring residuals
GYROSCOPE_RAD = 0.02  # by which what a gyroscope turned in a window is off for other reasons
BIAS_ERROR_RAD_S = 0.0015  # of a window's bias, for the same reasons
USEFUL_BIAS_RAD_S = 0.0025  # standard deviation up to which a bias is taken
MOST_LATE_S = 0.1  # of poses: later ones determine no bias, the fit is linear in the delay
SCALE_TOLERANCE, SCALE_SIGMAS = 0.05, 4.0  # beyond both a scale is off
TOGETHER_S = 15.0  # for which windows determine the scale together, beside all of the run so far
"""Round numbers by which the scale is taken for off in 1 % of the windows of data/motion."""


@dataclass(frozen=True)
class HeadingCheck:
    """One fit for each window, at its end.

    Attributes
    ----------
    stamps_s : (K,)
        Ends of the windows.
    bias_rad_s, bias_sigma_rad_s : (K,)
        Of the gyroscope, if its scale is right.
    scale, scale_sigma : (K,)
        The gyroscope reads so many times what the headings turn.
    found : bool
        Whether the headings were found from positions, and not measured.
    """

    stamps_s: FloatArray
    bias_rad_s: FloatArray
    bias_sigma_rad_s: FloatArray
    scale: FloatArray
    scale_sigma: FloatArray
    found: bool = False

    @property
    def scale_is_off(self) -> BoolArray:
        """Where (K,) headings show that the scale is not 1: of a window, or of some seconds.

        Those that were found from positions follow the gyroscope for some seconds, and say little
        of its scale there: of them all of the run so far count as well. Measured ones do not:
        those of real runs are off by up to a tenth together, and found ones by a twentieth.
        """
        over = (TOGETHER_S, np.inf) if self.found else (TOGETHER_S,)
        pairs = ((self.scale, self.scale_sigma), *map(self.scale_over, over))
        off = [np.abs(scale - 1) > SCALE_TOLERANCE + SCALE_SIGMAS * of for scale, of in pairs]
        return np.asarray(np.any(off, axis=0))

    @property
    def scale_is_right(self) -> BoolArray:
        """Where (K,) the headings show that the scale is 1."""
        off = np.abs(self.scale - 1)
        return np.asarray(off + self.scale_sigma < 2 * SCALE_TOLERANCE) & ~self.scale_is_off

    def scale_over(self, seconds: float) -> tuple[FloatArray, FloatArray]:
        """Mean (K,) of the scales of so many seconds, weighted, and its standard deviation.

        Windows overlap: as many as lie in one count as one.
        """
        weights = self.scale_sigma**-2.0
        first = np.searchsorted(self.stamps_s, self.stamps_s - seconds + 1e-9)
        sums = np.concatenate(
            [np.zeros((1, 2)), np.cumsum(np.column_stack([weights, weights * self.scale]), axis=0)]
        )
        weight, weighted = (sums[1:] - sums[first]).T
        return weighted / weight, np.sqrt(WINDOW_S / EVERY_S / weight)

    @property
    def bias_windows(self) -> IntArray:
        """Places of windows, none of which overlap, that determine the bias."""
        useful = (self.bias_sigma_rad_s <= USEFUL_BIAS_RAD_S) & ~self.scale_is_off
        chosen: list[int] = []
        for place in np.flatnonzero(useful):
            if not chosen or self.stamps_s[place] - self.stamps_s[chosen[-1]] >= WINDOW_S - 1e-9:
                chosen.append(int(place))
        return np.array(chosen, dtype=np.int64)


def heading_check(run: Run) -> HeadingCheck | None:
    """The windows of a run; None without a gyroscope or without enough measured headings."""
    yaw_rate = run.yaw_rate
    if yaw_rate is None or run.pose is None or len(yaw_rate.stamps_s) < LEAST_POSES:
        return None
    yaw_rate = without_spikes(yaw_rate)
    gyroscope = gyroscope_of(yaw_rate)
    measured = np.isfinite(run.pose["yaw"])
    if gyroscope is None or measured.sum() < LEAST_POSES:
        return None
    stamps_s, yaw_rad = run.pose.stamps_s[measured], run.pose["yaw"][measured]
    turned, _, _, silent_s = gyroscope.between(stamps_s[:-1], stamps_s[1:])
    apart = np.append(0.0, np.cumsum(wrap(turned - np.diff(yaw_rad))))
    chained = silent_s == 0
    if "window" in run.pose:
        chained &= np.diff(run.pose["window"][measured]) == 0
    sigma_rad = _noise_rad(apart, chained)
    if sigma_rad is None:
        return None
    turn_rad = np.append(0.0, np.cumsum(turned))
    rate_rad_s = np.interp(stamps_s, yaw_rate.stamps_s, yaw_rate.yaw_rate_rad_s)
    table = np.column_stack([stamps_s, turn_rad, rate_rad_s, apart])
    piece = np.append(0, np.cumsum(~chained))
    ends_s = np.arange(stamps_s[0] + WINDOW_S, stamps_s[-1] + 1e-9, EVERY_S)
    first = np.searchsorted(stamps_s, ends_s - WINDOW_S, side="right")
    after = np.searchsorted(stamps_s, ends_s, side="right")
    rows = []
    for end_s, begin, end in zip(ends_s, first, after, strict=True):
        known = end - begin >= LEAST_POSES
        if known and stamps_s[end - 1] - stamps_s[begin] >= LEAST_SHARE * WINDOW_S:
            rows.append([end_s, *_fitted(table[begin:end], piece[begin:end], sigma_rad)])
    found = YAW_FOUND in run.pose
    return replace(HeadingCheck(*np.array(rows).T), found=found) if rows else None


def _fitted(table: FloatArray, piece: IntArray, sigma_rad: float) -> tuple[float, ...]:
    """Bias and scale of one window, each with its standard deviation."""
    centred = table.copy()
    for one in np.unique(piece):  # what poses that are not chained are apart is not known
        centred[piece == one] -= centred[piece == one].mean(axis=0)
    inputs, apart = centred[:, :3], centred[:, 3]
    values, sigmas = _least_squares(inputs, apart, sigma_rad, FREE)
    sigma = np.hypot(sigmas[1], GYROSCOPE_RAD / max(float(inputs[:, 1].std()), 1e-9))
    # headings turn by (1 - value) of what the gyroscope turned
    scale = 1 / max(1 - values[1], 1e-3)
    biases, bias_sigmas = _least_squares(inputs, apart, sigma_rad, SCALE_IS_RIGHT)
    late = abs(biases[2]) > MOST_LATE_S
    bias_sigma = np.inf if late else np.hypot(bias_sigmas[0], BIAS_ERROR_RAD_S)
    return biases[0], bias_sigma, scale, sigma * scale**2


def _least_squares(
    inputs: FloatArray, wanted: FloatArray, sigma_rad: float, prior: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Values (3,) and their standard deviations, which hold what is left.

    Correlated residuals count as first-order autoregression: n of them count as
    n (1 - r) / (1 + r) independent ones.
    """
    covariance = np.linalg.inv(inputs.T @ inputs / sigma_rad**2 + np.diag(prior**-2.0))
    values = covariance @ inputs.T @ wanted / sigma_rad**2
    left = wanted - inputs @ values
    square = float(left @ left)
    together = float(np.clip(left[1:] @ left[:-1] / max(square, 1e-300), 0.0, MOST_CORRELATED))
    factor = max(1.0, np.sqrt(square / len(left)) / sigma_rad)
    factor *= np.sqrt((1 + together) / (1 - together))
    return values, np.sqrt(np.diag(covariance)) * factor


def _noise_rad(apart: FloatArray, chained: BoolArray) -> float | None:
    """Noise of a heading, from second differences, robustly; None where too few are chained."""
    second = np.diff(apart, 2)[chained[1:] & chained[:-1]]
    if len(second) < LEAST_POSES:
        return None
    return float(max(np.median(np.abs(second)) / 0.6745 / np.sqrt(6.0), 1e-5))


def without_spikes(yaw_rate: YawRate) -> YawRate:
    """The median of each three samples."""
    values = yaw_rate.yaw_rate_rad_s.copy()
    values[1:-1] = np.median(np.stack([values[:-2], values[1:-1], values[2:]]), axis=0)
    return yaw_rate._replace(yaw_rate_rad_s=values)
