"""Evidence of several windows, and calibrated probabilities."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.feel.assessment.scores import class_weights

TEMPERATURES = np.geomspace(0.5, 30.0, 40)
OUTLIERS = (0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3)
CORRELATIONS = (0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)


@dataclass(frozen=True)
class Calibration:
    """The weight of the evidence of windows.

    Attributes
    ----------
    temperatures : tuple of float
        By which the log likelihoods of a window are divided, one a kind of classifier.
    outliers : float
        Share of the windows without evidence on the terrain: every terrain is as probable then.
    correlation : float
        Of the evidence of windows of one run: n of them count as n / (1 + (n - 1) correlation).

    References
    ----------
    Guo et al. 2017, "On calibration of modern neural networks" (temperature). Kish 1965, "Survey
    sampling" (design effect).
    """

    temperatures: tuple[float, ...]
    outliers: float
    correlation: float

    def worth(self, windows: FloatArray) -> FloatArray:
        """How many independent windows so many windows, which do not overlap, count as."""
        return np.asarray(windows / (1 + (np.maximum(windows, 1.0) - 1) * self.correlation))

    def evidence(self, log_likelihoods: FloatArray) -> FloatArray:
        """Log of the probabilities of K terrains (N, K) by one window, each as probable before.

        From log likelihoods (N, F, K) by F kinds of classifiers. Bounded by the outliers: one
        window that errs cannot outvote many.
        """
        among = softmax((log_likelihoods / np.array(self.temperatures)[:, None]).sum(axis=1))
        return np.asarray(np.log((1 - self.outliers) * among + self.outliers / among.shape[1]))

    def probabilities(self, evidence: FloatArray, windows: FloatArray) -> FloatArray:
        """Of K terrains (N, K) from the mean `evidence` of so many windows (N,)."""
        return softmax(evidence * self.worth(np.asarray(windows, dtype=np.float64))[:, None])


@dataclass(frozen=True)
class Stretches:
    """Windows put together: N stretches of one run and terrain.

    Attributes
    ----------
    labels, runs, windows : (N,)
        Terrain, number of the run, and how many windows, without their overlap.
    evidence : (N, K)
        Mean over its windows.
    novelty : (N,)
        Mean over its windows, see `held_out.Scores`.
    offsets : (N, K, C)
        The same.
    """

    labels: AnyArray
    runs: IntArray
    windows: FloatArray
    evidence: FloatArray
    novelty: FloatArray
    offsets: FloatArray

    def __len__(self) -> int:
        return len(self.labels)


def gathered(windows: Stretches, parts: IntArray, steps: int) -> Stretches:
    """Put windows of equal parts (W,) together; `steps` windows overlap to the length of one."""
    _, first, places, counts = np.unique(
        parts, return_index=True, return_inverse=True, return_counts=True
    )
    return Stretches(
        windows.labels[first],
        windows.runs[first],
        np.maximum((counts + steps - 1) / steps, 1.0),
        _means(windows.evidence, places, counts),
        _means(windows.novelty, places, counts),
        _means(windows.offsets, places, counts),
    )


def _means(values: FloatArray, places: IntArray, counts: IntArray) -> FloatArray:
    sums = np.zeros((len(counts), *values.shape[1:]))
    np.add.at(sums, places, values)
    return np.asarray((sums.T / counts).T)


def stretch_numbers(
    begins_s: FloatArray, runs: IntArray, labels: AnyArray, stretch_s: float
) -> IntArray:
    """Number (W,) of the stretch of each window: of one run and terrain, one after another."""
    _, terrain = np.unique(labels.astype(str), return_inverse=True)
    _, of_run = np.unique(runs, return_inverse=True)
    first_s = np.full(of_run.max() + 1, np.inf)
    np.minimum.at(first_s, of_run, begins_s)
    after = np.floor((begins_s - first_s[of_run]) / stretch_s + 1e-9).astype(np.int64)
    keys = np.column_stack([of_run, terrain, after])
    return np.asarray(np.unique(keys, axis=0, return_inverse=True)[1]).ravel()


def calibrated_windows(
    log_likelihoods: FloatArray, labels: AnyArray, names: tuple[str, ...]
) -> tuple[float, Calibration]:
    """Temperatures and outliers by windows (W, F, K).

    Each kind of classifier is brought to its own temperature; then all have one more in common.

    Returns
    -------
    (float, Calibration)
        The least Brier score, every terrain with the same weight, and what has it.
    """
    codes, weights = _codes(labels, names), class_weights(labels)
    own = [_best(one, codes, weights)[1] for one in np.moveaxis(log_likelihoods, 1, 0)]
    joined = (log_likelihoods / np.array(own)[:, None]).sum(axis=1)
    loss, temperature, outliers = _best(joined, codes, weights)
    return loss, Calibration(tuple(temperature * one for one in own), outliers, 0.0)


def _best(
    log_likelihoods: FloatArray, codes: IntArray, weights: FloatArray
) -> tuple[float, float, float]:
    """The least Brier score of windows (W, K), with its temperature and outliers."""
    found, true = list[tuple[float, float, float]](), np.eye(log_likelihoods.shape[1])[codes]
    shares = np.array(OUTLIERS)
    for temperature in TEMPERATURES.tolist():
        plain = softmax(log_likelihoods / temperature)
        off, flatter = plain - true, 1 / plain.shape[1] - plain
        terms = [
            weights @ (one * other).sum(axis=1)
            for one, other in ((off, off), (off, flatter), (flatter, flatter))
        ]
        scores = terms[0] + 2 * shares * terms[1] + shares**2 * terms[2]  # of off + share * flatter
        found += [(one, temperature, of) for one, of in zip(scores.tolist(), OUTLIERS, strict=True)]
    return min(found)


def _brier(probabilities: FloatArray, codes: IntArray, weights: FloatArray) -> float:
    """Brier 1950, "Verification of forecasts expressed in terms of probability", eq. 2.

    A few windows that err while sure decide the log loss, but not this.
    """
    true = np.eye(probabilities.shape[1])[codes]
    return float(weights @ ((probabilities - true) ** 2).sum(axis=1))


def calibrated_stretches(
    windows: Calibration, stretches: Stretches, names: tuple[str, ...]
) -> tuple[float, Calibration]:
    """The correlation by stretches whose evidence `windows` gave; the same return."""
    codes, weights = _codes(stretches.labels, names), class_weights(stretches.labels)
    tried = list[tuple[float, Calibration]]()
    for correlation in CORRELATIONS:
        one = replace(windows, correlation=correlation)
        among = one.probabilities(stretches.evidence, stretches.windows)
        tried.append((_brier(among, codes, weights), one))
    return min(tried, key=lambda pair: pair[0])


def _codes(labels: AnyArray, names: tuple[str, ...]) -> IntArray:
    return np.asarray(np.searchsorted(names, labels.astype(str)))


def softmax(values: FloatArray) -> FloatArray:
    """Rows (N, K) as probabilities."""
    raised = np.exp(values - values.max(axis=1, keepdims=True))
    return np.asarray(raised / raised.sum(axis=1, keepdims=True))
