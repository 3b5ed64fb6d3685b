"""Spans of time: in which something holds, and which others touch."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray


def runs_of(flags: BoolArray) -> IntArray:
    """First row and row after the last (R, 2) of each unbroken run of True."""
    edges = np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8))
    return np.stack([np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)], axis=-1)


def constant_spans(stamps_s: FloatArray, values: FloatArray, least_s: float) -> FloatArray:
    """Stamps (R, 2) between which rows (N,) or (N, D) repeat the same values for so long."""
    values = values.reshape(len(stamps_s), -1)
    same = (np.diff(values, axis=0) == 0).all(axis=1)
    found = runs_of(same)
    if not len(found):
        return np.empty((0, 2))
    spans = np.stack([stamps_s[found[:, 0]], stamps_s[found[:, 1]]], axis=-1)
    return np.asarray(spans[spans[:, 1] - spans[:, 0] >= least_s])


def within(at_s: FloatArray, spans_s: FloatArray) -> BoolArray:
    """Whether each stamp (K,) lies in one of the spans (R, 2)."""
    inside = np.zeros(len(at_s), dtype=np.bool_)
    for begin_s, end_s in spans_s:
        inside |= (at_s >= begin_s) & (at_s <= end_s)
    return inside


def touched(spans_s: FloatArray, begin_s: FloatArray, end_s: FloatArray) -> BoolArray:
    """Whether any of the spans (G, 2), in order and apart, overlaps each time (K,) to (K,)."""
    ended = np.searchsorted(spans_s[:, 1], begin_s, side="right")
    begun = np.searchsorted(spans_s[:, 0], end_s, side="left")
    return np.asarray(begun > ended)
