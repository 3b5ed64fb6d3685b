"""Stated covariances against what many noisy runs give.

With the right covariance the errors of S fits, whitened by it, are 5 S independent normal
numbers: their squares add up to chi-squared of 5 S, and the share within 1.96 is binomial. The
bounds are the 0.1 % points of these. Each seed is a run of its own noise.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binom, chi2

from odometry.identification.fit import fit
from odometry.identification.problem import Problem
from odometry.identification.solve import Solution
from odometry.identification.start import SolverConfig
from odometry.identification.uncertainty import parameter_uncertainty, residual_scale
from odometry.models.icr import Icr
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.noise import pose_variances, window_covariances
from odometry.windows.travel.windows import windows_of

SEEDS = range(40)
RARE = 1e-3
MODEL_ERROR_PER_M = np.array([0.02, 0.015, 0.02])  # deviations after a metre: m, m, rad


@pytest.fixture(scope="module")
def driven(synthetic, tmp_path_factory):
    """Three minutes of varied turns, poses at 2 Hz."""
    odometry = synthetic.commands(np.random.default_rng(11), 900, rate_hz=5.0, held=8)
    folder = tmp_path_factory.mktemp("driven") / "run"
    pose_s = np.arange(0.0, 179.5, 0.5)
    return Run.read(synthetic.write(folder, odometry, pose_s, synthetic.icr_twist(synthetic.icrs)))


@pytest.fixture(scope="module")
def errors_of(driven, synthetic):
    """Errors of the parameters (S, 5) and stated covariances (S, 5, 5)."""
    truth = Icr().pack(synthetic.icrs)

    def errors(config, loss="huber", model_error=(0, 0, 0), **noise):
        errors, covariances = [], []
        for seed in SEEDS:
            rng = np.random.default_rng([seed, 77])
            windows = windows_of([synthetic.noisy(driven, rng, **noise)], config)
            own = rng.standard_normal((len(windows), 3)) * model_error
            own *= np.sqrt(windows.travel_m)[:, None]
            found = fit(
                Icr(),
                replace(windows, measured=windows.measured + own),
                driven.robot,
                fixed={},
                window_config=config,
                solver_config=SolverConfig(loss=loss, starts=1),
            )
            errors.append(found.packed - truth)
            covariances.append(found.covariance)
        return np.array(errors), np.array(covariances)

    return errors


def assert_covers(errors, covariances):
    factors = np.linalg.cholesky(covariances)
    whitened = np.linalg.solve(factors, errors[..., None])[..., 0]
    freedom = whitened.size
    total = np.sum(whitened**2)
    assert chi2.ppf(RARE, freedom) < total < chi2.ppf(1 - RARE, freedom), total / freedom
    inside = np.sum(np.abs(whitened) < 1.96)
    assert inside >= binom.ppf(RARE, freedom, 0.95), inside / freedom
    # Parameter by parameter, too: each count is binomial, and all are bounded together.
    sigmas = np.sqrt(np.diagonal(covariances, axis1=1, axis2=2))
    counts = np.sum(np.abs(errors) < 1.96 * sigmas, axis=0)
    assert np.all(counts >= binom.ppf(RARE / errors.shape[1], len(errors), 0.95)), counts


@pytest.mark.parametrize("loss", ["huber", "squares", "linear"])
def test_the_noise_of_the_poses(errors_of, stated, loss):
    """1 cm and 0.3 degrees, stated as they are; neighbouring windows share a pose."""
    assert_covers(*errors_of(stated, loss))


def test_the_noise_of_the_poses_in_overlapping_windows(errors_of, stated):
    """Half the windows are copies and add nothing; the covariance shows it."""
    assert_covers(*errors_of(replace(stated, stride=0.5), "squares"))


def test_noise_stated_three_times_too_large(errors_of, synthetic):
    """The residuals say that the poses are better than stated."""
    config = WindowConfig(**{name: 3 * sigma for name, sigma in synthetic.stated.items()})
    assert_covers(*errors_of(config, "squares"))


@pytest.mark.parametrize("loss", ["huber", "squares"])
def test_a_model_with_errors_of_its_own(errors_of, stated, loss):
    """Added to each window alone: three times what the poses' noise explains."""
    assert_covers(*errors_of(stated, loss, model_error=MODEL_ERROR_PER_M))


def test_large_errors_of_the_model_and_hardly_any_noise(errors_of, stated):
    large = 3 * MODEL_ERROR_PER_M
    assert_covers(*errors_of(stated, "squares", model_error=large, position_m=1e-4))


@pytest.fixture
def problem(driven, synthetic, stated):
    windows = windows_of([driven], stated)
    truth = Icr().pack(synthetic.icrs)
    return Problem(Icr(), windows, truth, np.ones(5, bool), pose_variances(stated))


