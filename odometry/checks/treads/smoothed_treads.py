"""Tread speeds that a filter has smoothed without a delay: the robot turns more sharply."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.statistics.least_squares import ordinary_fit
from odometry.checks.turns.measured_turns import MeasuredTurns, measured_turns

SMOOTHED_S = (0.7, 1.0, 1.4, 2.0, 2.8, 4.0)
GRID_S = 0.05
LEAST_WINDOWS = 60
# Ratio of the usual slope from row to row and over half of that time: 1.0 to 1.2 of speeds that
# were smoothed over it. Recorded ones have 1.0 to 1.2 as well where a robot starts gently.
SMOOTH, SPIKES = 1.2, 0.995
# What the treads leave of the turns, beside what their smoothed part lacks; and of turns that are
# smoothed as well. As shares of what is left as recorded; of treads that were smoothed 0.46 to 0.91
# and 0.01 to 0.67. Of 75 real recordings and 200 drives none has both where speeds are smooth.
SHARPER, ALIKE = 0.92, 0.8
# Of that part in the turns, as a ratio to the treads: 1 and more of what a mean takes. The median
# of parts of the drive: where terrain changes it explains turns by chance, of both signs.
GAINS, PARTS = (0.3, 4.0), 8


@dataclass(frozen=True)
class _Turns:
    """Windows (K) of measured turns, and integrals of the turn and of the treads on a grid."""

    columns: FloatArray
    turned_rad: FloatArray
    start_s: FloatArray
    end_s: FloatArray
    grid_s: FloatArray
    heading: FloatArray
    difference_m: FloatArray

    @classmethod
    def of(cls, evidence: Evidence, measured: MeasuredTurns) -> "_Turns | None":
        of, reach_s = measured.motion, SMOOTHED_S[-1] / 2
        begin_s, end_s = evidence.stamps_s[[0, -1]]
        known = np.isfinite(measured.target)
        within = known & (of.start_s > begin_s + reach_s) & (of.end_s < end_s - reach_s)
        if within.sum() < LEAST_WINDOWS:
            return None
        grid_s = np.arange(begin_s, end_s, GRID_S)
        turned_rad = np.append(0.0, np.cumsum(measured.target[known]))
        heading = np.interp(grid_s, np.append(begin_s, of.end_s[known]), turned_rad)
        of = of.rows(np.flatnonzero(within))
        difference_m = evidence.integrals.right_m(grid_s) - evidence.integrals.left_m(grid_s)
        return cls(
            np.stack([of.left_m, of.right_m, of.lasts_s]),
            measured.target[within],
            of.start_s,
            of.end_s,
            grid_s,
            heading,
            difference_m,
        )

    def smooth(self, values: FloatArray, over_s: float) -> FloatArray:
        """Change over each window (K,) of values (G,) on the grid, smoothed."""
        summed = np.append(0.0, np.cumsum((values[1:] + values[:-1]) / 2 * GRID_S))
        mean = [
            np.interp(at_s + over_s / 2, self.grid_s, summed)
            - np.interp(at_s - over_s / 2, self.grid_s, summed)
            for at_s in (self.start_s, self.end_s)
        ]
        return np.asarray((mean[1] - mean[0]) / over_s)


def smoothed_treads(evidence: Evidence) -> Iterator[Finding]:
    """Treads that turns fit far better when what smoothing took is added, or turns are smoothed.

    Treads that were measured are as sharp as the turns, or sharper: a robot follows them.
    """
    smooth = [over_s for over_s in SMOOTHED_S if _slopes(evidence, over_s) < SMOOTH]
    if not smooth:
        return
    turns = _Turns.of(evidence, next(measured_turns(evidence)))
    if turns is None:
        return
    plain, _ = ordinary_fit(turns.columns, turns.turned_rad)
    shares = [(of, over_s) for over_s in smooth if (of := _share(turns, plain, over_s))]
    if not shares:
        return
    share, over_s = min(shares)
    yield Finding(
        "smoothed_treads",
        Level.WARNING,
        f"the measured turns are sharper than those of the treads; averaged over {over_s:g} s they "
        f"fit the treads better ({100 * share:.0f} % of the squared differences are left)",
        f"Tread speeds are smoothed over some {over_s:g} s (a moving mean, a filter of the driver "
        "that looks ahead): they cut short what the robot did",
        "Log the speeds before they are smoothed",
    )


def _slopes(evidence: Evidence, over_s: float) -> float:
    """Usual slope of the tread speeds from row to row, as a ratio to that over half of a time."""
    speeds, stamps_s = evidence.speeds_m_s, evidence.stamps_s
    rows = max(round(over_s / 2 / evidence.period_s), 1)
    if len(speeds) < 3 * rows:
        return np.inf
    near, far = (
        (speeds[of:] - speeds[:-of]) / (stamps_s[of:] - stamps_s[:-of])[:, None] for of in (1, rows)
    )
    usual = [
        np.minimum(of**2, np.quantile(of**2, SPIKES, axis=0)).mean(axis=0) for of in (near, far)
    ]
    return float(np.sqrt(np.max(usual[0] / np.maximum(usual[1], 1e-300))))


def _share(turns: _Turns, plain: float, over_s: float) -> float | None:
    """Share that is left of smoothed turns; None where what the treads lack explains too little."""
    smoothed = turns.smooth(turns.heading, over_s)
    alike, _ = ordinary_fit(turns.columns, smoothed)
    if alike > ALIKE * plain:
        return None
    lack = turns.columns[1] - turns.columns[0] - turns.smooth(turns.difference_m, over_s)
    rows = np.vstack([turns.columns, lack])
    sharper, found = ordinary_fit(rows, turns.turned_rad)
    if sharper > SHARPER * plain:
        return None
    parts = np.array_split(np.arange(len(lack)), PARTS)
    gains = [ordinary_fit(rows[:, part], turns.turned_rad[part])[1][3] for part in parts]
    gain = float(np.median(gains) / ((found[1] - found[0]) / 2))
    return alike / plain if GAINS[0] < gain < GAINS[1] else None
