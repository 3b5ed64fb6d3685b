"""Identify traction modes from runs: the gains of each terrain that runs name, and the noise."""

from collections.abc import Sequence

import numpy as np
from tqdm import tqdm

from odometry.arrays import FloatArray
from odometry.identification.identify import robot_of
from odometry.modes.mode_windows import heard_by_mode, inside, scenes_by_mode
from odometry.modes.traction import TractionModes
from odometry.modes.traction_fit import TractionFit, fitted, residuals
from odometry.modes.yaw_rate_noise import (
    LASTING_S,
    YawRateNoise,
    estimated_yaw_rate_noise,
)
from odometry.run import Run
from odometry.windows.dense import DenseWindows
from odometry.windows.dense_noise import FIRST_GUESS, Noise, estimated_noise

FIRST_YAW_RATE_NOISE = YawRateNoise(0.05**2)
ROUNDS = 2  # of a fit weighted by the noise that the one before left


def identify_traction_modes(
    runs: Sequence[Run], *, paper: bool = False, show_progress: bool = False
) -> TractionModes:
    """Identify the gains and the noise of modes; a mode is a terrain that the runs name.

    Nonlinear least squares of the measured motion over windows of 4 s (2 s where poses are chained
    for less) and of the measured yaw rates, each weighted by its noise, which is found from what
    the fit before leaves; gains that the runs leave open stay near those of eq. 3.

    Parameters
    ----------
    runs : sequence of Run
        With measured poses.
    paper : bool
        Only k and m of Salvi 2024 eq. 3, the same in left and right turns.
    show_progress : bool

    Raises
    ------
    IdentificationError
        If a run names no mode, or a mode was not driven, or (but with `paper`) does not turn to
        both sides, for long enough.
    WindowError
        If a run has no window of 2 s without a gap.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> on_gravel = replace(run, settings={**run.settings, "run": {"terrain": "gravel"}})
    >>> modes = odometry.identify_traction_modes([on_gravel], paper=True)
    >>> modes.names, modes.gains.shape
    (('gravel',), (1, 2, 3, 5))
    """
    width = robot_of(runs).track_width
    horizon_s, scenes = scenes_by_mode(runs, paper=paper)
    heard = heard_by_mode(runs)
    noise, of_yaw_rate = Noise(*np.sqrt(FIRST_GUESS).tolist()), FIRST_YAW_RATE_NOISE
    bar = tqdm(total=ROUNDS * len(scenes), unit="fit", disable=None if show_progress else True)
    for _ in range(ROUNDS):
        fits: dict[str, TractionFit] = {}
        for name, of in scenes.items():
            fits[name] = fitted(of, heard[name], noise, of_yaw_rate, paper=paper)
            bar.update()
        pairs = [
            (scene, residuals(fit.gains, fit.lag_s, scene))
            for name, fit in fits.items()
            for scene in scenes[name]
        ]
        noise = estimated_noise([scene for scene, _ in pairs], [left for _, left in pairs])
        errors = [
            (one, one.errors(fit.gains, fit.lag_s))
            for name, fit in fits.items()
            for one in heard[name]
        ]
        of_yaw_rate = estimated_yaw_rate_noise(errors)
    bar.close()
    position, yaw, wander, turn = noise.variances
    return TractionModes(
        names=tuple(fits),
        gains=np.stack([fit.gains for fit in fits.values()]),
        lag_s=np.array([fit.lag_s for fit in fits.values()]),
        track_width=width,
        # a speed that is off for T moves a place by T of it: its square by a metre grows with T
        process_variance=np.array(
            [wander * LASTING_S / horizon_s, turn * LASTING_S / horizon_s, of_yaw_rate.lasting]
        )
        + _left_open(fits, scenes),
        measurement_variance=np.array([position, position, yaw, of_yaw_rate.variance]),
        variance_growth=of_yaw_rate.growth,
    )


def _left_open(fits: dict[str, TractionFit], scenes: dict[str, list[DenseWindows]]) -> FloatArray:
    """What gains that are not exact add to place and yaw by a metre, and to the yaw rate (3,).

    To a place in each direction as much as along or aside, whichever is more.
    """
    summed, travel_m, lasts_s = np.zeros(2), 0.0, 0.0
    for name, fit in fits.items():
        for scene in scenes[name]:
            steps_s = np.where(inside(scene), scene.steps_s, 0.0)
            variances = fit.twist_variances(scene)
            summed += steps_s @ np.column_stack([variances[:, :2].max(axis=1), variances[:, 2]])
            travel_m += float(steps_s @ np.abs(scene.inputs.tread_speeds_m_s).mean(axis=1))
            lasts_s += float(steps_s.sum())
    return np.append(summed * LASTING_S / travel_m, summed[1] / lasts_s)
