"""Poses at measured positions by a filter forwards and backwards (Rauch, Tung, Striebel 1965)."""

from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se2
from odometry.positions.carrier import Carrier
from odometry.windows.left_out import ODOMETRY_GAP

FIRST_YAW_RAD = 0.3
ACROSS_GAP = np.square([5.0, 5.0, 1.0])  # variances that a gap of odometry adds: nothing is known
FAR = 13.8  # squared Mahalanobis distance of a position that one in a thousand has


class Smoothed(NamedTuple):
    """Poses (M, 3) with yaw not wrapped, and their covariances (M, 3, 3)."""

    poses: FloatArray
    covariances: FloatArray


def smoothed_poses(carrier: Carrier) -> Smoothed:
    """The likeliest antenna poses at all measured positions, given all of these.

    A position that lies far from where it should is weighed down by its distance.
    """
    positions, count = carrier.record.poses[:, :2], len(carrier.record.poses)
    gaps = carrier.record.breaks == ODOMETRY_GAP
    prior, posterior = np.zeros((2, count, 3))
    prior_of, posterior_of = np.zeros((2, count, 3, 3))
    moves = np.tile(np.eye(3), (count, 1, 1))
    prior[0] = *positions[0], carrier.first_yaw_rad
    variance = carrier.position_variance_m2
    prior_of[0] = np.diag([variance, variance, FIRST_YAW_RAD**2])
    posterior[0], posterior_of[0] = prior[0], prior_of[0]
    for i in range(1, count):
        prior[i] = _moved(posterior[i - 1], carrier.steps[i - 1])
        moves[i] = _move_jacobian(posterior[i - 1], prior[i])
        added = carrier.step_variances[i - 1] + ACROSS_GAP * gaps[i - 1]
        prior_of[i] = moves[i] @ posterior_of[i - 1] @ moves[i].T + np.diag(added)
        posterior[i], posterior_of[i] = _updated(prior[i], prior_of[i], positions[i], variance)
    poses, covariances = posterior.copy(), posterior_of.copy()
    for i in range(count - 2, -1, -1):
        gain = np.linalg.solve(prior_of[i + 1], moves[i + 1] @ posterior_of[i]).T
        poses[i] += gain @ (poses[i + 1] - prior[i + 1])
        covariances[i] += gain @ (covariances[i + 1] - prior_of[i + 1]) @ gain.T
    return Smoothed(poses, covariances)


def _moved(pose: FloatArray, step: FloatArray) -> FloatArray:
    return np.append(se2.transform(pose[None], step[:2])[0], pose[2] + step[2])


def _move_jacobian(before: FloatArray, after: FloatArray) -> FloatArray:
    """Derivative (3, 3) of the pose after a step by the one before."""
    jacobian = np.eye(3)
    jacobian[0, 2], jacobian[1, 2] = before[1] - after[1], after[0] - before[0]
    return jacobian


def _updated(
    pose: FloatArray, covariance: FloatArray, position: FloatArray, variance_m2: float
) -> tuple[FloatArray, FloatArray]:
    """Pose and covariance with one measured position, in Joseph form."""
    off = position - pose[:2]
    spread = covariance[:2, :2] + variance_m2 * np.eye(2)
    distance = float(off @ np.linalg.solve(spread, off))
    variance_m2 *= max(1.0, np.sqrt(distance / FAR))  # its pull stays the same however far
    gain = np.linalg.solve(covariance[:2, :2] + variance_m2 * np.eye(2), covariance[:2]).T
    kept = np.eye(3)
    kept[:, :2] -= gain
    updated = kept @ covariance @ kept.T + variance_m2 * gain @ gain.T
    return pose + gain @ off, updated
