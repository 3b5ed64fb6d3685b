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


def expected_error_if_calibrated(
    probabilities: FloatArray, groups: AnyArray, seed: int = 0
) -> float:
    """The expected calibration error to expect of probabilities that are exactly right.

    It is not zero: few answers in a tenth are right in another share than their probability by
    chance alone. Answers are drawn 200 times, right with their own probability; those of a group
    are drawn together, by one number, so that they are right and wrong as a whole.

    Parameters
    ----------
    probabilities : FloatArray, shape (n, classes)
    groups : array, shape (n,)
        All different where answers are independent; photographs where their patches are alike.
    seed : int
    """
    confidence = probabilities.max(axis=1)
    _, group = np.unique(groups, return_inverse=True)
    rng = np.random.default_rng(seed)
    errors = []
    for _ in range(DRAWS):
        right = rng.random(int(group.max()) + 1)[group] < confidence
        answers = np.where(right, probabilities.argmax(axis=1), -1)
        errors.append(reliability(answers, probabilities).expected_error)
    return float(np.mean(errors))
