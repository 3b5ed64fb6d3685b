"""Windows over which models are judged, and the errors of a model there."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.comparison.parts import Part, windows_of_parts
from odometry.evaluation.open_loop import measured_poses
from odometry.identification.config import WindowConfig
from odometry.identification.motion import window_motion
from odometry.identification.windows import Windows
from odometry.models.base import KinematicModel
from odometry.run import Run


@dataclass(frozen=True)
class JudgedWindows:
    """K distinct windows of one part, each of one evaluation horizon.

    Attributes
    ----------
    windows : Windows
    turns_rad : (K,)
        Measured turns, not wrapped: a robot that spins turns by more than half a circle.
    mean_speeds_m_s : (K, 2)
        v_left, v_right averaged over the time of each window.
    """

    windows: Windows
    turns_rad: FloatArray
    mean_speeds_m_s: FloatArray

    def __len__(self) -> int:
        return len(self.windows)


@dataclass(frozen=True)
class Errors:
    """Errors of K windows per metre of wheel travel (CONVENTIONS, "Horizons and errors").

    Attributes
    ----------
    translation_per_m : (K,)
        Distance between predicted and measured end [m per m].
    rotation_per_m : (K,)
        Absolute difference of the turns [rad per m].
    """

    translation_per_m: FloatArray
    rotation_per_m: FloatArray


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
    IdentificationError
        If there is no such window.
    """
    config = replace(training, horizon_m=horizon_m, horizon_s=0.0, stride=1.0, shortest=1.0)
    whole = replace(part, run=_as_one_chain(part.run))
    windows = windows_of_parts([whole], config)
    last_s = windows.start_s + _sums(windows, windows.steps_s)
    return JudgedWindows(windows, _turns(part.run, windows.start_s, last_s), _mean_speeds(windows))


def judge(model: KinematicModel, values: FloatArray, judged: JudgedWindows) -> Errors:
    """Errors of a model with parameters (P,).

    Raises
    ------
    ParameterError
        If the model needs an input that was not recorded.
    """
    windows = judged.windows
    predicted = window_motion(model, values, windows)
    away = predicted[:, :2] - windows.measured[:, :2]
    return Errors(
        np.hypot(away[:, 0], away[:, 1]) / windows.travel_m,
        np.abs(predicted[:, 2] - judged.turns_rad) / windows.travel_m,
    )


def _as_one_chain(run: Run) -> Run:
    if run.pose is None or "window" not in run.pose:
        return run
    columns = {name: column for name, column in run.pose.columns.items() if name != "window"}
    return replace(run, pose=replace(run.pose, columns=columns))


def _turns(run: Run, first_s: FloatArray, last_s: FloatArray) -> FloatArray:
    """Measured turns (K,) between stamps of pose.csv, followed from pose to pose."""
    stamps_s, poses = measured_poses(run)
    yaw = np.unwrap(poses[:, 3])
    first, last = (np.interp(at_s, stamps_s, yaw) for at_s in (first_s, last_s))
    return np.asarray(last - first)


def _mean_speeds(windows: Windows) -> FloatArray:
    duration_s = _sums(windows, windows.steps_s)
    moved = windows.inputs.tread_speeds_m_s * windows.steps_s[:, None]
    return np.stack([_sums(windows, side) / duration_s for side in moved.T], axis=-1)


def _sums(windows: Windows, values: FloatArray) -> FloatArray:
    """Sum of values (N,) over the samples in force in each window (K,)."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    return np.asarray(sums[windows.last] - sums[windows.first])
