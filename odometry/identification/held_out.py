"""Errors of a fitted model on windows that did not take part in its fit."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.geometry.angles import wrap
from odometry.identification.fit import Fit
from odometry.identification.motion import window_motion
from odometry.identification.windows import Windows
from odometry.models.base import KinematicModel


@dataclass(frozen=True)
class WindowErrors:
    """Errors of K windows per metre of wheel travel.

    Attributes
    ----------
    translation_per_m : (K,)
        Distance between predicted and measured end, metres per metre.
    rotation_per_m : (K,)
        Absolute difference of the turns, rad per metre.
    """

    translation_per_m: FloatArray
    rotation_per_m: FloatArray


def window_errors(model: KinematicModel, values: FloatArray, windows: Windows) -> WindowErrors:
    """Errors of a model over windows (CONVENTIONS, "Horizons and errors")."""
    error = window_motion(model, values, windows) - windows.measured
    return WindowErrors(
        np.hypot(error[:, 0], error[:, 1]) / windows.travel_m,
        np.abs(wrap(error[:, 2])) / windows.travel_m,
    )


def parts_of(windows: Windows) -> IntArray:
    """Parts (K,) to hold out in turn: the runs, or the two halves of the only run."""
    runs = list(dict.fromkeys(windows.run))
    if len(runs) > 1:
        return np.array([runs.index(run) for run in windows.run])
    return (np.arange(len(windows)) >= len(windows) / 2).astype(np.int64)


def held_out_errors(
    windows: Windows, parts: IntArray, fit_to: Callable[[Windows], Fit]
) -> WindowErrors:
    """Errors of every window under the model fitted to the other parts.

    Parameters
    ----------
    windows : Windows
    parts : (K,)
    fit_to : callable
        From windows to a fit.
    """
    translation, rotation = np.empty(len(windows)), np.empty(len(windows))
    for part in np.unique(parts):
        here = parts == part
        fitted = fit_to(windows.where(~here))
        errors = window_errors(fitted.model, fitted.packed, windows.where(here))
        translation[here], rotation[here] = errors.translation_per_m, errors.rotation_per_m
    return WindowErrors(translation, rotation)
