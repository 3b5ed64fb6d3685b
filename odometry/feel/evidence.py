"""Evidence of windows put together, and probabilities that are as often right as they say."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.feel.scores import class_weights

TEMPERATURES = np.geomspace(0.5, 30.0, 40)
OUTLIERS = (0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3)
CORRELATIONS = (0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)


@dataclass(frozen=True)
class Calibration:
    """How much the evidence of windows is worth.

    Attributes
    ----------
    temperature : float
        By which the log likelihoods of a window are divided.
    outliers : float
        Share of the answers that say nothing of the terrain: every terrain is as probable then.
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

    def probabilities(self, log_likelihoods: FloatArray, windows: FloatArray) -> FloatArray:
        """Of K terrains, each as probable as another before, from mean log likelihoods (N, K)."""
        scale = self.worth(np.asarray(windows, dtype=np.float64)) / self.temperature
        told = softmax(log_likelihoods * scale[:, None])
        return np.asarray((1 - self.outliers) * told + self.outliers / told.shape[1])


@dataclass(frozen=True)
class Stretches:
    """Windows put together: N stretches of one run and terrain.

    Attributes
    ----------
    labels, runs, windows : (N,)
        Terrain, number of the run, and how many windows, without their overlap.
    log_likelihoods : (N, K)
        Mean over its windows.
    novelty : (N,)
        Mean over its windows.
    """

    labels: AnyArray
    runs: IntArray
    windows: FloatArray
    log_likelihoods: FloatArray
    novelty: FloatArray

    def __len__(self) -> int:
        return len(self.labels)


def gathered(
    parts: IntArray,
    labels: AnyArray,
    runs: IntArray,
    scores: tuple[FloatArray, FloatArray],
    steps: int,
) -> Stretches:
    """Put windows of equal parts (W,) together; `steps` windows overlap to the length of one."""
    _, first, places, counts = np.unique(
        parts, return_index=True, return_inverse=True, return_counts=True
    )
    log_likelihoods, novelty = scores
    sums = np.zeros((len(counts), log_likelihoods.shape[1]))
    np.add.at(sums, places, log_likelihoods)
    return Stretches(
        labels[first],
        runs[first],
        np.maximum((counts + steps - 1) / steps, 1.0),
        sums / counts[:, None],
        np.bincount(places, weights=novelty) / counts,
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


def calibrated(
    windows: Stretches, stretches: Stretches, names: tuple[str, ...]
) -> tuple[float, Calibration]:
    """Temperature and outliers by windows, then the correlation by stretches.

    Returns
    -------
    (float, Calibration)
        The least log loss of windows, every terrain counting alike, and what has it.
    """
    ones = np.ones(len(windows))
    loss, best = min(
        (
            (log_loss(one.probabilities(windows.log_likelihoods, ones), windows, names), one)
            for one in (Calibration(t, o, 0.0) for t in TEMPERATURES.tolist() for o in OUTLIERS)
        ),
        key=lambda pair: pair[0],
    )
    both = [replace(best, correlation=one) for one in CORRELATIONS]
    losses = [
        log_loss(one.probabilities(stretches.log_likelihoods, stretches.windows), stretches, names)
        for one in both
    ]
    return loss, both[int(np.argmin(losses))]


def log_loss(probabilities: FloatArray, told: Stretches, names: tuple[str, ...]) -> float:
    """Mean of -log of the probability (N, K) of what is true, every terrain counting alike."""
    return float(class_weights(told.labels) @ losses_of(probabilities, told, names))


def losses_of(probabilities: FloatArray, told: Stretches, names: tuple[str, ...]) -> FloatArray:
    """-log (N,) of the probability (N, K) of what is true."""
    codes = np.searchsorted(names, told.labels.astype(str))
    return np.asarray(-np.log(probabilities[np.arange(len(codes)), codes]))


def softmax(values: FloatArray) -> FloatArray:
    """Rows (N, K) as probabilities."""
    raised = np.exp(values - values.max(axis=1, keepdims=True))
    return np.asarray(raised / raised.sum(axis=1, keepdims=True))
