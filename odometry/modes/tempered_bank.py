"""A bank whose measurements are correlated: their likelihoods get a power below 1."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.bank import Bank
from odometry.estimation.ekf_bank import wrapped

OUTLIERS = 1e-3  # share of measurements that follow a Cauchy distribution
MOST_SIGMAS = 5.0  # root mean square of an innovation beyond which it pulls no more


@dataclass(frozen=True)
class TemperedBank:
    """A bank with log-likelihoods times `independent`, the share of them that is news.

    Innovations of models that are not exact go together over time; their likelihoods multiplied
    count too much. The power that corrects this is that of composite likelihoods (Varin, Reid,
    Firth 2011, Statistica Sinica 21).

    A single outlier hardly counts: the likelihood is that of a Gaussian contaminated by a
    distribution with the tails of Cauchy's (Huber and Ronchetti 2009, section 1.5), and what an
    innovation corrects is bounded by MOST_SIGMAS.
    """

    bank: Bank
    independent: float
    state_angles: tuple[int, ...] = ()

    @property
    def modes(self) -> int:
        """The number M of filters."""
        return self.bank.modes

    def predicted(
        self, means: FloatArray, covariances: FloatArray, u: FloatArray, step_s: float
    ) -> tuple[FloatArray, FloatArray]:
        """See `Bank.predicted`."""
        return self.bank.predicted(means, covariances, u, step_s)

    def updated(
        self, means: FloatArray, covariances: FloatArray, z: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """See `Bank.updated`."""
        corrected, covariances, logs, squared = self.bank.updated(means, covariances, z)
        entries = int(np.isfinite(z).sum())
        tails = np.log(OUTLIERS) + squared / 2 - (entries + 1) / 2 * np.log1p(squared)
        logs = logs + np.logaddexp(np.log1p(-OUTLIERS), tails)
        bound = MOST_SIGMAS * np.sqrt(entries)
        pull = bound / np.maximum(np.sqrt(squared), bound)
        step = pull[:, None] * wrapped(corrected - means, self.state_angles)
        corrected = wrapped(means + step, self.state_angles)
        return corrected, covariances, self.independent * logs, squared
