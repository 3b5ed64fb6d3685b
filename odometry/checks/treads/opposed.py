"""Treads that turn against one another along most of the way, with nothing else to say so."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level

# Of the tread travel: up to 0.55 in drives that were made to identify slip, 0.05 in ordinary ones
MOST = 0.7
LEAST_TRAVEL_M = 5.0


def opposed(evidence: Evidence) -> Iterator[Finding]:
    """One side may count backwards: without a gyroscope and poses only the way it drives tells."""
    if evidence.yaw_rate is not None or evidence.positions_measured is not None:
        return
    m = evidence.uniform
    travel_m = np.abs(m.left_m) + np.abs(m.right_m)
    whole_m = float(np.nansum(travel_m))
    share = float(np.nansum(travel_m[m.left_m * m.right_m < 0])) / max(whole_m, 1e-9)
    if whole_m < 2 * LEAST_TRAVEL_M or share < MOST:
        return
    yield Finding(
        "treads_opposed",
        Level.WARNING,
        f"v_left and v_right have opposite signs in {100 * share:.0f} % of the tread travel: by "
        "them the robot turns on the spot nearly all the time",
        "The encoder of one side counts backwards (motors that are mounted mirrored), or the robot "
        "did spin: without a gyroscope and poses these cannot be distinguished",
        "Drive straight on by hand and see that both columns have the same sign; an import takes "
        "--left-sign -1 or --right-sign -1. Record a gyroscope as well",
    )
