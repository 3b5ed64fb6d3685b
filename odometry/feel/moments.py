"""Means and covariances of windows by run: all that a discriminant is fitted to."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray


@dataclass(frozen=True)
class Moments:
    """Of R parts, each the windows of one run on one terrain.

    Attributes
    ----------
    labels : (R,) of str
    runs : (R,)
        Number of the run of each part.
    means, covariances : (R, D), (R, D, D)
        Of the columns and then the covariates, within each part.
    """

    labels: AnyArray
    runs: IntArray
    means: FloatArray
    covariances: FloatArray

    def where(self, chosen: BoolArray) -> "Moments":
        """Some of the parts."""
        return Moments(
            self.labels[chosen], self.runs[chosen], self.means[chosen], self.covariances[chosen]
        )


def moments_of(table: FloatArray, labels: AnyArray, runs: IntArray) -> Moments:
    """Means and covariances of windows (W, D) by run and label; those without a part are none.

    NaN counts as the mean of the part, or of all where a part has no number.
    """
    parts = sorted(set(zip(runs.tolist(), labels.tolist(), strict=True)))
    usual = means_of(table)
    means, covariances = [], []
    for run, label in parts:
        rows = table[(runs == run) & (labels == label)]
        there = np.isfinite(rows)
        mean = np.where(there.any(axis=0), means_of(rows), usual)
        left = np.where(there, rows, mean) - mean
        means.append(mean)
        covariances.append(left.T @ left / len(rows))
    return Moments(
        np.array([label for _, label in parts], dtype=object),
        np.array([run for run, _ in parts]),
        np.stack(means),
        np.stack(covariances),
    )


def means_of(table: FloatArray) -> FloatArray:
    """Mean (D,) of the numbers of each column; 0 without one."""
    there = np.isfinite(table)
    return np.asarray(np.where(there, table, 0.0).sum(axis=0) / np.maximum(there.sum(axis=0), 1))
