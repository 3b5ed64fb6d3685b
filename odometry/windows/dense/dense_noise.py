"""What noise explains of dense windows: poses measured with error, motion that wanders.

Each part of the covariance is F F', of an F whose columns are picks, sums or running sums of
residuals: products with it need no matrix product, but for the one of the turns.

The motion of a window is measured from its first pose, so that all of it shares that pose's
noise. Five variances make its covariance: of a measured position and yaw, of what a metre of
wheel travel adds to the place and to the yaw, and of what a second adds to the turn that the
gyroscope reports, which follows the robot where its motion wanders.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg.lapack import dtrtri
from scipy.optimize import minimize

from odometry.arrays import FloatArray
from odometry.windows.dense.dense import DenseWindows


def added_travel_m(scene: DenseWindows) -> FloatArray:
    """Wheel travel (K, n) between poses of each window."""
    travel_m = scene.travel_m[np.searchsorted(scene.time_s, scene.pose_s[scene.windows])]
    return np.asarray(np.diff(travel_m, axis=1))


def wandering_turns(scene: DenseWindows) -> FloatArray:
    """Residuals (K, n, R) that a standard deviation of the yaw of each step makes."""
    motion, added_m = scene.measured, added_travel_m(scene)
    count, steps, _ = motion.shape
    j = np.arange(steps)
    places = np.concatenate([np.zeros((count, 1, 2)), motion[..., :2]], axis=1)
    spread = places[:, None, 1:, :] - places[:, :-1, None, :]  # (K, i, j, 2) from i on
    swing = np.stack([-spread[..., 1], spread[..., 0], np.ones(spread.shape[:-1])], axis=-1)
    swing *= (j[None, :] >= j[:, None])[None, :, :, None]
    swing *= np.sqrt(added_m)[:, :, None, None]
    turns = swing.reshape(count, steps, 3 * steps)
    if scene.reported_turns is None:
        return turns
    return np.concatenate([turns, np.sqrt(added_m)[:, :, None] * np.eye(steps)], axis=-1)


class Factors:
    """F of each of the five variances, of residuals in their order in a window."""

    def __init__(self, scene: DenseWindows) -> None:
        motion, added_m = scene.measured, added_travel_m(scene)
        self._steps = motion.shape[1]
        lever = np.stack([-motion[..., 1], motion[..., 0], np.ones(motion.shape[:2])], axis=-1)
        self._lever = lever.reshape(len(scene), 1, -1)
        self._travel_m = np.cumsum(added_m, axis=1)
        self._added = np.sqrt(added_m)[..., None]
        self._turns = wandering_turns(scene)
        self._seconds = np.sqrt(np.diff(scene.pose_s[scene.windows], axis=1))[..., None]

    def covariance(self, variances: FloatArray) -> FloatArray:
        """Covariance (K, R, R) that the five variances make of the residuals of each window.

        The R residuals are those of n poses, three of each, then the n of a gyroscope if there is
        one.
        """
        position, yaw, wander, turn, gyroscope = variances
        steps, of_poses = self._steps, 3 * self._steps
        size = self._turns.shape[-1]
        lever = np.pad(self._lever, ((0, 0), (0, 0), (0, size - of_poses)))
        swung = np.concatenate([np.sqrt(yaw) * lever, np.sqrt(turn) * self._turns], axis=1)
        made = swung.swapaxes(1, 2) @ swung
        j = np.arange(steps)
        along = wander * self._travel_m[:, np.minimum(j[:, None], j)]
        along += position * (1.0 + np.eye(steps))
        for axis in (0, 1):
            made[:, axis:of_poses:3, axis:of_poses:3] += along
        yaws, turns = np.arange(2, of_poses, 3), np.arange(of_poses, size)
        made[:, yaws, yaws] += yaw
        made[:, turns, turns] += gyroscope * self._seconds[:, : len(turns), 0] ** 2
        return np.asarray(made)

    def times(self, part: int, columns: FloatArray) -> FloatArray:
        """F' (K, c, R) of a part times columns (K, R, C)."""
        steps = self._steps
        x, y, yaw = (columns[:, axis : 3 * steps : 3] for axis in range(3))
        if part == 0:
            sums = [of.sum(axis=1, keepdims=True) for of in (x, y)]
            return np.concatenate([x, y, *sums], axis=1)
        if part == 1:
            return np.concatenate([self._lever @ columns[:, : 3 * steps], yaw], axis=1)
        if part == 2:
            later = [np.cumsum(of[:, ::-1], axis=1)[:, ::-1] * self._added for of in (x, y)]
            return np.concatenate(later, axis=1)
        if part == 3:
            return np.asarray(self._turns @ columns)
        gyroscope = columns[:, 3 * steps :]
        return np.asarray(gyroscope * self._seconds[:, : gyroscope.shape[1]])

    def score(self, white: FloatArray, rows: FloatArray) -> FloatArray:
        """Derivative (5,) of the log-likelihood by the five variances.

        Parameters
        ----------
        white : (K, R, R)
            Inverse Cholesky factors of the covariance.
        rows : (K, R)
            Residuals.
        """
        inverse = white.swapaxes(1, 2) @ white
        weighted = inverse @ rows[..., None]
        found = np.zeros(PARTS)
        for part in range(PARTS):
            columns = np.ascontiguousarray(self.times(part, inverse).swapaxes(1, 2))
            explained = np.trace(self.times(part, columns), axis1=1, axis2=2).sum()
            own = self.times(part, weighted)
            found[part] = (np.vdot(own, own) - explained) / 2
        return found


