"""Windows of one terrain: as long as asked, or shorter where there are too few of these."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.effects.corrected import Added
from odometry.effects.measured import on_measurement, robot_run
from odometry.errors import IdentificationError, WindowError
from odometry.identification.stretch_fit import windows_or_stretches
from odometry.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.stretches import Stretches
from odometry.windows.windows import Windows, windows_of

MORE = 1.2  # times the fewest windows are aimed at: gaps and sparse poses cost some
LEAST_S = 4.0  # of a window: slip that wanders over seconds is no scatter of shorter ones


def windows_of_any(runs: Sequence[Run], config: WindowConfig) -> Windows | Stretches:
    """`windows_or_stretches`, of a shorter horizon where no run is as long as one.

    Raises
    ------
    WindowError, IdentificationError
        See `windows_or_stretches`.
    """
    try:
        return windows_or_stretches(runs, config)
    except WindowError:
        travel_m = sum(float(run.wheel_travel_m[-1]) for run in runs)
        lasted_s = sum(float(np.ptp(run.odometry.stamps_s)) for run in runs)
        if not _may_be_shorter(config) or travel_m == 0:
            raise
        return windows_or_stretches(runs, _for_travel(travel_m, lasted_s, config))


def windows_on(
    terrain: str,
    effects: Sequence[Added],
    runs: Sequence[Run],
    as_measured: Windows | Stretches,
    config: WindowConfig,
) -> tuple[Windows | Stretches, WindowConfig]:
    """Windows on one terrain, and the settings by which they were cut.

    With the poses of the robot where the sensor reports others.

    Parameters
    ----------
    terrain : str
    effects : sequence of Added
        Of the model.
    runs : sequence of Run
    as_measured : Windows or Stretches
        Of the runs, cut by `config`.
    config : WindowConfig

    Raises
    ------
    IdentificationError
        If effects on the measured pose meet positions alone.
    """
    windows = as_measured
    if on_measurement(effects):
        if isinstance(windows, Stretches):
            raise IdentificationError(
                f"[{terrain}] the set has effects on the measured pose, which are undone where yaw "
                "was measured; pose.csv has positions alone: state [sensors] pose instead"
            )
        runs = [robot_run(run, effects) for run in runs]
        windows = windows_of(runs, config)
    here = windows.where(windows.terrain == terrain)
    if isinstance(here, Stretches):
        return here, config
    return enough_of(here, terrain, runs, config)


def enough_of(
    windows: Windows, terrain: str, runs: Sequence[Run], config: WindowConfig
) -> tuple[Windows, WindowConfig]:
    """The windows (K,) of a terrain, or more and shorter ones where these are too few."""
    if len(windows) >= config.fewest_windows or not _may_be_shorter(config):
        return windows, config
    lasted_s = float(windows.integrated(np.ones_like(windows.steps_s)).sum())
    shorter = _for_travel(float(windows.travel_m.sum()), lasted_s, config)
    found = windows_of(runs, shorter)
    found = found.where(found.terrain == terrain)
    return (found, shorter) if len(found) > len(windows) else (windows, config)


def _may_be_shorter(config: WindowConfig) -> bool:
    return config.fewest_windows > 0 and not config.horizon_s


def _for_travel(travel_m: float, lasted_s: float, config: WindowConfig) -> WindowConfig:
    """Windows so short that there are enough, and no shorter than LEAST_S on average."""
    most = lasted_s * min(config.stride, 1.0) / LEAST_S
    horizon_m = travel_m * min(config.stride, 1.0) / min(MORE * config.fewest_windows, most)
    return replace(config, horizon_m=min(horizon_m, config.horizon_m))


def shortened(windows: Windows | Stretches, asked_m: float, taken_m: float) -> str:
    """That windows are shorter than asked, and why; "" where they are not."""
    if taken_m >= asked_m:
        return ""
    return (
        f"windows are {taken_m:.2g} m long, not {asked_m:g} m, of which the runs have too few to "
        f"show how far parameters scatter; there are {len(windows)} now (--horizon states another)"
    )
