"""Two fits of one model to different windows: whether their parameters are the same."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from odometry.arrays import FloatArray
from odometry.identification.fit import Fit
from odometry.windows.window_errors import errors_over

BY_CHANCE = 1e-6  # probability below which fits differ
WORSE = 1.2  # how much farther off each part must be under the parameters of the other
NAMED_SIGMAS = 3.0  # of a difference that is named


@dataclass(frozen=True)
class FitPair:
    """Fits of one model to two parts of the recordings.

    Attributes
    ----------
    first, second : Fit
    """

    first: Fit
    second: Fit

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters that both parts determine."""
        determined = [
            {*fit.names} - fit.open_names - {*fit.at_bound} for fit in (self.first, self.second)
        ]
        return tuple(name for name in self.first.names if name in determined[0] & determined[1])

    @property
    def by_chance(self) -> float:
        """Probability of a difference as large if the parameters were the same (Wald's test)."""
        if not self.names:
            return 1.0
        squared = float(self._difference @ np.linalg.solve(self._covariance, self._difference))
        return float(chi2.sf(squared, len(self.names)))

    @property
    def worse(self) -> float:
        """How many times farther off a part is under the other's parameters: of the better part.

        By the mean error of position or of yaw, whichever shows more.
        """
        shares = []
        for own, other in ((self.first, self.second), (self.second, self.first)):
            here, there = (errors_over(f.model, f.packed, own.windows) for f in (own, other))
            shares.append(
                max(
                    float(theirs.mean() / max(ours.mean(), np.finfo(float).tiny))
                    for ours, theirs in (
                        (here.translation_per_m, there.translation_per_m),
                        (here.rotation_per_m, there.rotation_per_m),
                    )
                )
            )
        return min(shares)

    @property
    def differs(self) -> bool:
        """Whether the parameters differ for certain, and by enough to move the robot elsewhere.

        The probability was chosen by the halves of the 19 recordings of data/motion that are not
        among the seven on which the odometer is evaluated: it is 5e-6 and more on each.
        """
        return self.by_chance < BY_CHANCE and self.worse >= WORSE

    @property
    def values_named(self) -> str:
        """The parameters that differ clearly, with both values."""
        sigmas = np.sqrt(np.diag(self._covariance))
        clear = np.abs(self._difference) / sigmas
        return ", ".join(
            f"{name} {self.first.values[name]:.3g} and {self.second.values[name]:.3g}"
            for name, size in zip(self.names, clear.tolist(), strict=True)
            if size > min(NAMED_SIGMAS, clear.max() * 0.999)
        )

    @property
    def _difference(self) -> FloatArray:
        return np.array([self.second.values[n] - self.first.values[n] for n in self.names])

    @property
    def _covariance(self) -> FloatArray:
        return _of(self.first, self.names) + _of(self.second, self.names)


def _of(fit: Fit, names: Iterable[str]) -> FloatArray:
    rows = [fit.names.index(name) for name in names]
    return fit.normal_covariance[np.ix_(rows, rows)]
