"""The span in which another factor between treads and way explains most more than one does."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.undo import TREADS
from odometry.checks.parts.edges import Columns, exact_span
from odometry.checks.parts.span import Span, best_rows

LEAST_SHARE = 0.1  # of the way in the span, and elsewhere
LEAST_WINDOWS = 15
PARTS = 120  # of the way, between which a span is looked for first
LEAST_M = 1e-3  # of the usual longest way or travel in a window: less has no factor


def scaled_span(evidence: Evidence) -> Span | None:
    """The span of another factor, with exact ends; None with too few windows.

    The logarithm of the factor is compared, each window by its way: one with both scales in it, or
    in which the robot slips, counts as one.
    """
    m, forward_m = evidence.motion, evidence.forward_m
    known = np.flatnonzero(_is_known(forward_m) & _is_known(m.mean_m))
    if len(known) < 2 * LEAST_WINDOWS:
        return None
    windows, way_m = m.rows(known), np.abs(forward_m[known])
    factors = np.log(way_m / np.abs(windows.mean_m))
    levels = _levels(factors, way_m)
    if levels is None:
        return None
    elsewhere, inside = (way_m * (factors - level) ** 2 for level in levels)
    gains = elsewhere - inside
    rows = best_rows(gains)
    if not (gains[slice(*rows)] > 0).any():
        return None
    ratio = float(np.exp(levels[1] - levels[0]))
    recorded = evidence.run.odometry.stack(*TREADS).T
    columns = Columns(evidence.stamps_s, recorded, ratio * recorded, 1 / ratio, np.inf)
    windows_s = np.stack([windows.start_s, windows.end_s], axis=-1)
    return exact_span(gains, windows_s, rows, columns)


def _is_known(way_m: FloatArray) -> BoolArray:
    sizes = np.abs(way_m)
    known = np.isfinite(sizes)
    longest_m = float(np.quantile(sizes[known], 0.5)) if known.any() else np.inf
    return np.asarray(known & (sizes > LEAST_M * longest_m))


def _levels(factors: FloatArray, weights: FloatArray) -> tuple[float, float] | None:
    """Mean of factors (K,) elsewhere, and in the span that explains most with one of its own."""
    way_m = np.append(0.0, np.cumsum(weights))
    edges = np.unique(np.searchsorted(way_m, np.linspace(0, way_m[-1], PARTS + 1)))
    way_m, summed_m = way_m[edges], np.append(0.0, np.cumsum(weights * factors))[edges]
    begin, end = np.triu_indices(len(edges), 1)
    share = (way_m[end] - way_m[begin]) / max(float(way_m[-1]), 1e-300)
    enough = (share > LEAST_SHARE) & (share < 1 - LEAST_SHARE)
    if not enough.any():
        return None
    begin, end = begin[enough], end[enough]
    inside = summed_m[end] - summed_m[begin], way_m[end] - way_m[begin]
    outside = summed_m[-1] - inside[0], way_m[-1] - inside[1]
    best = int(np.argmax(inside[0] ** 2 / inside[1] + outside[0] ** 2 / outside[1]))
    return float(outside[0][best] / outside[1][best]), float(inside[0][best] / inside[1][best])
