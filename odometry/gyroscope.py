"""The angle that a gyroscope turned up to any moment, and where it has no samples."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.sensors import YawRate

SILENT_S = 0.5  # between two samples: a turn between them is not known


@dataclass(frozen=True)
class Gyroscope:
    """Integrals over the yaw rate of a run, up to each of G samples.

    Attributes
    ----------
    stamps_s : (G,)
    integrals : (G, 4)
        Turn [rad] by the trapezoidal rule, its gross size [rad], how far the rule can be off
        [rad], and time without samples [s].
    """

    stamps_s: FloatArray
    integrals: FloatArray

    def between(self, begin_s: FloatArray, end_s: FloatArray) -> FloatArray:
        """Integrals (4, K) from stamps (K,) to others; zero where there are no samples."""
        turn, gross, off, silent_s = (
            np.interp(end_s, self.stamps_s, column) - np.interp(begin_s, self.stamps_s, column)
            for column in self.integrals.T
        )
        outside_s = np.maximum(self.stamps_s[0] - begin_s, 0.0)
        outside_s = outside_s + np.maximum(end_s - self.stamps_s[-1], 0.0)
        return np.stack([turn, gross, off, silent_s + outside_s])

    def mean_rates_rad_s(self, stamps_s: FloatArray) -> FloatArray:
        """Mean yaw rate (N,) from the stamp before to each of N stamps.

        NaN at the first, and where samples are missing for more than half of the time.
        """
        turn_rad, _, _, silent_s = self.between(stamps_s[:-1], stamps_s[1:])
        steps_s = np.diff(stamps_s)
        return np.append(np.nan, np.where(silent_s > steps_s / 2, np.nan, turn_rad / steps_s))


def gyroscope_of(yaw_rate: YawRate | None) -> Gyroscope | None:
    """The integrals over measured yaw rates; None without two samples."""
    if yaw_rate is None or len(yaw_rate.stamps_s) < 2:
        return None
    steps = step_integrals(yaw_rate.stamps_s, yaw_rate.yaw_rate_rad_s)
    integrals = np.concatenate([np.zeros((1, 4)), np.cumsum(steps, axis=0)])
    return Gyroscope(yaw_rate.stamps_s, integrals)


def step_integrals(stamps_s: FloatArray, rates_rad_s: FloatArray) -> FloatArray:
    """Integrals (G - 1, 4), as a `Gyroscope` has them, from each sample to the next."""
    steps_s = np.diff(stamps_s)
    return np.column_stack(
        [
            (rates_rad_s[1:] + rates_rad_s[:-1]) / 2 * steps_s,
            (np.abs(rates_rad_s[1:]) + np.abs(rates_rad_s[:-1])) / 2 * steps_s,
            np.abs(np.diff(rates_rad_s)) / 2 * steps_s,
            np.where(steps_s > SILENT_S, steps_s, 0.0),
        ]
    )
