"""How long the windows are, chosen from the poses that there are."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.gap.config import GapConfig
from odometry.positions.heading import Headed
from odometry.run import Run
from odometry.windows.dense import covered_s

SHORTER = (1.0, 0.75, 0.5)  # of the usual duration of windows, where stretches ask for it
SLOWEST_M_S = 0.05  # of a mean speed: a stationary robot has no horizon


def for_chains(config: GapConfig, runs: Sequence[Run]) -> GapConfig:
    """Shorter windows where poses are chained in stretches that longer ones do not fit into.

    The longest of these that leaves out hardly more of the poses than the best one does.
    """
    tried_s = [share * config.horizon_s for share in SHORTER]
    covered = np.sum([covered_s(run, tried_s) for run in runs], axis=0)
    enough = covered >= config.least_covered * covered.max()
    return replace(config, horizon_s=tried_s[int(np.argmax(enough))])


def for_positions(config: GapConfig, headings: Headed) -> GapConfig:
    """Longer windows where positions without yaw are too noisy for short ones.

    At most half of a piece, so that pieces still hold windows.
    """
    speeds_m_s = [
        each.run.wheel_travel_m[-1] / np.ptp(each.run.odometry.stamps_s) for each in headings.found
    ]
    if not speeds_m_s:
        return config
    needed_s = headings.least_horizon_m / max(min(speeds_m_s), SLOWEST_M_S)
    return replace(config, horizon_s=max(config.horizon_s, min(needed_s, config.part_s / 2)))
