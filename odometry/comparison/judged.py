"""Windows over which models are judged."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.comparison.parts import Part, windows_of_parts
from odometry.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.windows import Windows


@dataclass(frozen=True)
class JudgedWindows:
    """K distinct windows of one part, each of one evaluation horizon.

    Attributes
    ----------
    windows : Windows
    mean_speeds_m_s : (K, 2)
        v_left, v_right averaged over the time of each window.
    """

    windows: Windows
    mean_speeds_m_s: FloatArray

    def __len__(self) -> int:
        return len(self.windows)


def judged_windows(part: Part, horizon_m: float, training: WindowConfig) -> JudgedWindows:
    """Distinct windows of a horizon; they may straddle changes of `window`, but no gaps.

    A recording whose poses were chained every 2 s has hardly any window inside one chain. The
    errors at the joints are the same for every model, so that differences of models stand.

    Parameters
    ----------
    part : Part
    horizon_m : float
        Wheel travel.
    training : WindowConfig
        Says what a gap is.

    Raises
    ------
    WindowError
        If there is no such window.
    """
    config = replace(training, horizon_m=horizon_m, horizon_s=0.0, stride=1.0, shortest=1.0)
    whole = replace(part, run=_as_one_chain(part.run))
    windows = windows_of_parts([whole], config)
    return JudgedWindows(windows, _mean_speeds(windows))


def _as_one_chain(run: Run) -> Run:
    if run.pose is None or "window" not in run.pose:
        return run
    columns = {name: column for name, column in run.pose.columns.items() if name != "window"}
    return replace(run, pose=replace(run.pose, columns=columns))


def _mean_speeds(windows: Windows) -> FloatArray:
    duration_s = _sums(windows, windows.steps_s)
    moved = windows.inputs.tread_speeds_m_s * windows.steps_s[:, None]
    return np.stack([_sums(windows, side) / duration_s for side in moved.T], axis=-1)


def _sums(windows: Windows, values: FloatArray) -> FloatArray:
    """Sum of values (N,) over the samples in force in each window (K,)."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    return np.asarray(sums[windows.last] - sums[windows.first])
