"""Stretches of one label without a gap."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray

LONG = 5.0  # periods from which a step is a gap


def stretches_by_label(stamps_s: FloatArray, labels: AnyArray) -> Iterator[tuple[str, IntArray]]:
    """Label and rows of each stretch in order; stamps (N,), labels (N,)."""
    steps = np.diff(stamps_s)
    gap = steps > LONG * np.median(steps) if len(steps) else np.zeros(0, dtype=np.bool_)
    cuts = np.flatnonzero((labels[1:] != labels[:-1]) | gap) + 1
    for rows in np.split(np.arange(len(stamps_s)), cuts):
        yield str(labels[rows[0]]), rows
