"""Errors of a model over windows."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.base import KinematicModel
from odometry.windows.stretches.stretch_motion import shape_errors
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.motion import window_motion
from odometry.windows.travel.windows import Windows


@dataclass(frozen=True)
class WindowErrors:
    """Errors of K windows per metre of wheel travel.

    Attributes
    ----------
    translation_per_m : (K,)
        Distance between predicted and measured end, metres per metre.
    rotation_per_m : (K,)
        Absolute difference of the turns, rad per metre; a robot may turn more than once.
    """

    translation_per_m: FloatArray
    rotation_per_m: FloatArray


def errors_over(
    model: KinematicModel, values: FloatArray, windows: Windows | Stretches
) -> WindowErrors:
    """`window_errors`, or those of the shapes of stretches (`stretch_motion.shape_errors`)."""
    if isinstance(windows, Stretches):
        return WindowErrors(*shape_errors(model, values, windows))
    return window_errors(model, values, windows)


def window_errors(model: KinematicModel, values: FloatArray, windows: Windows) -> WindowErrors:
    """Errors of a model with parameters (P,) over windows (data/README.md, Symbols and frame).

    Raises
    ------
    ParameterError
        If the model needs an input that was not recorded.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> windows = odometry.windows_of([run], odometry.WindowConfig())
    >>> ideal = odometry.model_named("differential_drive")
    >>> errors = odometry.window_errors(ideal, ideal.pack({"track_width": 0.4}), windows)
    >>> errors.translation_per_m.shape == (len(windows),)
    True
    """
    return errors_of_motion(window_motion(model, values, windows), windows)


def errors_of_motion(motion: FloatArray, windows: Windows) -> WindowErrors:
    """Errors of a predicted motion (K, 3) from the start to the end of each window."""
    error = motion - windows.measured
    return WindowErrors(
        np.hypot(error[:, 0], error[:, 1]) / windows.travel_m,
        np.abs(error[:, 2]) / windows.travel_m,
    )
