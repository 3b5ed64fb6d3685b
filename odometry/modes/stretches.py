"""Stretches of one label without a gap."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import AnyArray, IntArray
from odometry.run import Run
from odometry.windows.gaps import odometry_gaps


def stretches_by_label(run: Run, labels: AnyArray) -> Iterator[tuple[str, IntArray]]:
    """Label and rows of odometry.csv of each stretch in order; labels (N,)."""
    stamps_s = run.odometry.stamps_s
    gap = np.isin(stamps_s, odometry_gaps(run).spans_s[:, 1])
    cuts = np.flatnonzero((labels[1:] != labels[:-1]) | gap[1:]) + 1
    for rows in np.split(np.arange(len(stamps_s)), cuts):
        yield str(labels[rows[0]]), rows
