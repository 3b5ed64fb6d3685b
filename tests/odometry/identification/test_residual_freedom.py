"""The moments of the sum of squared residuals, against dense matrices and against noise itself."""

import numpy as np
import pytest

from odometry.identification.problem import Problem
from odometry.identification.uncertainty import residual_freedom
from odometry.models.icr import Icr
from odometry.windows.travel.noise import by_pose_noise, pose_variances
from odometry.windows.travel.windows import windows_of


@pytest.fixture(scope="module")
def problem(winding, synthetic, stated):
    """Twelve windows, each of which shares its poses with its neighbours."""
    windows = windows_of([winding], stated)
    windows = windows.where(np.arange(len(windows)) < 12)
    truth = Icr().pack(synthetic.icrs)
    return Problem(Icr(), windows, truth, np.ones(5, bool), pose_variances(stated))


def dense(problem, root):
    """M N of residuals e = M N z, column by column of the poses' noise."""
    windows, count = problem.windows, len(problem.windows)
    noise = np.zeros((3 * count, 3 * (windows.last_pose.max() + 1)))
    starts, ends = by_pose_noise(windows)
    deviations = np.sqrt(problem.variances)
    for k in range(count):
        for pose, by in ((windows.first_pose[k], starts[k]), (windows.last_pose[k], ends[k])):
            noise[3 * k : 3 * k + 3, 3 * pose : 3 * pose + 3] += root[k] @ by * deviations
    design = (root @ problem.jacobian(problem.values)).reshape(3 * count, -1)
    return noise - design @ np.linalg.lstsq(design, noise, rcond=None)[0]


@pytest.mark.parametrize("weighted", [False, True])
def test_the_moments_are_those_of_dense_matrices(problem, weighted):
    weights = np.linspace(0.2, 1, len(problem.windows)) if weighted else np.ones(12)
    root = np.sqrt(weights)[:, None, None] * problem.whitening
    mean, freedom = residual_freedom(
        problem.windows, root, problem.jacobian(problem.values), problem.variances
    )
    spread = dense(problem, root)
    product = spread.T @ spread
    assert mean == pytest.approx(np.trace(product), rel=1e-9)
    assert freedom == pytest.approx(np.trace(product) ** 2 / np.sum(product**2), rel=1e-9)


def test_sums_of_squares_of_noisy_poses_have_these_moments(problem):
    """The mean is m, the variance 2 m^2 / freedom: four standard errors of 20,000 draws."""
    root = problem.whitening
    mean, freedom = residual_freedom(
        problem.windows, root, problem.jacobian(problem.values), problem.variances
    )
    spread = dense(problem, root)
    draws = np.random.default_rng(5).standard_normal((20_000, spread.shape[1]))
    sums = np.sum((draws @ spread.T) ** 2, axis=1)
    variance = 2 * mean**2 / freedom
    assert sums.mean() == pytest.approx(mean, abs=4 * np.sqrt(variance / len(sums)))
    assert sums.var() == pytest.approx(variance, rel=0.06)


def test_shared_poses_leave_fewer_degrees_than_independent_windows(problem):
    mean, freedom = residual_freedom(
        problem.windows, problem.whitening, problem.jacobian(problem.values), problem.variances
    )
    assert mean == pytest.approx(3 * 12 - 5, rel=0.1)
    assert freedom < 0.9 * (3 * 12 - 5)