FIRST_GUESS = np.square([0.02, 0.01, 0.005, 0.005, 0.001])
SMALLEST = np.square([1e-4, 1e-4, 1e-5, 1e-5, 1e-5])
LARGEST = 1e4  # times a variance: a search that goes farther at once leaves no definite covariance
PARTS = 5  # variances
MOST_WINDOWS = 60  # from which variances are estimated


@dataclass(frozen=True)
class Noise:
    """Standard deviations: position [m], yaw [rad], by the root of a metre of travel, of a second.

    `gyro_rad` is that of the gyroscope's turn [rad] over one second.
    """

    position_m: float
    yaw_rad: float
    wander_m: float
    wander_rad: float
    gyro_rad: float = 1e-3

    @property
    def variances(self) -> FloatArray:
        """Those of poses and travel (4,)."""
        return np.square([self.position_m, self.yaw_rad, self.wander_m, self.wander_rad])

    @property
    def all_variances(self) -> FloatArray:
        """The same and that of the gyroscope (5,)."""
        return np.append(self.variances, self.gyro_rad**2)


def with_rounding(variances: FloatArray, scene: DenseWindows) -> FloatArray:
    """The five variances of a scene whose positions were rounded: uniform within a step."""
    known = variances.copy()
    known[0] += scene.rounded_m**2 / 12
    return known


def end_variance(scene: DenseWindows, noise: Noise) -> FloatArray:
    """Variance (K, 3) of the residuals at the end of each window."""
    x, y, _ = np.moveaxis(scene.measured, -1, 0)
    added_m = added_travel_m(scene)
    position, yaw, wander, turn, _ = with_rounding(noise.all_variances, scene)
    ahead, aside = (  # from the poses before each step to the last
        of[:, -1:] - np.pad(of[:, :-1], ((0, 0), (1, 0))) for of in (x, y)
    )
    swung = [(added_m * lever**2).sum(axis=1) for lever in (aside, ahead, np.ones_like(ahead))]
    place = 2 * position + wander * added_m.sum(axis=1)
    return np.stack(
        [
            place + yaw * y[:, -1] ** 2 + turn * swung[0],
            place + yaw * x[:, -1] ** 2 + turn * swung[1],
            2 * yaw + turn * swung[2],
        ],
        axis=-1,
    )


def whitening(scene: DenseWindows, noise: Noise) -> FloatArray:
    """Matrices (K, R, R) that make the residuals of each window white, of unit variance.

    They are lower triangular.
    """
    variances = with_rounding(noise.all_variances, scene)
    return _whitening(Factors(scene).covariance(variances))


def _whitening(covariance: FloatArray) -> FloatArray:
    """Inverse Cholesky factors (K, R, R) of covariances (K, R, R)."""
    white = np.linalg.cholesky(covariance)
    for factor in white:
        factor[:] = dtrtri(factor.T)[0].T
    return np.asarray(white)


def estimated_noise(
    scenes: Sequence[DenseWindows], residuals: Sequence[FloatArray], start: Noise | None = None
) -> Noise:
    """Most likely variances of the residuals (K, R) of each scene, searched by their logarithms.

    Those of positions are beyond what is known of their rounding. `start` is an answer to nearly
    the same residuals.
    """
    parts = []
    share = MOST_WINDOWS / max(1, sum(map(len, scenes)))
    for scene, of in zip(scenes, residuals, strict=True):
        most = min(max(1, round(share * len(scene))), len(scene))
        picked = np.unique(np.linspace(0, len(scene) - 1, most).astype(np.int64))
        chosen = replace(scene, windows=scene.windows[picked])
        parts.append((chosen, Factors(chosen), of[picked].reshape(len(picked), -1)))

    def unlikely(logarithms: FloatArray) -> tuple[float, FloatArray]:
        variances, likelihood, score = np.exp(logarithms), 0.0, np.zeros(len(logarithms))
        for scene, factors, rows in parts:
            white = _whitening(factors.covariance(with_rounding(variances, scene)))
            likelihood += _log_likelihood(white, rows)
            score += factors.score(white, rows)
        return -likelihood, -score * variances

    begin = FIRST_GUESS if start is None else np.maximum(start.all_variances, SMALLEST)
    bounds = np.log([SMALLEST, LARGEST * np.maximum(begin, FIRST_GUESS)]).T
    found = minimize(unlikely, np.log(begin), jac=True, method="L-BFGS-B", bounds=bounds)
    return Noise(*np.exp(found.x / 2).tolist())


def _log_likelihood(white: FloatArray, rows: FloatArray) -> float:
    """Of residuals (K, R) by their whiteners (K, R, R), but for a constant."""
    left = white @ rows[..., None]
    return float(np.log(np.diagonal(white, axis1=1, axis2=2)).sum() - np.vdot(left, left) / 2)
