"""A gyroscope while its samples come in: the integrals of `odometry.gyroscope`."""

import math

import numpy as np

from odometry.gyroscope import Gyroscope, step_integrals


class LiveGyroscope:
    """Mean yaw rates between stamps, by samples up to now; samples of the past are forgotten.

    Attributes
    ----------
    latest_s : float
        Stamp of the latest sample.
    """

    def __init__(self) -> None:
        self.latest_s = -math.inf
        self._rate_rad_s = math.nan
        self._stamps_s: list[float] = []
        self._integrals = [np.zeros(4)]

    def add(self, stamp_s: float, yaw_rate_rad_s: float) -> bool:
        """Take in a sample; False where its stamp does not increase, or it is no number."""
        if not (self.latest_s < stamp_s < math.inf and math.isfinite(yaw_rate_rad_s)):
            return False
        if self._stamps_s:
            steps = step_integrals(
                np.array([self.latest_s, stamp_s]), np.array([self._rate_rad_s, yaw_rate_rad_s])
            )
            self._integrals.append(self._integrals[-1] + steps[0])
        self._stamps_s.append(stamp_s)
        self.latest_s, self._rate_rad_s = stamp_s, yaw_rate_rad_s
        return True

    def mean_rate_rad_s(self, begin_s: float, end_s: float) -> float:
        """Mean yaw rate between two stamps; NaN where silent. Nothing older is asked again."""
        if not self._stamps_s or math.isinf(begin_s):
            return math.nan
        samples = Gyroscope(np.array(self._stamps_s), np.stack(self._integrals))
        rate = float(samples.mean_rates_rad_s(np.array([begin_s, end_s]))[1])
        first = max(int(np.searchsorted(self._stamps_s, end_s, side="right")) - 1, 0)
        del self._stamps_s[:first], self._integrals[:first]
        return rate
