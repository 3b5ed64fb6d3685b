"""Windows that are shorter than the horizon, and why."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.windows.config import WindowConfig
from odometry.windows.left_out import (
    CHANGE_OF_TERRAIN,
    CHANGE_OF_WINDOW,
    ODOMETRY_GAP,
    POSE_GAP,
    UNKNOWN_TURNS,
)
from odometry.windows.stretches import Stretches
from odometry.windows.windows import Windows

FEW = 0.5  # share of the windows that may be shorter without a note
WHY = {
    CHANGE_OF_WINDOW: "`window` of pose.csv changes that often: its poses are chained in short "
    "stretches, and the motion from one to the next is less certain",
    POSE_GAP: "pose.csv has gaps that often",
    ODOMETRY_GAP: "odometry.csv has gaps that often",
    CHANGE_OF_TERRAIN: "the terrain changes that often",
    UNKNOWN_TURNS: "poses are so sparse that the whole turns between them cannot be counted",
}


def short_windows(windows: Windows | Stretches, config: WindowConfig) -> str:
    """How many windows are shorter than the horizon, and what cuts them; "" where few are.

    Stretches of positions are as long as they have to be.
    """
    if isinstance(windows, Stretches):
        return ""
    wanted, unit, length = config.horizon_m, "m", windows.travel_m
    if config.horizon_s:
        wanted, unit, length = config.horizon_s, "s", _durations_s(windows)
    short = length < wanted * (1 - 1e-9)
    if short.mean() <= FEW:
        return ""
    cuts = [reason for reason, _ in windows.left_out.most_common() if reason in WHY]
    why = WHY[cuts[0]] if cuts else "the runs have no more"
    return (
        f"{short.sum()} of {len(windows)} windows are shorter than the {wanted:g} {unit} of the "
        f"horizon ({length[short].mean():.2f} {unit} on average): {why}. No window goes across "
        "such a place; a longer --horizon changes nothing"
    )


def _durations_s(windows: Windows) -> FloatArray:
    """How long each window (K,) lasts."""
    elapsed_s = np.concatenate([[0.0], np.cumsum(windows.steps_s)])
    return np.asarray(elapsed_s[windows.last] - elapsed_s[windows.first])
