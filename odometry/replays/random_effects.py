"""One number measured in several runs that differ by more than their uncertainties."""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.stats import chi2
from scipy.stats import t as student

from odometry.arrays import FloatArray


class Dissent(NamedTuple):
    """How far one run lies from the others.

    Attributes
    ----------
    others : float
        Mean of the others.
    sigmas : float
        Difference in standard deviations of itself, of that mean, and of their spread.
    probability : float
        Of a difference as large where nothing is wrong.
    """

    others: float
    sigmas: float
    probability: float


def between_run_variance(values: FloatArray, variances: FloatArray) -> float:
    """Variance of the true values between runs, by the method of moments.

    Parameters
    ----------
    values, variances : (K,)
        What each run measured, and the variance of its error; K is 2 or more.

    Returns
    -------
    float
        0 where the runs differ by no more than their variances let expect.

    References
    ----------
    DerSimonian and Laird 1986, "Meta-analysis in clinical trials", eq. 8.
    """
    weights = 1 / variances
    mean = weights @ values / weights.sum()
    q = weights @ (values - mean) ** 2
    free = weights.sum() - weights @ weights / weights.sum()
    return max(0.0, float((q - (len(values) - 1)) / free))


def largest_between_run_variance(
    values: FloatArray, variances: FloatArray, sure: float = 0.9
) -> float:
    """Upper limit of the variance of the true values between runs.

    Few runs determine their spread poorly, and the estimate is often 0 by chance: predictions of
    another run take this limit.

    Parameters
    ----------
    values, variances : (K,)
        As in `between_run_variance`.
    sure : float
        Probability with which the true variance lies below.

    References
    ----------
    Viechtbauer 2007, "Confidence intervals for the amount of heterogeneity in meta-analysis",
    section 3.2 (Q-profile): the variance at which Cochran's Q is as small as it is in one of ten
    cases.
    """
    least = chi2.ppf(1 - sure, len(values) - 1)

    def excess(between: float) -> float:
        weights = 1 / (variances + between)
        mean = weights @ values / weights.sum()
        return float(weights @ (values - mean) ** 2 - least)

    if excess(0.0) <= 0:
        return 0.0
    beyond = float(np.sum((values - values.mean()) ** 2)) / least  # Q is below sum / variance
    return float(brentq(excess, 0.0, beyond))


def dissent(values: FloatArray, variances: FloatArray, which: int) -> Dissent:
    """Compare one run with the mean of the others, their spread included.

    The variance of the spread is itself estimated from K - 1 values: the probability is of
    Student's t with the degrees of freedom that this leaves.

    Parameters
    ----------
    values, variances : (K,)
        As in `between_run_variance`; K is 3 or more.
    which : int
        Place of the run.

    References
    ----------
    Satterthwaite 1946, "An approximate distribution of estimates of variance components", eq. 17.
    """
    others = np.delete(values, which)
    of_others = np.delete(variances, which)
    spread = between_run_variance(others, of_others)
    weights = 1 / (of_others + spread)
    mean = float(weights @ others / weights.sum())
    variance = float(variances[which] + spread + 1 / weights.sum())
    sigmas = float(abs(values[which] - mean) / np.sqrt(variance))
    share = spread * (1 + weights @ weights / weights.sum() ** 2) / variance
    freedom = (len(others) - 1) / share**2 if share > 1e-6 else np.inf
    return Dissent(mean, sigmas, float(2 * student.sf(sigmas, freedom)))
