"""Banks of filters, one for each mode."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from odometry.arrays import FloatArray


class Bank(Protocol):
    """M filters of one state, one for each mode."""

    @property
    def modes(self) -> int:
        """The number M of filters."""

    def predicted(
        self, means: FloatArray, covariances: FloatArray, u: FloatArray, step_s: float
    ) -> tuple[FloatArray, FloatArray]:
        """Means (M, n) and covariances (M, n, n) a step later, under the input `u`."""

    def updated(
        self, means: FloatArray, covariances: FloatArray, z: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Means, covariances, log-likelihoods (M,), normalised innovations squared (M,).

        An entry of `z` that is NaN was not measured; at least one was.
        """


class Member(Protocol):
    """A filter of one mode."""

    def predicted(
        self, mean: FloatArray, covariance: FloatArray, u: FloatArray, step_s: float
    ) -> tuple[FloatArray, FloatArray]:
        """Mean (n,) and covariance (n, n) a step later, under the input `u`."""

    def updated(
        self, mean: FloatArray, covariance: FloatArray, z: FloatArray
    ) -> tuple[FloatArray, FloatArray, float, float]:
        """Mean, covariance, log-likelihood, normalised innovation squared."""


@dataclass(frozen=True)
class Members:
    """A bank of any filters, run one after the other."""

    members: tuple[Member, ...]

    @property
    def modes(self) -> int:
        """The number M of filters."""
        return len(self.members)

    def predicted(
        self, means: FloatArray, covariances: FloatArray, u: FloatArray, step_s: float
    ) -> tuple[FloatArray, FloatArray]:
        """Means (M, n) and covariances (M, n, n) a step later."""
        each = [
            member.predicted(mean, covariance, u, step_s)
            for member, mean, covariance in zip(self.members, means, covariances, strict=True)
        ]
        return np.array([mean for mean, _ in each]), np.array([cov for _, cov in each])

    def updated(
        self, means: FloatArray, covariances: FloatArray, z: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Means, covariances, log-likelihoods (M,), normalised innovations squared (M,)."""
        each = [
            member.updated(mean, covariance, z)
            for member, mean, covariance in zip(self.members, means, covariances, strict=True)
        ]
        new_means, new_covariances, log_likelihoods, squared = zip(*each, strict=True)
        return (
            np.array(new_means),
            np.array(new_covariances),
            np.array(log_likelihoods),
            np.array(squared),
        )
