"""Poses at measured positions by filters forwards and backwards (Rauch, Tung, Striebel 1965).

Many start headings and carriers at once: a filter is linear in the heading near its own start
only, so that each start needs one (Gaussian sum: Alspach and Sorenson 1972).
"""

from typing import NamedTuple

import numpy as np

from odometry.arrays import BoolArray, FloatArray

FIRST_YAW_RAD = 0.3
ACROSS_GAP = np.square([5.0, 5.0, 1.0, 0.0, 0.0])  # variances that a gap of odometry adds
FAR = 13.8  # squared Mahalanobis distance of a position that one in a thousand has
STATES = 5  # x, y, yaw and the two drifts


class Way(NamedTuple):
    """What H filters follow: M positions (M, 2) and the steps between them.

    `steps` are (H, M - 1, 3); `step_variances` (M - 1, 3), `drifts` (M - 1, 2), `drift_sigmas`
    (2,) and `position_variance_m2` those of `Carrier`; `gaps` (M - 1,) are those of odometry.
    """

    positions: FloatArray
    steps: FloatArray
    step_variances: FloatArray
    drifts: FloatArray
    drift_sigmas: FloatArray
    position_variance_m2: float
    gaps: BoolArray

    def backwards(self) -> "Way":
        """The same from the last position to the first."""
        yaw = self.steps[..., 2]
        c, s = np.cos(yaw), np.sin(yaw)
        x, y = self.steps[..., 0], self.steps[..., 1]
        steps = np.stack([-c * x - s * y, s * x - c * y, -yaw], axis=-1)
        return self._replace(
            positions=self.positions[::-1],
            steps=steps[:, ::-1],
            step_variances=self.step_variances[::-1],
            drifts=-self.drifts[::-1],
            gaps=self.gaps[::-1],
        )


class Filtered(NamedTuple):
    """States (M, H, 5) and covariances (M, H, 5, 5) after each position of a way.

    `log_likelihoods` are (H,), and `surprise` (H,) the mean of the squared Mahalanobis distances
    by their expected value.
    """

    way: Way
    states: FloatArray
    covariances: FloatArray
    log_likelihoods: FloatArray
    surprise: FloatArray


class Smoothed(NamedTuple):
    """Poses (M, H, 3) with yaw not wrapped, and their covariances (M, H, 3, 3)."""

    poses: FloatArray
    covariances: FloatArray


def filtered(way: Way, first_yaws_rad: FloatArray) -> Filtered:
    """Filter forwards from each first yaw (H,), known to FIRST_YAW_RAD.

    A position that lies far from where it should is weighed down by its distance.
    """
    count, size, variance = len(way.positions), len(first_yaws_rad), way.position_variance_m2
    states, covariances = np.zeros((count, size, STATES)), np.zeros((count, size, STATES, STATES))
    states[0, :, :2], states[0, :, 2] = way.positions[0], first_yaws_rad
    covariances[0] = np.diag([variance, variance, FIRST_YAW_RAD**2, *np.square(way.drift_sigmas)])
    log_likelihoods, surprise = np.zeros((2, size))
    for i in range(1, count):
        prior = _predicted(way, i, states[i - 1], covariances[i - 1])
        off = way.positions[i] - prior.states[:, :2]
        spread = prior.covariances[:, :2, :2] + variance * np.eye(2)
        distance = np.einsum("hi,hij,hj->h", off, np.linalg.inv(spread), off)
        surprise += distance / 2 / (count - 1)
        lost = np.where(distance > FAR, 2 * np.sqrt(FAR * distance) - FAR, distance)
        log_likelihoods -= (lost + np.log(np.linalg.det(spread))) / 2
        weighed = variance * np.maximum(1.0, np.sqrt(distance / FAR))  # the same pull however far
        states[i], covariances[i] = _updated(prior, off, weighed)
    return Filtered(way, states, covariances, log_likelihoods, surprise)


def smoothed(of: Filtered) -> Smoothed:
    """The likeliest poses at all positions, given all of these.

    What was predicted is predicted again: kept for each position it would take twice the memory.
    """
    states, after = of.states.copy(), of.covariances[-1]
    covariances = of.covariances[..., :3, :3].copy()
    for i in range(len(states) - 2, -1, -1):
        prior = _predicted(of.way, i + 1, of.states[i], of.covariances[i])
        gain = of.covariances[i] @ prior.moves.swapaxes(1, 2) @ np.linalg.inv(prior.covariances)
        states[i] += np.einsum("hij,hj->hi", gain, states[i + 1] - prior.states)
        change = after - prior.covariances
        after = of.covariances[i] + gain @ change @ gain.swapaxes(1, 2)
        covariances[i] = after[:, :3, :3]
    return Smoothed(states[..., :3], covariances)


class _Predicted(NamedTuple):
    """States (H, 5), covariances and transitions (H, 5, 5) to a position, before it counts."""

    states: FloatArray
    covariances: FloatArray
    moves: FloatArray


def _predicted(way: Way, i: int, before: FloatArray, covariances: FloatArray) -> _Predicted:
    """Position `i` from the states and covariances after the one before."""
    states = _moved(before, way.steps[:, i - 1], way.drifts[i - 1])
    moves = np.tile(np.eye(STATES), (len(before), 1, 1))
    moves[:, 2, 3:] = -way.drifts[i - 1]
    moves[:, 0, 2] = before[:, 1] - states[:, 1]
    moves[:, 1, 2] = states[:, 0] - before[:, 0]
    added = np.pad(way.step_variances[i - 1], (0, 2)) + way.gaps[i - 1] * ACROSS_GAP
    turned = moves @ covariances @ moves.swapaxes(1, 2)
    return _Predicted(states, turned + np.diag(added), moves)


def _moved(states: FloatArray, steps: FloatArray, drifts: FloatArray) -> FloatArray:
    c, s = np.cos(states[:, 2]), np.sin(states[:, 2])
    moved = states.copy()
    moved[:, 0] += c * steps[:, 0] - s * steps[:, 1]
    moved[:, 1] += s * steps[:, 0] + c * steps[:, 1]
    moved[:, 2] += steps[:, 2] - states[:, 3:] @ drifts
    return moved


def _updated(
    prior: _Predicted, off: FloatArray, variances_m2: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """States and covariances with one measured position, in Joseph form."""
    covariances = prior.covariances
    spread = covariances[:, :2, :2] + variances_m2[:, None, None] * np.eye(2)
    gain = covariances[:, :, :2] @ np.linalg.inv(spread)
    kept = np.tile(np.eye(STATES), (len(covariances), 1, 1))
    kept[:, :, :2] -= gain
    noise = variances_m2[:, None, None] * (gain @ gain.swapaxes(1, 2))
    updated = kept @ covariances @ kept.swapaxes(1, 2) + noise
    return prior.states + np.einsum("hij,hj->hi", gain, off), updated
