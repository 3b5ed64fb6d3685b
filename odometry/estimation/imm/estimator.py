"""Interacting multiple model estimator (Blom and Bar-Shalom) over any bank of filters.

One state, several models of its motion, of which a Markov chain chooses one at each step. Equation
numbers are those of Salvi 2024; its eq. 9 prints the last probability where the recursion has the
predicted one of eq. 5 (Bar-Shalom, Li, Kirubarajan 2001, section 11.6.6).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Protocol

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import EstimationError
from odometry.estimation.imm.mode_belief import (
    ModeBelief,
    ModeInnovations,
    floored,
    log_sum,
    moments,
)

SUM_TOLERANCE = 1e-9


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


def is_measured(z: FloatArray) -> bool:
    """Whether an entry of a measurement (m,) is not NaN.

    Raises
    ------
    EstimationError
        If one is infinite.
    """
    seen = np.ravel(z).tolist()
    if any(map(math.isinf, seen)):
        raise EstimationError(f"a measurement {z}, expected finite numbers, or NaN for none")
    return not all(map(math.isnan, seen))


@dataclass(frozen=True)
class Imm:
    """An interacting multiple model estimator.

    Attributes
    ----------
    bank : Bank
    transition : function
        Probability (M, M) of being in mode j a step after mode i, from the step [s]:
        `ModeChain.transition`.
    state_angles : tuple of int
        Entries of the state that are angles [rad].
    floor : float
        The least probability of a mode, from 0 to below 1 / M: a mode that was ruled out can
        come back.
    """

    bank: Bank
    transition: Callable[[float], FloatArray]
    state_angles: tuple[int, ...] = ()
    floor: float = 1e-6

    def __post_init__(self) -> None:
        if not 0 <= self.floor < 1 / self.bank.modes:
            raise EstimationError(
                f"a floor of {self.floor} under each of {self.bank.modes} mode probabilities, "
                f"expected 0 to below {1 / self.bank.modes:g}"
            )

    def step(
        self,
        belief: ModeBelief,
        u: FloatArray,
        z: FloatArray | None,
        step_s: float,
    ) -> ModeBelief:
        """Estimate a step later: `predicted`, then `updated`.

        Parameters
        ----------
        belief : ModeBelief
        u : FloatArray
            Input that holds over the step, as the bank wants it.
        z : (m,) or None
            What is measured at the end of the step; NaN where an entry is not.
        step_s : float

        Raises
        ------
        EstimationError
            If shapes do not agree, a state becomes infinite, or no mode is possible.
        """
        return self.updated(self.predicted(belief, u, step_s), z)

    def predicted(self, belief: ModeBelief, u: FloatArray, step_s: float) -> ModeBelief:
        """Estimate a step later, before a measurement: `mixed`, then the models."""
        means, covariances, log_predicted = self.mixed(belief, step_s)
        moved = self.bank.predicted(means, covariances, u, step_s)
        return ModeBelief(*moved, log_predicted)

    def mixed(self, belief: ModeBelief, step_s: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Where the filters start, and the probabilities after a step: Salvi 2024 eq. 4-7.

        Means (M, n), covariances (M, n, n) and log-probabilities (M,), as of a `ModeBelief`.
        """
        log_joint = self._log_transition(belief, step_s) + belief.log_probabilities[:, None]
        log_predicted = log_sum(log_joint)  # eq. 5
        weights = _mixing_weights(log_joint, log_predicted)
        of_filters = belief.means, belief.covariances
        return *moments(weights, *of_filters, self.state_angles), log_predicted  # eq. 6-7

    def updated(self, predicted: ModeBelief, z: FloatArray | None) -> ModeBelief:
        """Estimate after a measurement: eq. 8-9; without one, probabilities stay; see `step`."""
        if z is None or not is_measured(z):
            logs = floored(predicted.log_probabilities, self.floor)
            return replace(predicted, log_probabilities=logs)
        updated = self.bank.updated(predicted.means, predicted.covariances, z)
        return self.weighed(predicted, *updated)

    def weighed(
        self,
        predicted: ModeBelief,
        means: FloatArray,
        covariances: FloatArray,
        log_likelihoods: FloatArray,
        squared: FloatArray,
    ) -> ModeBelief:
        """Estimate after a measurement, of which the bank made these of a prediction."""
        log_weights = predicted.log_probabilities + log_likelihoods  # eq. 9, with eq. 5's c_j
        if not math.isfinite(log_weights.max()):
            said = f"log-likelihoods {log_likelihoods.tolist()}"
            raise EstimationError(f"{said}, expected a finite one of a possible mode")
        innovations = ModeInnovations(log_likelihoods, squared)
        return ModeBelief(means, covariances, floored(log_weights, self.floor), innovations)

    def merged(self, belief: ModeBelief) -> tuple[FloatArray, FloatArray]:
        """Mean (n,) and covariance (n, n) over all modes: eq. 10-11."""
        weights = belief.probabilities[None]
        means, covariances = moments(weights, belief.means, belief.covariances, self.state_angles)
        return means[0], covariances[0]

    def _log_transition(self, belief: ModeBelief, step_s: float) -> FloatArray:
        matrix, modes = self.transition(step_s), self.bank.modes
        if belief.modes != modes or matrix.shape != (modes, modes):
            raise EstimationError(
                f"an estimate of {belief.modes} modes and a transition matrix of shape "
                f"{matrix.shape} for a bank of {modes} filters"
            )
        return _logarithms(matrix.tobytes(), modes)


@lru_cache(maxsize=256)  # steps of a run share their matrices
def _logarithms(transition: bytes, modes: int) -> FloatArray:
    """Logarithms (M, M) of the transition matrix with these bytes; checked."""
    matrix = np.frombuffer(transition).reshape(modes, modes)
    if matrix.min() < 0 or np.abs(matrix.sum(axis=1) - 1).max() > SUM_TOLERANCE:
        raise EstimationError(
            f"transition matrix {matrix.tolist()}, expected rows (from) that sum to 1"
        )
    return np.log(matrix, out=np.full(matrix.shape, -np.inf), where=matrix > 0)


def _mixing_weights(log_joint: FloatArray, log_predicted: FloatArray) -> FloatArray:
    """Salvi 2024 eq. 4: weights[j, i] of mode i in the start of filter j.

    A mode that nothing leads to starts where it was.
    """
    reached = log_predicted > -np.inf
    if reached.all():
        return np.asarray(np.exp(log_joint - log_predicted).T)
    weights = np.exp(log_joint - np.where(reached, log_predicted, 0.0)).T
    weights[~reached] = np.eye(len(weights))[~reached]
    return np.asarray(weights)
