"""Windows of one terrain: as long as asked, or shorter where there are too few of these."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.identification.spread import FEWEST_WINDOWS
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.windows import Windows, windows_of

MORE = 1.2  # times the fewest windows are aimed at: gaps and sparse poses cost some
LEAST_S = 4.0  # of a window: slip that wanders over seconds is no scatter of shorter ones


def enough_of(
    windows: Windows, runs: Sequence[Run], config: WindowConfig
) -> tuple[Windows, WindowConfig]:
    """The windows (K,) of one terrain of the runs, or more and shorter ones if they are too few.

    Unless their horizon is stated. No shorter than LEAST_S on average; with the settings by which
    they are cut.
    """
    is_stated = bool(config.horizon_s) or config.horizon_m is not None
    if is_stated or not 0 < len(windows) < FEWEST_WINDOWS:
        return windows, config
    lasted_s = float(windows.integrated(np.ones_like(windows.steps_s)).sum())
    each = min(config.stride, 1.0)
    count = min(MORE * FEWEST_WINDOWS, lasted_s * each / LEAST_S)
    horizon_m = min(float(windows.travel_m.sum()) * each / count, config.travel_m)
    shorter = replace(config, horizon_m=horizon_m)
    found = windows_of(runs, shorter)
    found = found.where(found.terrain == windows.terrain[0])
    return (found, shorter) if len(found) > len(windows) else (windows, config)


def shortened(windows: Windows | Stretches, asked_m: float, taken_m: float) -> str:
    """That windows are shorter than asked, and why; "" where they are not."""
    if taken_m >= asked_m:
        return ""
    return (
        f"windows are {taken_m:.2g} m long, not {asked_m:g} m, of which the runs have too few to "
        f"show how far parameters scatter; there are {len(windows)} now (--horizon states another)"
    )
