"""The row at which values change: those before are smooth as they are, those after undone."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.checks.parts.span import Span

SURE = 0.01  # of the largest gain: windows with less say nothing
SIDE = 0.03  # of what the span gains, that what is before or after it loses: else it says nothing
NEAR_S = 3.0  # of these windows, which slip or noise may have decided
ORDINARY = 0.9  # of the steps from row to row; the others are those of edges
SMALL = 1e-3  # of the usual largest value: no usual step is smaller


def exact_span(
    gains: FloatArray, windows_s: FloatArray, rows: tuple[int, int], columns: "Columns"
) -> Span:
    """The span of windows (K, 2) of time from a row to before another, with exact ends.

    An end lies between the nearest windows that say surely, by their gains (K,), that they are
    inside or outside; it is infinite where no window outside does.
    """
    sure = np.abs(gains) > SURE * np.abs(gains).max()
    inside = np.flatnonzero(sure & (gains > 0))
    inside = inside[(inside >= rows[0]) & (inside < rows[1])]
    least = SIDE * float(gains[inside].sum())
    first, last = inside[[0, -1]]
    before, after = (
        of if -gains[of].sum() > least else np.empty(0, dtype=np.int64)
        for of in (np.flatnonzero(sure[:first]), last + 1 + np.flatnonzero(sure[last + 1 :]))
    )
    rough = Span(
        float(windows_s[first, 0]) if len(before) else -np.inf,
        float(windows_s[last, 1]) if len(after) else np.inf,
    )
    begins, ends = columns.edges(rough)
    if len(before):
        begin_s = begins.stamp(windows_s[before[-1], 0] - NEAR_S, windows_s[first, 1] + NEAR_S)
        rough = replace(rough, begin_s=begin_s)
    if len(after):
        end_s = ends.stamp(windows_s[last, 0] - NEAR_S, windows_s[after[0], 1] + NEAR_S)
        rough = replace(rough, end_s=end_s)
    return rough


@dataclass(frozen=True)
class Columns:
    """Columns of a table in which a change may begin or end.

    Attributes
    ----------
    stamps_s : (N,)
    recorded, undone : (C, N)
    factor : float
        By which recorded values are larger than undone ones.
    period : float
        Of values that begin anew, as of an angle; infinite of others.
    """

    stamps_s: FloatArray
    recorded: FloatArray
    undone: FloatArray
    factor: float
    period: float

    def edges(self, rough: Span) -> tuple["Edge", "Edge"]:
        """Where the change begins, and where it ends, by how smooth values are in a rough span.

        Each step from row to row counts by its size in usual ones, as the logarithm of its
        likelihood; a change of unit spreads the steps by its factor.
        """
        mended = np.where(rough.holds(self.stamps_s), self.undone, self.recorded)
        steps = self._sizes(mended[:, :-1], mended[:, 1:])
        usual = np.stack([self._usual(*of) for of in zip(steps, mended, strict=True)])
        pairs = [(a, b) for a in (self.recorded, self.undone) for b in (self.recorded, self.undone)]
        plain, into, out, within = (
            np.nan_to_num(self._sizes(a[:, :-1], b[:, 1:]) / usual[:, None]).sum(axis=0)
            for a, b in pairs
        )
        spread = len(mended) * float(np.log(self.factor))
        into, within = into + spread, within + spread
        return Edge(self.stamps_s, plain, into, within), Edge(self.stamps_s, within, out, plain)

    def _sizes(self, of: FloatArray, to: FloatArray) -> FloatArray:
        off = to - of
        if np.isfinite(self.period):
            off = (off + self.period / 2) % self.period - self.period / 2
        return np.asarray(np.abs(off))

    @staticmethod
    def _usual(steps: FloatArray, values: FloatArray) -> float:
        steps, values = steps[np.isfinite(steps)], np.abs(values[np.isfinite(values)])
        if not len(steps):
            return 1.0
        ordinary = steps[steps <= np.quantile(steps, ORDINARY)]
        return max(float(ordinary.mean()), SMALL * float(np.quantile(values, ORDINARY)), 1e-12)


@dataclass(frozen=True)
class Edge:
    """Costs (N - 1,) of the steps to the next row: before a change, into it, and after."""

    stamps_s: FloatArray
    before: FloatArray
    across: FloatArray
    after: FloatArray

    def stamp(self, begin_s: float, end_s: float) -> float:
        """The stamp of the first row after the change, of those between two stamps."""
        first, last = np.searchsorted(self.stamps_s, [begin_s, end_s])
        steps: IntArray = np.arange(max(int(first) - 1, 0), min(int(last), len(self.before)))
        if not len(steps):
            return float(end_s)
        before, after = self.before[steps], self.after[steps]
        costs = np.cumsum(before) - before + self.across[steps] + after.sum() - np.cumsum(after)
        return float(self.stamps_s[steps[np.argmin(costs)] + 1])
