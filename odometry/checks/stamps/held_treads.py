"""Tread speeds that are renewed far more rarely than they are logged."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level

# From which treads are late by held speeds, and from which a turn of a second has one value.
LONG_HOLD_S, MISLEADS_S = 0.3, 0.5
LEAST_HOLDS = 20
# Share of the new values that come in the row after another new one: of speeds that are renewed in
# each row, and rest at times, a third and more.
AT_ONCE = 0.05
ROWS = 2.5  # of the usual period, that a value lasts


def held_treads(evidence: Evidence) -> Iterator[Finding]:
    """Both speeds repeat their values from row to row, and change together now and then."""
    rows = np.flatnonzero((np.diff(evidence.speeds_m_s, axis=0) != 0).any(axis=1))
    if len(rows) < LEAST_HOLDS:
        return
    lasts_s = np.diff(evidence.stamps_s[rows + 1])
    moving = np.abs(evidence.speeds_m_s[rows[:-1] + 1]).max(axis=1) > 0
    if moving.sum() < LEAST_HOLDS or np.mean(np.diff(rows) == 1) > AT_ONCE:
        return
    usual_s = float(np.median(lasts_s[moving]))
    if usual_s < max(LONG_HOLD_S, ROWS * evidence.period_s):
        return
    yield Finding(
        "treads_held",
        Level.WARNING if usual_s > MISLEADS_S else Level.NOTE,
        f"v_left and v_right are renewed only every {usual_s:.2g} s and repeated in the rows "
        f"between ({evidence.period_s:.2g} s apart)",
        "The treads are read more slowly than they are logged: the log holds their last value, "
        "which is late; or they are commands, given so rarely",
        "Log the speeds that the wheels have, as often as they are read",
    )