def test_scale_is_the_root_mean_square_over_the_degrees_of_freedom(problem, synthetic):
    """Residuals of known whitened size: two standard deviations along the first axis each."""
    truth = Icr().pack(synthetic.icrs)
    factors = np.linalg.cholesky(window_covariances(problem.windows, problem.variances))
    windows = replace(problem.windows, measured=problem.windows.measured - 2 * factors[:, :, 0])
    shifted = replace(problem, windows=windows)
    count = len(windows)
    for weights in (np.ones(count), np.linspace(0.5, 1, count)):
        scale = residual_scale(shifted, Solution(truth, weights, 0.0, 1))
        expected = np.sqrt(4 * weights.sum() / (3 * weights.sum() - 5))
        assert scale == pytest.approx(expected, rel=1e-3)


def test_covariance_does_not_depend_on_the_sizes(problem, synthetic):
    """They only keep the inversion well scaled."""
    windows = replace(
        problem.windows, measured=problem.windows.measured + np.array([0.02, -0.01, 0.01])
    )
    solution = Solution(Icr().pack(synthetic.icrs), np.ones(len(windows)), 0.0, 1)
    one, two = (
        parameter_uncertainty(
            replace(problem, windows=windows), solution, np.array(sizes)
        ).covariance
        for sizes in ([1.0] * 5, [0.4, 0.3, 0.2, 1, 7])
    )
    np.testing.assert_allclose(one, two, rtol=1e-8)
    np.testing.assert_array_equal(one, one.T)


def repeated(windows, times):
    names = ("first", "last", "first_pose", "last_pose", "measured", "travel_m", "start_s")
    names += ("run", "terrain")
    return replace(windows, **{n: np.repeat(getattr(windows, n), times, axis=0) for n in names})


def test_without_surplus_it_is_the_sandwich_of_the_poses_noise(problem, synthetic):
    """By a dense sum over every pose.

    Every window stands there four times, with residuals of one deviation along each axis whose
    signs are orthogonal: together they have exactly the stated covariance.
    """
    truth = Icr().pack(synthetic.icrs)
    factors = np.linalg.cholesky(window_covariances(problem.windows, problem.variances))
    signs = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    windows = repeated(problem.windows, 4)
    size = np.sqrt(1 - 5 / (3 * len(windows)))  # gives back the degrees of freedom
    residuals = np.einsum("kij,sj->ksi", factors, size * signs).reshape(-1, 3)
    spread = replace(problem, windows=replace(windows, measured=windows.measured - residuals))

    jacobian, inverse = spread.jacobian(truth), np.linalg.inv(factors @ factors.swapaxes(1, 2))
    inverse = np.repeat(inverse, 4, axis=0)
    bread = np.linalg.inv(np.einsum("kif,kij,kjg->fg", jacobian, inverse, jacobian))
    by_pose = np.zeros((5, windows.last_pose.max() + 1, 3))
    for k, (i, j) in enumerate(zip(windows.first_pose, windows.last_pose, strict=True)):
        x, y, yaw = windows.measured[k]
        cosine, sine = np.cos(yaw), np.sin(yaw)
        ahead = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
        behind = np.array([[-1, 0, y], [0, -1, -x], [0, 0, -1]])
        by_pose[:, i] += jacobian[k].T @ inverse[k] @ behind
        by_pose[:, j] += jacobian[k].T @ inverse[k] @ ahead
    flat = (by_pose * np.sqrt(problem.variances)).reshape(5, -1)
    expected = bread @ flat @ flat.T @ bread

    solution = Solution(truth, np.ones(len(windows)), 0.0, 1)
    stated = parameter_uncertainty(spread, solution, np.ones(5)).covariance
    units = np.outer(*2 * [np.sqrt(np.diag(expected))])
    np.testing.assert_allclose(stated / units, expected / units, rtol=0, atol=1e-2)


def test_windows_that_stand_there_twice_say_no_more(driven, synthetic, stated, rng):
    """The model's own errors are equal on the same way; so few windows make no groups."""
    truth = Icr().pack(synthetic.icrs)
    windows = windows_of([driven], stated)
    windows = windows.where(np.arange(len(windows)) < 14)
    own = rng.standard_normal((14, 3)) * np.sqrt(windows.travel_m)[:, None]
    once = replace(windows, measured=windows.measured + 0.2 * own)
    covariances = []
    for of in (once, repeated(once, 2)):
        problem = Problem(Icr(), of, truth, np.ones(5, bool), pose_variances(stated))
        solution = Solution(truth, np.ones(len(of)), 0.0, 1)
        covariances.append(parameter_uncertainty(problem, solution, np.ones(5)).covariance)
    np.testing.assert_allclose(np.diag(covariances[1]), np.diag(covariances[0]), rtol=0.15)
