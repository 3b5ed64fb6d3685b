"""Identify traction modes from runs: the gains of each terrain that runs name, and the noise."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares
from tqdm import tqdm

from odometry.arrays import FloatArray, IntArray
from odometry.identification.identify import robot_of
from odometry.models.icr import GUESSED_WIDTHS
from odometry.modes.identify.held_out_centres import centre_errors
from odometry.modes.identify.held_out_gains import gain_errors
from odometry.modes.identify.mode_windows import inside, scenes_by_mode, yaw_rates_by_mode
from odometry.modes.models.response import SHORTEST_LAG_S, lagged
from odometry.modes.models.traction import TractionModes, requested, turns_of, twists_of
from odometry.modes.models.yaw_rate_noise import (
    LASTING_S,
    YawRateNoise,
    YawRateStretch,
    estimated_yaw_rate_noise,
)
from odometry.recording.independent_runs import check_no_run_twice
from odometry.recording.run import Run
from odometry.windows.dense.dense import DenseWindows, off_measured, poses_at
from odometry.windows.dense.dense_noise import FIRST_GUESS, Noise, estimated_noise, whitening
from odometry.windows.travel.motion import level_path

FIRST_LAG_S = 0.05
USUAL = 0.3  # deviation of each gain from eq. 3: what the runs leave open stays near
EQ_3 = np.array([[1, 0, 0, 0, 0], [0, 0, 0, 0, 0], [0, 1, 0, 0, 0]], dtype=np.bool_)

FIRST_YAW_RATE_NOISE = YawRateNoise(0.05**2)
ROUNDS = 2  # of a fit weighted by the noise that the one before left

"""Gains that eq. 3 has."""
SHARED, BY_TURN = [0, 1], [2, 3, 4]  # columns of gains


@dataclass(frozen=True)
class TractionFit:
    """One mode.

    Attributes
    ----------
    gains : (2, 3, 5)
        As in `TractionModes`.
    lag_s : float
    covariances : (2, 3, 5, 5)
        Of the gains of each speed.
    """

    gains: FloatArray
    lag_s: float
    covariances: FloatArray

    def twist_variances(self, scene: DenseWindows) -> FloatArray:
        """What the runs leave open of (v_x, v_y, omega) at each sample (N, 3) of a scene."""
        speeds = scene.inputs.tread_speeds_m_s
        inputs = requested(speeds, scene.run.robot.track_width)
        of_turn = self.covariances[turns_of(speeds)]
        return np.asarray(np.einsum("ni,nqij,nj->nq", inputs, of_turn, inputs))


def fitted(
    scenes: Sequence[DenseWindows],
    measured: Sequence[YawRateStretch],
    noise: Noise,
    yaw_rate_noise: YawRateNoise,
    *,
    paper: bool = False,
) -> TractionFit:
    """Gains and lag, 0 with `paper`, of the windows of scenes and yaw rates of a gyroscope."""
    parameter = _parameters(paper=paper)
    whiteners = [whitening(scene, noise) for scene in scenes]

    def fit_at(values: FloatArray) -> tuple[FloatArray, float]:
        gains = np.where(parameter >= 0, values[parameter], 0.0)
        return gains, 0.0 if paper else float(values[-1])

    def rows_at(values: FloatArray) -> FloatArray:
        gains, lag_s = fit_at(values)
        poses = [
            np.einsum("kij,kj->ki", white, residuals(gains, lag_s, scene).reshape(len(scene), -1))
            for white, scene in zip(whiteners, scenes, strict=True)
        ]
        yaw_rates = [
            one.errors(gains, lag_s) / np.sqrt(yaw_rate_noise.variances(one.accelerations_m_s2))
            for one in measured
        ]
        prior = (values - first)[:-1] / USUAL
        return np.concatenate([*poses, *yaw_rates, prior], axis=None)

    first = np.append(np.zeros(parameter.max() + 1), FIRST_LAG_S)
    for of_turn in parameter:
        first[of_turn[EQ_3]] = (1.0, 1.0 / GUESSED_WIDTHS)
    low = np.append(np.full(len(first) - 1, -np.inf), 0.0)
    found = least_squares(rows_at, first, bounds=(low, np.inf), x_scale="jac")
    covariance = np.linalg.pinv(found.jac.T @ found.jac)
    of_gains = covariance[parameter[..., :, None], parameter[..., None, :]]
    free = parameter >= 0
    of_gains = np.where(free[..., :, None] & free[..., None, :], of_gains, 0.0)
    return TractionFit(*fit_at(np.asarray(found.x)), of_gains)


def residuals(gains: FloatArray, lag_s: float, scene: DenseWindows) -> FloatArray:
    """Measured less predicted motion (K, n, 3) of the windows of a scene."""
    twists = twists_of(gains, scene.inputs.tread_speeds_m_s, scene.run.robot.track_width)
    yaw_rates = lagged(twists[:, 2], scene.time_s, lag_s)
    # the mean over a step: lag d(omega)/dt = commanded - omega, integrated
    twists[:-1, 2] -= max(lag_s, SHORTEST_LAG_S) * np.diff(yaw_rates) / np.diff(scene.time_s)
    path = level_path(twists, scene.steps_s, scene.inputs)
    return off_measured(poses_at(path, scene, scene.pose_s), scene)


def _parameters(*, paper: bool) -> IntArray:
    """Which parameter each gain (2, 3, 5) is, -1 for those that are 0.

    Left and right turns share what u_1 and u_2 move, so that the twist does not jump where one
    becomes the other: on straights and on the spot the rest is 0.
    """
    if paper:
        return np.tile(np.where(EQ_3, np.cumsum(EQ_3).reshape(EQ_3.shape) - 1, -1), (2, 1, 1))
    parameter = np.empty((2, 3, 5), dtype=np.int64)
    parameter[..., SHARED] = np.arange(6).reshape(3, 2)
    parameter[..., BY_TURN] = 6 + np.arange(18).reshape(2, 3, 3)
    return parameter


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
    RunFolderError
        If a run is there twice, whole or in part.

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
    check_no_run_twice(runs)
    horizon_s, scenes = scenes_by_mode(runs, paper=paper)
    measured = yaw_rates_by_mode(runs)
    noise, of_yaw_rate = Noise(*np.sqrt(FIRST_GUESS).tolist()), FIRST_YAW_RATE_NOISE
    bar = tqdm(total=ROUNDS * len(scenes), unit="fit", disable=None if show_progress else True)
    for _ in range(ROUNDS):
        fits: dict[str, TractionFit] = {}
        for name, of in scenes.items():
            fits[name] = fitted(of, measured[name], noise, of_yaw_rate, paper=paper)
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
            for one in measured[name]
        ]
        of_yaw_rate = estimated_yaw_rate_noise(errors)
    bar.close()
    position, yaw, wander, turn = noise.variances
    modes = TractionModes(
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
        fastest_m_s=_fastest_m_s(scenes),
    )
    if paper:
        return modes
    found = gain_errors(modes, measured)
    if found is not None:
        modes = replace(modes, gain_spread=found[0], gain_power=found[1])
    off = centre_errors(modes, runs)
    return modes if off is None else replace(modes, centre_spread=off[0], centre_noise=off[1])


def _fastest_m_s(scenes: dict[str, list[DenseWindows]]) -> float:
    """Largest speed of a tread in the windows of all modes."""
    return max(
        float(np.abs(scene.inputs.tread_speeds_m_s[inside(scene)]).max())
        for of in scenes.values()
        for scene in of
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
