"""What noise of the recorded tread speeds adds to the chi-squared of a hypothesis.

An effect may explain nothing and still fit better because it keeps this noise out of the motion:
a saturated drive has one speed whatever the encoders say, and a robot that hardly turns for its
treads does not follow their difference.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.gap.fit import Fitted
from odometry.gap.measured import Measured
from odometry.run import Run
from odometry.windows.dense import DenseWindows

SEED = 0
ORDER = 3  # of differences: a speed that changes steadily leaves none
DIFFERENCE = np.sqrt(20.0)  # of white noise of 1, deviation of its differences of this order
NORMAL = 0.6745  # of a normal variable, the median of its size


def tread_noise_m_s(run: Run) -> FloatArray:
    """Standard deviation (2,) of white noise of both tread speeds, by their third differences."""
    columns = run.odometry.columns
    speeds = np.column_stack([columns["v_left"], columns["v_right"]])
    if len(speeds) <= ORDER:
        return np.zeros(2)
    median = np.median(np.abs(np.diff(speeds, n=ORDER, axis=0)), axis=0)
    return np.asarray(median / (NORMAL * DIFFERENCE))


def noisier(scene: DenseWindows, rng: np.random.Generator) -> DenseWindows:
    """The scene with as much noise of the tread speeds again, drawn for each recorded row."""
    stamps_s = scene.run.odometry.stamps_s - scene.run.odometry.stamps_s[0]
    drawn = tread_noise_m_s(scene.run) * rng.standard_normal((len(stamps_s), 2))
    travelled = np.cumsum(drawn[:-1] * np.diff(stamps_s)[:, None], axis=0)
    travelled = np.concatenate([np.zeros((1, 2)), travelled])
    at = np.column_stack([np.interp(scene.time_s, stamps_s, one) for one in travelled.T])
    steps_s = scene.steps_s[:, None]
    ahead = np.diff(at, axis=0, append=at[-1:])
    noise = np.divide(ahead, steps_s, out=np.zeros_like(ahead), where=steps_s > 0)
    speeds = scene.inputs.tread_speeds_m_s + noise
    return replace(scene, inputs=replace(scene.inputs, tread_speeds_m_s=speeds))


def noise_of_windows(fits: Sequence[Fitted], measured: Measured) -> list[FloatArray]:
    """Chi-squared (K,) of each window that noise of the tread speeds makes, of each fit."""
    rng = np.random.default_rng(SEED)
    again = replace(measured, scenes=tuple(noisier(scene, rng) for scene in measured.scenes))
    return [
        measured.by_window(again.rows(fit.base, fit.effects) - measured.rows(fit.base, fit.effects))
        for fit in fits
    ]
