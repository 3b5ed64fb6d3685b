"""Speeds that the treads reach only later: commands, or stamps that are early."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence import Evidence
from odometry.checks.undo import TREADS, Mend, changed, in_turn, sooner
from odometry.run import Run

GRID_S = 0.02
CONSTANTS_S = (0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5)
CLEARLY = 0.7  # share of the residual squares that the better explanation leaves of the other's


def followed(constant_s: float) -> Mend:
    """Tread speeds through a lag of first order: what a drive makes of its commands."""
    return in_turn(*(_slower(name, constant_s) for name in TREADS))


def _slower(name: str, constant_s: float) -> Mend:
    def mend(run: Run) -> Run:
        stamps_s = run.odometry.stamps_s
        return changed("odometry", name, lambda values: _filtered(stamps_s, values, constant_s))(
            run
        )

    return mend


def _filtered(stamps_s: FloatArray, values: FloatArray, constant_s: float) -> FloatArray:
    """Values (N,) that hold, through a lag of first order, at their stamps."""
    reach_s = 6 * constant_s
    grid_s = np.arange(stamps_s[0] - reach_s, stamps_s[-1] + GRID_S, GRID_S)
    rows = np.clip(np.searchsorted(stamps_s, grid_s, side="right") - 1, 0, None)
    kernel = np.exp(-np.arange(0.0, reach_s, GRID_S) / constant_s)
    slow = np.convolve(values[rows], kernel / kernel.sum())[: len(grid_s)]
    return np.asarray(np.interp(stamps_s, grid_s, slow))


def commands_or_stamps(evidence: Evidence, early_s: float) -> tuple[str, Mend]:
    """Which of both explains treads that are early by so much, and what undoes it.

    Returns
    -------
    words : str
        "commands", "stamps", or "either" where neither explains clearly more.
    mend : callable of Run to Run
    """
    stamps = sooner(TREADS, -early_s)
    lags = [followed(constant_s) for constant_s in CONSTANTS_S if constant_s < 4 * early_s]
    left_by_stamps = _left(evidence, stamps)
    left, commands = min(((_left(evidence, mend), mend) for mend in lags), key=lambda pair: pair[0])
    if left < CLEARLY * left_by_stamps:
        return "commands", commands
    if left_by_stamps < CLEARLY * left:
        return "stamps", stamps
    return "either", commands if left < left_by_stamps else stamps


def _left(evidence: Evidence, mend: Mend) -> float:
    """Share of the turns that the treads do not explain."""
    mended = Evidence(mend(evidence.run), evidence.left_out_s)
    found = mended.gyroscope_by_treads or mended.pose_turn_by_treads
    return 1.0 if found is None else 1 - found.explained
