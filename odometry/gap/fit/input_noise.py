"""What noise of the recorded tread speeds adds to the chi-squared of a hypothesis.

An effect may explain nothing and still fit better because it keeps this noise out of the motion:
a saturated drive has one speed whatever the encoders say, and a robot that hardly turns for its
treads does not follow their difference.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.gap.fit.contest import cost_of
from odometry.gap.fit.fitter import Fitted
from odometry.gap.prepare.measured import Measured
from odometry.recording.run import Run
from odometry.windows.dense.dense import DenseWindows

SEED = 0
ORDER = 3  # of differences: a speed that changes steadily leaves none
DIFFERENCE = np.sqrt(20.0)  # of white noise of 1, deviation of its differences of this order
PART = 0.1  # of the noise
NORMAL = 0.6745  # of a normal variable, the median of its size
SURE = 1.645  # standard deviations of a lower bound of 95 %


def tread_noise_m_s(run: Run) -> FloatArray:
    """Standard deviation (2,) of white noise of both tread speeds, by their third differences."""
    columns = run.odometry.columns
    speeds = np.column_stack([columns["v_left"], columns["v_right"]])
    if len(speeds) <= ORDER:
        return np.zeros(2)
    median = np.median(np.abs(np.diff(speeds, n=ORDER, axis=0)), axis=0)
    return np.asarray(median / (NORMAL * DIFFERENCE))


def noisier(scene: DenseWindows, rng: np.random.Generator, times: float = 1.0) -> DenseWindows:
    """The scene with so many times its noise of the tread speeds again, drawn for each row."""
    stamps_s = scene.run.odometry.stamps_s - scene.run.odometry.stamps_s[0]
    drawn = times * tread_noise_m_s(scene.run) * rng.standard_normal((len(stamps_s), 2))
    travelled = np.cumsum(drawn[:-1] * np.diff(stamps_s)[:, None], axis=0)
    travelled = np.concatenate([np.zeros((1, 2)), travelled])
    at = np.column_stack([np.interp(scene.time_s, stamps_s, one) for one in travelled.T])
    steps_s = scene.steps_s[:, None]
    ahead = np.diff(at, axis=0, append=at[-1:])
    noise = np.divide(ahead, steps_s, out=np.zeros_like(ahead), where=steps_s > 0)
    speeds = scene.inputs.tread_speeds_m_s + noise
    return replace(scene, inputs=replace(scene.inputs, tread_speeds_m_s=speeds))


def noise_of_windows(fits: Sequence[Fitted], measured: Measured) -> list[FloatArray]:
    """Chi-squared (K,) of each window that noise of the tread speeds makes, of each fit.

    By a small part of it: a function that follows the noise does so only as far as it was recorded.
    """
    rng = np.random.default_rng(SEED)
    scenes = tuple(noisier(scene, rng, PART) for scene in measured.scenes)
    again = replace(measured, scenes=scenes)
    return [
        measured.by_window(
            (again.rows(fit.base, fit.effects) - measured.rows(fit.base, fit.effects)) / PART
        )
        for fit in fits
    ]


def surely_dearer(fit: Fitted, other: Fitted, measured: Measured) -> float:
    """By how much a fit surely costs more than another, noise of the tread speeds apart.

    Of what the other keeps out of the motion nothing counts: a smooth function of the speeds at
    which a robot drove all the time follows their noise.
    """
    own, of_other = (of.sum() for of in noise_of_windows([fit, other], measured))
    kept_out = max(0.0, float(own - of_other))
    return cost_of(fit) - cost_of(other) - kept_out - scatter_of_noise(kept_out)


def scatter_of_noise(kept_out: float) -> float:
    """Bound of 95 % on how sums of squares with noise of such a chi-squared and without scatter.

    They differ by that of the noise, with twice its root as standard deviation.
    """
    return 2 * SURE * float(np.sqrt(max(0.0, kept_out)))
