"""A bank whose measurements say less than they seem to."""

from dataclasses import dataclass

from odometry.arrays import FloatArray
from odometry.estimation.bank import Bank


@dataclass(frozen=True)
class TemperedBank:
    """A bank with log-likelihoods times `independent`, the share of them that is news.

    Innovations of models that are not exact go together over time; their likelihoods multiplied
    say too much. The power that makes them honest is that of composite likelihoods (Varin, Reid,
    Firth 2011, Statistica Sinica 21).
    """

    bank: Bank
    independent: float

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
        means, covariances, logs, squared = self.bank.updated(means, covariances, z)
        return means, covariances, self.independent * logs, squared
