"""How much more probable a terrain that a model does not know is, by how far windows are."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize
from scipy.special import expit

from odometry.arrays import BoolArray, FloatArray

LENGTHS = ("window", "stretch", "run")
RIDGE = 1e-2  # on the weight of the standardised distance
LEAST = 1e-12  # added below logarithms
TERMS = 2
LEAST_SCALE = 0.3  # of the distance: one that hardly varies gets no steep weight
SHARES = (0.1, 0.15, 0.2, 0.25, 0.3, 0.35)  # with more, nothing is named where no distance helps
SURE = 0.6  # probability from which a terrain is named, which
MOST_NAMED = 0.3  # of what is of a terrain left out may get; see tests/studies/feel.md


@dataclass(frozen=True)
class Strangeness:
    """What distinguishes terrains that a model does not know.

    Attributes
    ----------
    weights : Mapping of str to (TERMS,)
        Weights of `terms` for each of LENGTHS. Zeros: cannot be distinguished.
    share : float
        Prior probability of such a terrain.
    """

    weights: Mapping[str, FloatArray]
    share: float

    @classmethod
    def none(cls) -> "Strangeness":
        """Where nothing is known of it."""
        return cls({name: np.zeros(TERMS) for name in LENGTHS}, SHARES[0])


@dataclass(frozen=True)
class Unseen:
    """Terms of N windows, stretches or runs while one terrain was left out.

    Attributes
    ----------
    table : (N, TERMS)
    is_unseen : (N,)
        Whether each is of that terrain.
    weights : (N,)
        Half for both kinds, with equal weights of terrains.
    sure : (N,)
        Greatest probability of the terrains that were not left out.
    """

    table: FloatArray
    is_unseen: BoolArray
    weights: FloatArray
    sure: FloatArray


def terms(farness: FloatArray) -> FloatArray:
    """A constant and the logarithm of the squared distance (N, TERMS), see `farness`."""
    return np.column_stack([np.ones(len(farness)), np.log(farness + LEAST)])


def farness(offsets: FloatArray) -> FloatArray:
    """Squared distance (N,) of the mean of windows to the nearest terrain.

    Parameters
    ----------
    offsets : (N, K, C)
        From each terrain in the space of discriminants, means over windows: what windows of one
        stretch have in common stays, while what differs between them averages out.
    """
    return np.asarray((offsets**2).sum(axis=2).min(axis=1))


def fitted_weights(parts: Sequence[Unseen]) -> FloatArray:
    """Log odds of "unknown" with equal priors: a logistic regression without negative weights.

    Parameters
    ----------
    parts : sequence of Unseen
        One a terrain that was left out; they have equal weights.

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


def modest_share(parts: Mapping[str, Sequence[Unseen]], weights: Mapping[str, FloatArray]) -> float:
    """The least of SHARES with which at most MOST_NAMED of what is unseen gets SURE or more.

    The mean over terrains left out and over LENGTHS, by `weights` of each length.
    """

    def named(share: float) -> float:
        found = []
        for length, of in parts.items():
            for part in of:
                unknown = unknown_probability(part.table @ weights[length], share)
                sure = part.sure * (1 - unknown) >= SURE
                found.append(sure[part.is_unseen].mean())
        return float(np.mean(found))

    return next((one for one in SHARES if named(one) <= MOST_NAMED), SHARES[-1])


def unknown_probability(log_odds: FloatArray, share: float) -> FloatArray:
    """Probability (N,) of "unknown" with the prior `share`."""
    return np.asarray(expit(log_odds + np.log(share / (1 - share))))
