"""How much more a window looks like those of terrains that a model does not know."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize
from scipy.special import expit

from odometry.arrays import BoolArray, FloatArray

RIDGE = 1e-2  # on the weights of standardised terms
LEAST = 1e-12  # added below logarithms
TERMS = 4
LEAST_SCALE = 0.3  # of a term: one that hardly varies gets no steep weight
SHARES = (0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5)  # the least one that keeps the two below
BOLD = 0.9  # probability of a known terrain which
MOST_BOLD = 0.05  # of the windows of a terrain left out may get


@dataclass(frozen=True)
class Strangeness:
    """What tells terrains that a model does not know.

    Attributes
    ----------
    window, stretch : (TERMS,)
        Weights of `terms`, of single windows and of stretches. Zeros: cannot be told.
    share : float
        How probable such a terrain is before anything is felt.
    """

    window: FloatArray
    stretch: FloatArray
    share: float

    @classmethod
    def none(cls) -> "Strangeness":
        """Where nothing is known of it."""
        return cls(np.zeros(TERMS), np.zeros(TERMS), SHARES[0])


@dataclass(frozen=True)
class Unseen:
    """Terms of N windows or stretches while one terrain was left out.

    Attributes
    ----------
    table : (N, TERMS)
    is_unseen : (N,)
        Whether each is of that terrain.
    weights : (N,)
        Half for both kinds, every terrain alike.
    sure : (N,)
        Greatest probability of the terrains that were not left out.
    """

    table: FloatArray
    is_unseen: BoolArray
    weights: FloatArray
    sure: FloatArray


def terms(probabilities: FloatArray, novelty: FloatArray, nearness: FloatArray) -> FloatArray:
    """What grows with strangeness (N, TERMS), from probabilities (N, K) and distances (N,).

    A constant, the distance in all columns, that in the space of the discriminants, and the doubt
    among the known terrains.
    """
    doubt = -np.log(probabilities.max(axis=1) + LEAST)
    return np.column_stack([np.ones(len(doubt)), np.log(novelty + LEAST), nearness, doubt])


def fitted_weights(parts: Sequence[Unseen]) -> FloatArray:
    """Log odds of "never felt", both as probable before: a logistic regression, none falling.

    Parameters
    ----------
    parts : sequence of Unseen
        One a terrain that was left out; they count alike.

    Returns
    -------
    (TERMS,)
    """
    table = np.concatenate([part.table for part in parts])
    sign = np.concatenate([np.where(part.is_unseen, 1.0, -1.0) for part in parts])
    weights = np.concatenate([part.weights / part.weights.sum() for part in parts]) / len(parts)
    mean, scale = weights @ table, np.sqrt(weights @ (table - weights @ table) ** 2)
    mean[0], scale[0] = 0.0, 1.0
    scale = np.maximum(scale, LEAST_SCALE)
    standard = (table - mean) / scale

    def loss(at: FloatArray) -> tuple[float, FloatArray]:
        left = sign * (standard @ at)
        slope = -weights * sign / (1 + np.exp(np.clip(left, -500, 500)))
        ridge = RIDGE * np.append(0.0, at[1:])
        value = weights @ np.logaddexp(0.0, -left) + ridge[1:] @ at[1:] / 2
        return float(value), standard.T @ slope + ridge

    bounds = [(None, None), *[(0.0, None)] * (TERMS - 1)]
    found = minimize(loss, np.zeros(TERMS), jac=True, method="L-BFGS-B", bounds=bounds).x / scale
    found[0] -= found[1:] @ mean[1:]
    return np.asarray(found)


def modest_share(parts: Sequence[Unseen], weights: FloatArray) -> float:
    """The least of SHARES with which at most MOST_BOLD of what is unseen gets BOLD or more."""

    def bold(share: float) -> float:
        found = []
        for part in parts:
            unknown = unknown_probability(part.table @ weights, share)
            named = part.sure * (1 - unknown) >= BOLD
            found.append(named[part.is_unseen].mean())
        return float(np.mean(found))

    return next((one for one in SHARES if bold(one) <= MOST_BOLD), SHARES[-1])


def unknown_probability(log_odds: FloatArray, share: float) -> FloatArray:
    """Probability (N,) of "never felt" where it was as probable as `share` before."""
    return np.asarray(expit(log_odds + np.log(share / (1 - share))))
