"""Jumps of the reference: motion between poses that no robot makes, whatever its treads do.

A tread that slips leaves a robot behind by no more than the tread travelled; a pose that goes
farther, or aside, has jumped, if it also moves unlike just before and after: where an encoder drops
out, or a robot rolls on after its commands, poses go on as they did. What follows a jump is as good
as what went before.
"""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.simulate import residuals
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.dense.dense_noise import end_variance

STEP_S = 0.25  # over which a jump is looked for: maps do not all jump from one pose to the next
LEEWAY = 0.5  # share of the travel of treads by which a robot may go ahead of them, or aside


@dataclass(frozen=True)
class Jumps:
    """Steps of one run in which the reference jumped.

    Attributes
    ----------
    off : (M,) of bool
        Of each pose whether it ends such a step, or lies in it.
    stamps_s : (M,)
        Run time of the poses.
    distances_m : (J,)
        By which each of these steps is off the treads.
    sigmas : (J,)
        The same in standard deviations of noise, beyond what a robot may do.
    ends : (J, 2)
        First and last pose of each of these steps.
    steps : int
        How many steps there are.
    """

    off: BoolArray
    stamps_s: FloatArray
    distances_m: FloatArray
    sigmas: FloatArray
    ends: IntArray
    steps: int


def jumps(scene: DenseWindows, calibration: Calibration, config: GapConfig) -> Jumps:
    """Steps that no robot makes, of a run as the calibration drives it."""
    steps = _steps(scene)
    rows = residuals(calibration.base, (), steps)[:, 0]
    along = _along(steps.measured[:, 0, :2] - rows[:, :2], rows[:, :2])
    travel_m = np.diff(np.interp(steps.pose_s, steps.time_s, steps.travel_m)[steps.windows])[:, 0]
    behind = np.clip(along, -travel_m, 0.0)
    distances_m = np.hypot(*rows[:, :2].T)
    across_m2 = np.maximum(distances_m**2 - along**2, 0.0)
    beyond_m = np.sqrt((along - behind) ** 2 + across_m2) - LEEWAY * travel_m
    sigma_m = np.sqrt(end_variance(steps, calibration.noise)[:, :2].max(axis=1))
    sigmas = np.minimum(beyond_m, _apart_m(steps)) / sigma_m
    jumped = sigmas > config.outlier_sigmas
    off, ends = np.zeros(len(scene.pose_s), dtype=np.bool_), steps.windows[jumped]
    for begin, end in ends:
        off[begin + 1 : end + 1] = True
    return Jumps(off, scene.pose_s, distances_m[jumped], sigmas[jumped], ends, len(steps))


def _apart_m(steps: DenseWindows) -> FloatArray:
    """How far each step (S,) is from one between those before and after, at their velocities."""
    lasts_s = np.diff(steps.pose_s[steps.windows])[:, 0]
    velocities = steps.measured[:, 0, :2] / lasts_s[:, None]
    padded = np.pad(velocities, ((1, 1), (0, 0)), mode="reflect")
    before, after = padded[:-2], padded[2:]
    change = after - before
    lengths = np.maximum((change**2).sum(axis=1), np.finfo(float).tiny)
    share = np.clip(((velocities - before) * change).sum(axis=1) / lengths, 0.0, 1.0)
    between = before + share[:, None] * change
    return np.asarray(np.hypot(*(velocities - between).T) * lasts_s)


def _along(predicted: FloatArray, rows: FloatArray) -> FloatArray:
    """Part (S,) of residuals (S, 2) in the direction in which the treads go; 0 at rest."""
    lengths = np.hypot(*predicted.T)
    unit = predicted / np.where(lengths > 0, lengths, 1.0)[:, None]
    return np.asarray((rows * unit).sum(axis=1))


def _steps(scene: DenseWindows) -> DenseWindows:
    """Windows of two poses each, end to end, at least STEP_S long."""
    firsts, at = [], 0
    while at < len(scene.pose_s):
        firsts.append(at)
        at = int(np.searchsorted(scene.pose_s, scene.pose_s[at] + STEP_S - 1e-6))
    pairs = np.column_stack([firsts[:-1], firsts[1:]])
    return replace(scene.without_gyroscope(), windows=pairs)
