"""Multinomial logistic regression on columns from which the effect of speed is taken out."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from odometry.arrays import FloatArray, IntArray
from odometry.feel.classifier.discriminant import Pooled, fitted_discriminant

RIDGE = 0.01  # on the weights of standardised columns, beside the mean loss of a window
MOST_STEPS = 100


@dataclass(frozen=True)
class Logistic:
    """K classes in d columns and q covariates.

    Attributes
    ----------
    weights : (d + q, K)
    levels : (K,)
        Log likelihoods where all columns are zero, up to what is common to the classes.
    """

    weights: FloatArray
    levels: FloatArray

    def log_likelihoods(self, table: FloatArray) -> FloatArray:
        """Of W windows (W, d + q), (W, K), up to what is common to the classes."""
        return np.asarray(table @ self.weights + self.levels)


def fitted_logistic(
    table: FloatArray, codes: IntArray, shares: FloatArray, of: Pooled, covariates: int
) -> Logistic:
    """Fit to W windows.

    Parameters
    ----------
    table : (W, d + q)
        Without NaN.
    codes : (W,)
        The class of each, 0 to K - 1.
    shares : (W,)
        What each counts for; they add up to 1.
    of : Pooled
        Of the same windows: how columns depend on covariates, and their spread.
    covariates : int
        q: so many last columns.

    References
    ----------
    Hastie, Tibshirani and Friedman 2009, "The elements of statistical learning", section 18.3.2.
    """
    plain = fitted_discriminant(of, covariates, 1.0)
    scale, size = np.diag(plain.whitening), len(plain.whitening)
    removed = np.vstack([np.eye(size), -plain.slopes]) * scale
    middle = plain.means.mean(axis=0) * scale
    standard = np.column_stack([np.ones(len(table)), table @ removed - middle])
    true, rows = np.eye(len(of.means))[codes], np.arange(len(codes))

    def loss(at: FloatArray) -> tuple[float, FloatArray]:
        weights = at.reshape(standard.shape[1], -1)
        raised = standard @ weights
        raised -= raised.max(axis=1, keepdims=True)
        likely = np.exp(raised)
        sums = likely.sum(axis=1)
        among = likely / sums[:, None]
        ridge = RIDGE * np.vstack([np.zeros(len(true[0])), weights[1:]])
        slopes = standard.T @ (shares[:, None] * (among - true)) + ridge
        own = raised[rows, codes] - np.log(sums)
        return float(-shares @ own + (ridge * weights).sum() / 2), slopes.ravel()

    start = np.zeros(standard.shape[1] * true.shape[1])
    steps = {"maxiter": MOST_STEPS}
    found = minimize(loss, start, jac=True, method="L-BFGS-B", options=steps).x
    weights = found.reshape(standard.shape[1], -1)
    return Logistic(removed @ weights[1:], weights[0] - middle @ weights[1:])
