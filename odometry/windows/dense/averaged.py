"""Windows on inputs averaged over short steps, and what the gyroscope reports of each step.

A path of two seconds by means over a tenth of a second ends within a millimetre or two of that
by the samples themselves, where poses are measured to a centimetre, and takes a fraction of the
time.
"""

from dataclasses import fields, replace

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.models.inputs import Inputs
from odometry.recording.run import Run
from odometry.recording.sensors import gyroscope_of
from odometry.windows.dense.dense import DenseWindows

LONGEST_S = 0.1  # of a step
LONGEST_SILENCE_S = 1.0  # of the gyroscope, over all of the run
ROUNDING_S = 1e-6


def averaged_windows(windows: DenseWindows) -> DenseWindows:
    """The same windows on averaged inputs, `yaw_rate_rad_s` as the gyroscope reports it."""
    samples = np.searchsorted(windows.time_s, windows.pose_s[np.unique(windows.windows)])
    first = averaging_steps(windows.inputs, np.union1d(samples, _rare_rows(windows)))
    time_s = windows.time_s[first]
    inputs = averaged(windows.inputs, windows.steps_s, first)
    return replace(
        windows,
        inputs=replace(inputs, yaw_rate_rad_s=reported_rates(windows.run, time_s)),
        steps_s=np.append(np.diff(time_s), 0.0),
        travel_m=windows.travel_m[first],
    )


def _rare_rows(windows: DenseWindows) -> IntArray:
    """Samples at rows of odometry that come as rarely as steps last: no mean spans two of them."""
    stamps_s = windows.run.odometry.stamps_s
    if np.median(np.diff(stamps_s)) < LONGEST_S - ROUNDING_S:
        return np.empty(0, dtype=np.int64)
    return np.asarray(np.searchsorted(windows.time_s, stamps_s - stamps_s[0]))


def reported_rates(run: Run, time_s: FloatArray) -> FloatArray | None:
    """Mean yaw rate (N,) that the gyroscope reports from each run time to the next.

    None without a gyroscope, and where it is silent for longer than LONGEST_SILENCE_S in all.
    """
    gyroscope = gyroscope_of(run.yaw_rate)
    if gyroscope is None:
        return None
    stamps_s = run.odometry.stamps_s[0] + time_s
    turn_rad, _, _, silent_s = gyroscope.between(stamps_s[:-1], stamps_s[1:])
    if silent_s.sum() > LONGEST_SILENCE_S:
        return None
    return np.append(turn_rad / np.diff(time_s), 0.0)


def averaging_steps(inputs: Inputs, begins: IntArray) -> IntArray:
    """First sample (S,) of each step: those given, where labels change, between them; the last.

    Parameters
    ----------
    inputs : Inputs
        Of stack (N,), with stamps.
    begins : (B,)
        Samples at which a step must begin; increasing.
    """
    time_s = np.asarray(inputs.time_s)
    starts = np.zeros(len(time_s), dtype=np.bool_)
    starts[[0, -1]] = True
    starts[begins] = True
    if inputs.terrain is not None:
        starts[1:] |= inputs.terrain[1:] != inputs.terrain[:-1]
    first = np.maximum.accumulate(np.where(starts, np.arange(len(time_s)), 0))
    within = np.floor((time_s - time_s[first]) / LONGEST_S + ROUNDING_S)
    return np.flatnonzero(starts | (np.diff(within, prepend=0.0) != 0))


def averaged(inputs: Inputs, steps_s: FloatArray, first: IntArray) -> Inputs:
    """Means over steps that begin at samples (S,), each sample by its time in force (N,).

    Stamps and labels are those at the begin.
    """
    named: dict[str, AnyArray | None] = {}
    for one in fields(inputs):
        values = getattr(inputs, one.name)
        if values is None or one.name in ("time_s", "terrain", "run_number"):
            named[one.name] = None if values is None else values[first]
        else:
            named[one.name] = _means(values, steps_s, first)
    return Inputs(**named)  # type: ignore[arg-type]  # each of its own field


def _means(values: FloatArray, steps_s: FloatArray, first: IntArray) -> FloatArray:
    weights = np.maximum(steps_s, ROUNDING_S).reshape(-1, *[1] * (values.ndim - 1))
    sums = np.add.reduceat(values * weights, first, axis=0)
    return np.asarray(sums / np.add.reduceat(weights, first, axis=0))
