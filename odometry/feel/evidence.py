"""Evidence of windows put together, and probabilities that are as often right as they say."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.feel.scores import class_weights

TEMPERATURES = np.geomspace(0.5, 30.0, 40)
OUTLIERS = (0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3)
LEAST = 1e-12  # probability, below a logarithm
CORRELATIONS = (0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)


@dataclass(frozen=True)
class Calibration:
    """How much the evidence of windows is worth.

    Attributes
    ----------
    temperature : float
        By which the log likelihoods of a window are divided.
    outliers : float
        Share of the windows that say nothing of the terrain: every terrain is as probable then.
    correlation : float
        Of the evidence of windows of one run: n of them count as n / (1 + (n - 1) correlation).

    References
    ----------
    Guo et al. 2017, "On calibration of modern neural networks" (temperature). Kish 1965, "Survey
    sampling" (design effect).
    """

    temperature: float
    outliers: float
    correlation: float

    def worth(self, windows: FloatArray) -> FloatArray:
        """How many independent windows so many windows, which do not overlap, count as."""
        return np.asarray(windows / (1 + (np.maximum(windows, 1.0) - 1) * self.correlation))

    def evidence(self, log_likelihoods: FloatArray) -> FloatArray:
        """Log of the probabilities of K terrains (N, K) by one window, each as probable before.

        Bounded by the outliers: one window that errs cannot outvote many.
        """
        told = softmax(log_likelihoods / self.temperature)
        return np.asarray(np.log((1 - self.outliers) * told + self.outliers / told.shape[1]))

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
    novelty, nearness : (N,)
        Means over its windows, see `held_out.Scores`.
    """

    labels: AnyArray
    runs: IntArray
    windows: FloatArray
    evidence: FloatArray
    novelty: FloatArray
    nearness: FloatArray

    def __len__(self) -> int:
        return len(self.labels)


def gathered(windows: Stretches, parts: IntArray, steps: int) -> Stretches:
    """Put windows of equal parts (W,) together; `steps` windows overlap to the length of one."""
    _, first, places, counts = np.unique(
        parts, return_index=True, return_inverse=True, return_counts=True
    )
    sums = np.zeros((len(counts), windows.evidence.shape[1]))
    np.add.at(sums, places, windows.evidence)
    return Stretches(
        windows.labels[first],
        windows.runs[first],
        np.maximum((counts + steps - 1) / steps, 1.0),
        sums / counts[:, None],
        np.bincount(places, weights=windows.novelty) / counts,
        np.bincount(places, weights=windows.nearness) / counts,
    )


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
    """Temperature and outliers by windows (W, K).

    Returns
    -------
    (float, Calibration)
        The least log loss, every terrain counting alike, and what has it.
    """
    codes, weights = _codes(labels, names), class_weights(labels)
    rows, best = np.arange(len(codes)), (np.inf, Calibration(1.0, OUTLIERS[0], 0.0))
    for temperature in TEMPERATURES.tolist():
        true = softmax(log_likelihoods / temperature)[rows, codes]
        for outliers in OUTLIERS:
            told = (1 - outliers) * true + outliers / log_likelihoods.shape[1]
            loss = float(-weights @ np.log(told))
            if loss < best[0]:
                best = loss, Calibration(temperature, outliers, 0.0)
    return best


def calibrated_stretches(
    windows: Calibration, stretches: Stretches, names: tuple[str, ...]
) -> tuple[float, Calibration]:
    """The correlation by stretches whose evidence `windows` gave; the same return."""
    codes, weights = _codes(stretches.labels, names), class_weights(stretches.labels)
    rows, tried = np.arange(len(codes)), list[tuple[float, Calibration]]()
    for correlation in CORRELATIONS:
        one = replace(windows, correlation=correlation)
        true = one.probabilities(stretches.evidence, stretches.windows)[rows, codes]
        tried.append((float(-weights @ np.log(true + LEAST)), one))
    return min(tried, key=lambda pair: pair[0])


def _codes(labels: AnyArray, names: tuple[str, ...]) -> IntArray:
    return np.asarray(np.searchsorted(names, labels.astype(str)))


def softmax(values: FloatArray) -> FloatArray:
    """Rows (N, K) as probabilities."""
    raised = np.exp(values - values.max(axis=1, keepdims=True))
    return np.asarray(raised / raised.sum(axis=1, keepdims=True))
