"""The least loss, against a general minimiser of the printed loss over plain dead reckoning."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import chi2

from odometry.identification.problem import PROBLEMS, Problem
from odometry.identification.solve import solve
from odometry.identification.start import SolverConfig
from odometry.models.icr import Icr
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.noise import pose_variances
from odometry.windows.travel.windows import windows_of

NAMES = ("y_left", "y_right", "x_icr")
FREE = np.array([True, True, True, False, False])
START, SIZES = np.array([0.375, -0.375, 0.0]), np.array([0.375, 0.375, 0.25])
OUTLIERS = 0.05


@pytest.fixture(scope="module")
def short(synthetic, tmp_path_factory):
    """Forty seconds, and the rows that drove it."""
    odometry = synthetic.commands(np.random.default_rng(3), 400)
    folder = tmp_path_factory.mktemp("short") / "run"
    pose_s = np.arange(0, 39.9, 0.3)
    run = Run.read(synthetic.write(folder, odometry, pose_s, synthetic.icr_twist(synthetic.icrs)))
    return odometry, synthetic.noisy(run, np.random.default_rng(4))


def problem_of(run, synthetic, config, free=FREE):
    windows = windows_of([run], config)
    values = Icr().pack(synthetic.icrs)
    return Problem(Icr(), windows, values, free, pose_variances(config))


def inverse_covariance(first, second, config, between):
    """Of the measured motion, by finite differences over the noise of both poses."""
    sigmas = [config.position_sigma_m, config.position_sigma_m, config.yaw_sigma_rad]
    columns = []
    for i, sigma in enumerate(sigmas):
        for ends in ((1, 0), (0, 1)):
            noise = 1e-6 * np.eye(3)[i]
            change = between(first + ends[0] * noise, second + ends[1] * noise)
            columns.append((change - between(first, second)) / 1e-6 * sigma)
    return np.linalg.inv(np.transpose(columns) @ np.array(columns))


class PlainLoss:
    """Baril 2020 eq. 13 over one plain dead reckoning of the whole run."""

    def __init__(self, short, problem, synthetic, config):
        self.odometry, run = short
        self.synthetic = synthetic
        self.pose_s = run.pose.stamps_s
        poses = run.pose.stack("x", "y", "yaw")
        windows = problem.windows
        self.ends = list(zip(windows.first_pose, windows.last_pose, strict=True))
        self.measured = [synthetic.between(poses[i], poses[j]) for i, j in self.ends]
        self.inverse = [
            inverse_covariance(poses[i], poses[j], config, synthetic.between) for i, j in self.ends
        ]

    def squares(self, chosen):
        """Squared Mahalanobis distances (K,)."""
        values = self.synthetic.icrs | dict(zip(NAMES, chosen, strict=True))
        twist_of = self.synthetic.icr_twist(values)
        path, _ = self.synthetic.walk(self.odometry, self.pose_s, twist_of)
        found = []
        for (i, j), measured, inverse in zip(self.ends, self.measured, self.inverse, strict=True):
            error = measured - self.synthetic.between(path[i], path[j])
            error[2] = np.remainder(error[2] + np.pi, 2 * np.pi) - np.pi
            found.append(error @ inverse @ error)
        return np.array(found)

    def least(self, of_squares):
        options = {"xatol": 1e-9, "fatol": 1e-12, "maxiter": 2000, "maxfev": 4000}
        return minimize(
            lambda chosen: of_squares(self.squares(chosen)),
            [0.44, -0.37, 0.05],
            method="Nelder-Mead",
            options=options,
        )


def test_squares_are_least_over_plain_dead_reckoning(short, synthetic, stated):
    problem = problem_of(short[1], synthetic, stated)
    solution = solve(problem, START, SIZES, SolverConfig(loss="squares", starts=1))
    expected = PlainLoss(short, problem, synthetic, stated).least(np.sum)
    np.testing.assert_allclose(solution.chosen, expected.x, rtol=0, atol=1e-7)
    assert solution.cost == pytest.approx(expected.fun, rel=1e-6)
    assert np.all(solution.weights == 1)


def test_linear_is_the_loss_of_the_paper_with_its_identity_covariance(short, synthetic, stated):
    """A metre weighs as a radian, whatever noise is stated."""
    windows = problem_of(short[1], synthetic, stated)
    problem = PROBLEMS["linear"](Icr(), windows.windows, windows.values, FREE, windows.variances)
    solution = solve(problem, START, SIZES, SolverConfig(loss="linear", starts=1))
    plain = PlainLoss(short, problem, synthetic, stated)
    plain.inverse = [np.eye(3)] * len(plain.inverse)
    expected = plain.least(np.sum)
    np.testing.assert_allclose(solution.chosen, expected.x, rtol=0, atol=1e-7)
    assert solution.cost == pytest.approx(expected.fun, rel=1e-6)
    weighted = solve(windows, START, SIZES, SolverConfig(loss="squares", starts=1))
    assert np.abs(weighted.chosen - solution.chosen).max() > 1e-4


def test_huber_is_least_for_the_scale_of_its_own_residuals(short, synthetic, stated):
    """Huber's function by its definition; its cut-off is in units of the median's scale.

    Reweighting ends within a hundredth of a standard deviation (2 mm here) of the minimum.
    """
    odometry, run = short
    columns = dict(run.pose.columns) | {"x": run.pose["x"].copy()}
    columns["x"][[20, 75]] += [0.1, -0.15]
    run = replace(run, pose=replace(run.pose, columns=columns))
    config = replace(stated, horizon_m=1.0, stride=0.5)
    problem = problem_of(run, synthetic, config)
    solution = solve(problem, START, SIZES, SolverConfig(starts=1))
    plain = PlainLoss((odometry, run), problem, synthetic, config)
    distances = np.sqrt(plain.squares(solution.chosen))
    cutoff = np.sqrt(chi2.ppf(0.95, 3)) * np.median(distances) / np.sqrt(chi2.median(3))
    assert 2 <= np.sum(distances > cutoff) <= 0.2 * len(distances)

    def loss(squares):
        far = np.sqrt(squares)
        return np.sum(np.where(far < cutoff, far**2, 2 * cutoff * far - cutoff**2))

    expected = plain.least(loss)
    np.testing.assert_allclose(solution.chosen, expected.x, rtol=0, atol=2e-5)
    assert solution.cost == pytest.approx(loss(distances**2), rel=1e-6)
    np.testing.assert_allclose(solution.weights, np.minimum(1, cutoff / distances), atol=2e-3)


@pytest.mark.parametrize("loss", ["huber", "squares"])
def test_without_noise_the_truth_is_found_from_far_away(winding, synthetic, loss):
    problem = problem_of(winding, synthetic, WindowConfig(), np.ones(5, bool))
    start, sizes = np.array([1.5, -0.1, 0.4, 0.4, 1.6]), np.array([0.4, 0.4, 0.25, 1, 1])
    solution = solve(problem, start, sizes, SolverConfig(loss=loss))
    np.testing.assert_allclose(solution.chosen, list(synthetic.icrs.values()), rtol=0, atol=1e-9)
    assert solution.agreeing == 4


def with_outliers(problem, rng):
    """One window in twenty measured half a metre and a radian off."""
    windows = problem.windows
    count = round(OUTLIERS * len(windows))
    wrong = rng.choice(len(windows), count, replace=False)
    measured = windows.measured.copy()
    measured[wrong] += [0.5, -0.4, 1.0]
    spoilt = replace(windows, measured=measured)
    return Problem(problem.model, spoilt, problem.values, problem.free, problem.variances), wrong


def test_huber_shrugs_off_gross_outliers_and_squares_do_not(winding, synthetic):
    run = synthetic.noisy(winding, np.random.default_rng(6))
    config = WindowConfig(**synthetic.stated, horizon_m=1.0)
    clean = problem_of(run, synthetic, config, np.ones(5, bool))
    assert len(clean.windows) >= 40
    spoilt, wrong = with_outliers(clean, np.random.default_rng(7))
    truth, sizes = np.array(list(synthetic.icrs.values())), np.array([0.4, 0.4, 0.25, 1, 1])
    weighted = np.einsum("kij,kjf->kif", clean.whitening, clean.jacobian(truth)).reshape(-1, 5)
    sigmas = np.sqrt(np.diag(np.linalg.inv(weighted.T @ weighted)))
    shifts = {}
    for loss in ("huber", "squares"):
        config = SolverConfig(loss=loss, starts=1)
        alone = solve(clean, truth, sizes, config)
        solution = solve(spoilt, truth, sizes, config)
        shifts[loss] = np.abs(solution.chosen - alone.chosen) / sigmas
        if loss == "huber":
            others = np.delete(solution.weights, wrong)
            assert np.all(solution.weights[wrong] < 0.15)
            assert np.mean(others == 1) > 0.8
    assert np.all(shifts["huber"] < 1.5)
    assert np.max(shifts["squares"]) > 5


def test_at_a_bound_only_what_lies_beyond_would_be_better(synthetic, tmp_path):
    """Treads that go 2.2 times as far as they say: both factors end at their bound of 2."""
    odometry = synthetic.commands(np.random.default_rng(3), 400)
    truth = synthetic.icrs | {"alpha_left": 2.2, "alpha_right": 2.2}
    folder = synthetic.write(tmp_path, odometry, np.arange(0, 39, 0.1), synthetic.icr_twist(truth))
    config = WindowConfig(horizon_m=0.5)
    problem = problem_of(Run.read(folder), synthetic, config, np.ones(5, bool))
    start, sizes = np.array([0.4, -0.4, 0, 3.0, 3.0]), np.array([0.4, 0.4, 0.25, 1, 1])
    solution = solve(problem, start, sizes, SolverConfig(loss="squares", starts=1))
    low, high = problem.bounds()
    assert np.all((low <= solution.chosen) & (solution.chosen <= high))
    np.testing.assert_allclose(solution.chosen[3:], 2.0, rtol=0, atol=1e-6)
    whitening = problem.whitening
    whitened = np.einsum("kij,kj->ki", whitening, problem.residuals(solution.chosen))
    gradient = np.einsum("ki,kif->f", whitened, whitening @ problem.jacobian(solution.chosen))
    assert np.all(gradient[3:] * sizes[3:] < -1e-3 * solution.cost)
    np.testing.assert_allclose(gradient[:3] * sizes[:3], 0, atol=1e-5 * solution.cost)


def test_the_same_seed_gives_the_same_bytes(short, synthetic, stated):
    problem = problem_of(short[1], synthetic, stated)
    one, two = (solve(problem, START, SIZES, SolverConfig(seed=5)) for _ in range(2))
    assert one.chosen.tobytes() == two.chosen.tobytes()
    assert one.weights.tobytes() == two.weights.tobytes()
    other = solve(problem, START, SIZES, SolverConfig(seed=6))
    np.testing.assert_allclose(other.chosen, one.chosen, rtol=0, atol=1e-5)


class TwoMinima:
    """A curve with its least loss at 3 and another minimum at -3; the start is above the latter."""

    name = "two_minima"
    windows = (None,) * 4

    def bounds(self):
        return np.array([-10.0]), np.array([10.0])

    @property
    def whitening(self):
        return np.broadcast_to(np.eye(3), (4, 3, 3))

    def residuals(self, chosen):
        return np.tile([(chosen[0] ** 2 - 9) / 6, 0.1 * (chosen[0] - 3), 0.2], (4, 1))

    def jacobian(self, chosen):
        return np.tile([[chosen[0] / 3], [0.1], [0.0]], (4, 1, 1))

    def linearised(self, chosen):
        return self.residuals(chosen), self.jacobian(chosen)


def test_further_starts_find_a_better_minimum_and_count_themselves():
    """The first start alone slides into the worse one."""
    start, sizes = np.array([-4.0]), np.array([15.0])
    alone = solve(TwoMinima(), start, sizes, SolverConfig(loss="squares", starts=1))
    assert alone.chosen[0] == pytest.approx(-3, abs=0.1)
    together = solve(TwoMinima(), start, sizes, SolverConfig(loss="squares", starts=8))
    assert together.chosen[0] == pytest.approx(3, abs=1e-6)
    assert 1 <= together.agreeing < 8
    assert together.cost < alone.cost
