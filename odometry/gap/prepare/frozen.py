"""Poses of the reference that are no measurement: far off their neighbours, or repeated."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.interface.base_model import Base
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.simulate import residuals, simulated_poses
from odometry.geometry import se2
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.dense.dense_noise import whitening
from odometry.windows.recorded.robust import NORMAL

NEIGHBOURS = 7  # poses of a median: up to three off in a row do not move it
LEAST_SIGMA_M = 1e-3  # of a reference
DIAGONAL = 2**0.5  # of a grid, in its steps: rounding moves no place farther from its neighbours
NINE_IN_TEN = 2.146  # standard deviations within which nine in ten of normal places lie
DELAYS_S = np.arange(-10, 11) * 0.05  # of the treads against the poses, either way

MOST_STANDING = 30.0  # chi-squared of three numbers: more is no rest
RETURNED, MOST = 0.25, 0.7  # share of the farthest that may be left; share of events that return
MOVED_M = 5e-3  # less since the last pose is rest


@dataclass(frozen=True)
class Isolated:
    """Poses of one run that are no measurement of its place.

    Attributes
    ----------
    off : (M,) of bool
    distances_m : (M,)
        By which each is off.
    stamps_s : (M,)
        Run time.
    sigmas : (M,)
        The same in standard deviations of the ordinary ones.
    """

    off: BoolArray
    distances_m: FloatArray
    stamps_s: FloatArray
    sigmas: FloatArray


def isolated(scene: DenseWindows, calibration: Calibration, config: GapConfig) -> Isolated:
    """Poses that are far off their neighbours, of a run as the calibration drives it.

    Farther than to the next place of the grid to which positions were rounded.
    """
    base = calibration.base
    distances_m, sigma_m = off_neighbours(drift_of(scene, base))
    if (distances_m > config.outlier_sigmas * sigma_m).any():
        for delay_s in DELAYS_S:
            late = replace(base, latency_s=base.latency_s + float(delay_s))
            distances_m = np.minimum(distances_m, off_neighbours(drift_of(scene, late))[0])
    sigmas = distances_m / sigma_m
    off = (sigmas > config.outlier_sigmas) & (distances_m > DIAGONAL * scene.rounded_m)
    return Isolated(off, distances_m, scene.pose_s, sigmas)


def drift_of(scene: DenseWindows, base: Base) -> FloatArray:
    """How far the measured places (M, 2) have gone from those of the treads, step by step."""
    reckoned = simulated_poses(base, (), scene)
    steps = np.diff(reckoned[:, 0] + 1j * reckoned[:, 1])
    steps *= np.exp(1j * (scene.poses[:-1, 2] - reckoned[:-1, 2]))
    measured = np.diff(scene.poses[:, 0] + 1j * scene.poses[:, 1])
    drift = np.concatenate([[0.0], np.cumsum(measured - steps)])
    return np.stack([drift.real, drift.imag], axis=-1)


def off_neighbours(drift: FloatArray) -> tuple[FloatArray, float]:
    """Distances (M,) from the median of the neighbours [m], and their standard deviation."""
    near = [median_filter(part, NEIGHBOURS, mode="nearest") for part in drift.T]
    off = drift - np.stack(near, axis=-1)
    distances_m = np.hypot(*off.T)
    sigma_m = max(
        NORMAL * float(np.median(np.abs(off))),
        float(np.quantile(distances_m, 0.9)) / NINE_IN_TEN,
        LEAST_SIGMA_M,
    )
    return distances_m, sigma_m


def frozen(scene: DenseWindows, calibration: Calibration, config: GapConfig) -> Isolated:
    """Poses that are those before them, but for noise, while the treads run; and then jump."""
    drift = drift_of(scene, calibration.base)
    steps = every_step(scene)
    whiteners = whitening(steps, calibration.noise)
    by_treads = residuals(calibration.base, (), steps)[:, 0]
    costs = [
        ((whiteners[:, :3, :3] @ rows[..., None])[..., 0] ** 2).sum(axis=-1)
        for rows in (by_treads, steps.measured[:, 0])
    ]
    stands = np.where(costs[1] < MOST_STANDING, costs[1], np.inf)
    on = frozen_steps(costs[0], stands, config.least_evidence)
    repeats = np.append(
        False, on & returns(on, scene.poses, simulated_poses(calibration.base, (), scene))
    )
    last_new = np.maximum.accumulate(np.where(repeats, 0, np.arange(len(repeats))))
    distances_m = np.hypot(*(drift - drift[last_new]).T)
    sigmas = distances_m / off_neighbours(drift)[1]
    return Isolated(repeats & (distances_m > MOVED_M), distances_m, scene.pose_s, sigmas)


def frozen_steps(running: FloatArray, standing: FloatArray, least: float) -> BoolArray:
    """Whether the reference is frozen in each step (S,): events that end in a jump, of least cost.

    Parameters
    ----------
    running, standing : (S,)
        Chi-squared of each step by the treads, and by no motion.
    least : float
        By which an event must be better frozen than running, without its jump.
    """
    turn = float(np.log(len(running)))
    # States: by the treads, frozen, the jump at its end; from each row to each column.
    paid = np.array([[0.0, turn, np.inf], [np.inf, 0.0, turn], [0.0, turn, np.inf]])
    own = np.stack([running, standing, np.zeros_like(running)], axis=-1)
    cost, came = np.array([0.0, turn, np.inf]), np.zeros((len(own), 3), dtype=np.int64)
    for row, of in enumerate(own):
        reached = cost[:, None] + paid
        came[row] = np.argmin(reached, axis=0)
        cost = reached.min(axis=0) + of
    states, state = np.zeros(len(own), dtype=np.int64), int(np.argmin(cost))
    for row in range(len(own) - 1, -1, -1):
        states[row], state = state, int(came[row, state])
    event = np.cumsum(np.diff(states == 1, prepend=False))
    standing = np.where(states == 1, standing, running)
    gains = np.bincount(event, weights=running - standing)
    return np.asarray((states == 1) & (gains[event] > least))


def returns(on: BoolArray, poses: FloatArray, reckoned: FloatArray) -> BoolArray:
    """Which steps (S,) are of an event after which poses (S + 1, 3) are where the treads lead.

    None where few events do: on a grid of places each jump leads as far as the grid is wide. All
    that get nearer where together they do: noise may be a large part of a short one.
    """
    padded = np.concatenate([[False], on, [False]]).astype(np.int8)
    begins, ends = np.flatnonzero(np.diff(padded) == 1), np.flatnonzero(np.diff(padded) == -1)
    if not len(begins):
        return np.zeros_like(on)
    left, farthest = [], []
    for begin, end in zip(begins, ends, strict=True):
        event = slice(begin, min(end + 2, len(poses)))
        moved, led = (se2.between(of[begin], of[event])[:, :2] for of in (poses, reckoned))
        off_m = np.hypot(*(moved - led).T)
        left.append(off_m[-1])
        farthest.append(off_m.max())
    back = np.array(left) < RETURNED * np.array(farthest)
    if np.linalg.norm(left) < RETURNED * np.linalg.norm(farthest):
        back = np.array(left) < np.array(farthest)
    found = np.zeros_like(on)
    for begin, end in zip(begins[back], ends[back], strict=True):
        found[begin:end] = np.mean(back) > MOST
    return found


def every_step(scene: DenseWindows) -> DenseWindows:
    """Windows of two poses each: every step of a run."""
    pairs = np.arange(len(scene.pose_s) - 1)[:, None] + np.arange(2)
    return replace(scene.without_gyroscope(), windows=pairs)
