"""Identify traction modes from runs: the gains of each ground that runs name, and the noise."""

from collections.abc import Iterable, Sequence

import numpy as np
from scipy.optimize import least_squares
from tqdm import tqdm

from odometry.arrays import FloatArray
from odometry.gap.config import GapConfig
from odometry.gap.noise import estimated_noise
from odometry.gap.scene import Scene, scene_of
from odometry.gap.simulate import off_measured, poses_at
from odometry.grounds import terrains_of
from odometry.identification.errors import IdentificationError
from odometry.identification.identify import robot_of
from odometry.identification.motion import level_path
from odometry.models.icr import GUESSED_WIDTHS
from odometry.modes.traction import SHORTEST_LAG_S, TractionModes, lagged, twists_of
from odometry.modes.yaw_rate_noise import yaw_rate_variance
from odometry.run import UNKNOWN, Run

CONFIG = GapConfig()
LEAST_WINDOWS = 5  # of each mode, and of each turn
TURNING = 0.02  # of the treads' speed: less difference is no turn
FIRST_LAG_S = 0.05
USUAL = 0.3  # deviation of gains from eq. 3: what the runs leave open stays near
SCALES = np.array([0.02, 0.02, 0.01])  # of the errors of a window [m, m, rad]
EQ_3 = np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 1.0]], dtype=np.bool_)
"""Gains that eq. 3 has."""


def identify_traction_modes(
    runs: Sequence[Run], *, paper: bool = False, show_progress: bool = False
) -> TractionModes:
    """Identify the gains and the noise of modes; a mode is a ground that the runs name.

    Nonlinear least squares of the measured motion over windows of 2 s; gains that the runs leave
    open, as of speed where only one was driven, stay near those of eq. 3.

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
        If a run names no mode, or a mode has too few windows, or (but with `paper`) does not turn
        to both sides.
    GapError
        If a run has no window of 2 s without a gap.
    """
    robot = robot_of(runs)
    scenes: dict[str, list[Scene]] = {}
    bar: Iterable[Run] = tqdm(runs, unit="run", disable=None if show_progress else True)
    for run in bar:
        scene = scene_of(run, CONFIG)
        for name in map(str, np.unique(terrains_of(run))):
            if name == UNKNOWN:
                raise IdentificationError(
                    f"{run.folder}: names no mode; expected [run] terrain in run.toml or a column "
                    "terrain"
                )
            scenes.setdefault(name, []).append(_on(scene, name))
    names = tuple(sorted(scenes))
    fits = [_fitted(name, scenes[name], robot.track_width, paper) for name in names]
    gains, lag_s = np.stack([gains for gains, _ in fits]), np.array([lag for _, lag in fits])
    pairs = [
        (scene, residuals(*fit, scene, robot.track_width))
        for name, fit in zip(names, fits, strict=True)
        for scene in scenes[name]
        if len(scene)
    ]
    noise = estimated_noise([scene for scene, _ in pairs], [left for _, left in pairs])
    position, yaw, wander, turn = noise.variances
    process = np.array([wander, turn])
    of_yaw_rate = yaw_rate_variance(runs, names, fits, robot.track_width)
    measurement = np.array([position, position, yaw, of_yaw_rate])
    return TractionModes(names, gains, lag_s, robot.track_width, process, measurement)


def residuals(gains: FloatArray, lag_s: float, scene: Scene, track_width: float) -> FloatArray:
    """Measured less predicted motion (K, n, 3) of the windows of a scene."""
    twists = twists_of(gains, scene.inputs.tread_speeds_m_s, track_width)
    yaw_rates = lagged(twists[:, 2], scene.time_s, lag_s)
    # the mean over a step: lag d(omega)/dt = asked - omega, integrated
    twists[:-1, 2] -= max(lag_s, SHORTEST_LAG_S) * np.diff(yaw_rates) / np.diff(scene.time_s)
    path = level_path(twists, scene.steps_s, scene.inputs)
    return off_measured(poses_at(path, scene, scene.pose_s), scene)


def _fitted(
    name: str, scenes: Sequence[Scene], track_width: float, paper: bool
) -> tuple[FloatArray, float]:
    """Gains (2, 3, 2), and the lag of the yaw rate [s], 0 with `paper`."""
    _check(name, scenes, paper)
    free = np.stack([EQ_3, EQ_3]) if paper else np.ones((2, 3, 2), dtype=np.bool_)
    start = np.stack([EQ_3, EQ_3]) * np.array([1.0, 1.0 / GUESSED_WIDTHS])

    def fit_at(values: FloatArray) -> tuple[FloatArray, float]:
        gains = np.zeros((2, 3, 2))
        gains[free] = np.tile(values[:-1], 2) if paper else values[:-1]
        return gains, 0.0 if paper else float(values[-1])

    def rows_at(values: FloatArray) -> FloatArray:
        fit = fit_at(values)
        ends = [residuals(*fit, scene, track_width)[:, -1] for scene in scenes if len(scene)]
        measured = np.asarray(np.concatenate(ends) / SCALES).ravel()
        return np.append(measured, (values - first)[:-1] / USUAL)

    first = np.append(start[0][EQ_3] if paper else start[free], FIRST_LAG_S)
    low = np.full(len(first), -np.inf)
    low[-1] = 0.0
    found = least_squares(rows_at, first, bounds=(low, np.inf), x_scale="jac").x
    return fit_at(np.asarray(found))


def _check(name: str, scenes: Sequence[Scene], paper: bool) -> None:
    """Whether there is enough to tell all gains."""
    turns = np.zeros(2, dtype=np.int64)
    windows = 0
    for scene in scenes:
        rows = np.searchsorted(scene.time_s, scene.pose_s[scene.windows])
        left, right = np.abs(scene.inputs.tread_speeds_m_s).mean(axis=0)
        turn = np.diff(scene.inputs.tread_speeds_m_s[rows], axis=-1)[..., 0].mean(axis=1)
        windows += len(scene)
        turns += [
            int((sign * turn > TURNING * max(left, right, 1e-9)).sum()) for sign in (1.0, -1.0)
        ]
    if windows < LEAST_WINDOWS:
        raise IdentificationError(
            f"{name}: {windows} windows of {CONFIG.horizon_s:g} s, expected {LEAST_WINDOWS} or more"
        )
    if not paper and turns.min() < LEAST_WINDOWS:
        raise IdentificationError(
            f"{name}: {turns[0]} windows of {CONFIG.horizon_s:g} s in left turns and {turns[1]} in "
            f"right ones, expected {LEAST_WINDOWS} or more of each"
        )


def _on(scene: Scene, name: str) -> Scene:
    """Windows that start and end in one mode."""
    labels = terrains_of(scene.run)
    odometry_s = scene.run.odometry.stamps_s - scene.run.odometry.stamps_s[0]
    ends_s = scene.pose_s[scene.windows[:, [0, -1]]]
    rows = np.clip(np.searchsorted(odometry_s, ends_s, side="right") - 1, 0, len(labels) - 1)
    return scene.where((labels[rows] == name).all(axis=1))
