"""Calibrated probabilities: one temperature, and the calibration error."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from odometry.arrays import AnyArray, FloatArray, IntArray

FLOOR = 0.01  # of a vote: no neighbour of a class does not make it impossible
TEMPERATURES = (0.1, 10.0)
BINS = 10
DRAWS = 200


def tempered(votes: FloatArray, temperature: float | None) -> FloatArray:
    """Sharpen or flatten probabilities; the most probable class stays the most probable.

    Parameters
    ----------
    votes : FloatArray, shape (n, classes)
        Rows add up to 1.
    temperature : float or None
        Above 1 they become less certain; None leaves them as they are.

    References
    ----------
    Guo, Pleiss, Sun and Weinberger 2017, "On calibration of modern neural networks", eq. 9, with
    the logarithm of the vote, on top of a floor, as the score.
    """
    if temperature is None:
        return votes
    raised = (votes + FLOOR) ** (1.0 / temperature)
    return np.asarray(raised / raised.sum(axis=1, keepdims=True))


def fitted_temperature(codes: IntArray, votes: FloatArray) -> float:
    """The temperature at which true classes (n,) are likeliest by votes (n, classes)."""

    def surprise(log_temperature: float) -> float:
        given = tempered(votes, float(np.exp(log_temperature)))
        return -float(np.log(given[np.arange(len(codes)), codes]).mean())

    bounds = tuple(np.log(TEMPERATURES))
    return float(np.exp(minimize_scalar(surprise, bounds=bounds, method="bounded").x))


@dataclass(frozen=True)
class Reliability:
    """How often answers are right, by how sure they were.

    Attributes
    ----------
    counts : IntArray, shape (10,)
        Answers whose probability is within each tenth.
    confidences, accuracies : FloatArray, shape (10,)
        Mean probability of the answers of each tenth, and the share that is right; NaN where
        there is none.
    """

    counts: IntArray
    confidences: FloatArray
    accuracies: FloatArray

    @property
    def expected_error(self) -> float:
        """Expected calibration error: mean of |accuracy - confidence| over answers (eq. 3)."""
        used = self.counts > 0
        gaps = np.abs(self.accuracies - self.confidences)[used]
        return float(self.counts[used] @ gaps / self.counts.sum())

    @property
    def mean_excess(self) -> float:
        """Mean probability of the answers less the share that is right: above 0, too sure."""
        used = self.counts > 0
        gaps = (self.confidences - self.accuracies)[used]
        return float(self.counts[used] @ gaps / self.counts.sum())


def reliability(codes: IntArray, probabilities: FloatArray) -> Reliability:
    """Sort the likeliest answers by their probability.

    Parameters
    ----------
    codes : IntArray, shape (n,)
    probabilities : FloatArray, shape (n, classes)

    References
    ----------
    Guo et al. 2017, section 2.
    """
    confidence, right = probabilities.max(axis=1), probabilities.argmax(axis=1) == codes
    bins = np.minimum((confidence * BINS).astype(int), BINS - 1)
    counts = np.bincount(bins, minlength=BINS)
    with np.errstate(invalid="ignore"):
        means = (np.bincount(bins, of, minlength=BINS) / counts for of in (confidence, right))
        return Reliability(counts, *means)


@dataclass(frozen=True)
class ReliabilityByChance:
    """How far off probabilities seem that are exactly right, by chance alone.

    Attributes
    ----------
    expected_error : float
        The expected calibration error, in the mean over draws.
    lowest, highest : FloatArray, shape (10,)
        Between which the share of right answers of each tenth lies in 95 % of the draws; NaN
        where there is no answer.
    """

    expected_error: float
    lowest: FloatArray
    highest: FloatArray


def reliability_by_chance(
    probabilities: FloatArray, groups: AnyArray, seed: int = 0
) -> ReliabilityByChance:
    """What to expect of the reliability of probabilities that are exactly right.

    Their calibration error is not zero: few answers in a tenth are right in another share than
    their probability by chance alone. Answers are drawn 200 times, right with their own
    probability; those of a group are drawn together, by one number, so that they are right and
    wrong as a whole.

    Parameters
    ----------
    probabilities : FloatArray, shape (n, classes)
    groups : array, shape (n,)
        All different where answers are independent; photographs where their patches are correlated.
    seed : int
    """
    confidence = probabilities.max(axis=1)
    _, group = np.unique(groups, return_inverse=True)
    rng = np.random.default_rng(seed)
    drawn = []
    for _ in range(DRAWS):
        right = rng.random(int(group.max()) + 1)[group] < confidence
        answers = np.where(right, probabilities.argmax(axis=1), -1)
        drawn.append(reliability(answers, probabilities))
    lowest, highest = np.quantile([each.accuracies for each in drawn], [0.025, 0.975], axis=0)
    expected = float(np.mean([each.expected_error for each in drawn]))
    return ReliabilityByChance(expected, lowest, highest)
