"""Two stages on a run over flat ground and up and down a plane, driven by Martinez 2024 eq. 5-11.

Bounds of chi-squared are 0.1 % points, see test_uncertainty.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from odometry.errors import IdentificationError, ParameterError
from odometry.identification.fit import fit
from odometry.identification.problem import Problem
from odometry.identification.slopes import fit_in_two_stages, mean_tilt_rad
from odometry.identification.solve import solve
from odometry.identification.start import SolverConfig
from odometry.models.icr_slope import IcrSlope
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.noise import pose_variances
from odometry.windows.travel.windows import windows_of

NAMES = ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right", "lambda_1", "lambda_2")
TILT_RAD = 0.15
FLAT_S = 60.0
BASE = ("v_max", "half_width", "half_length")
SEEDS = range(60)
RARE = 1e-3


@pytest.fixture(scope="module")
def sloped(synthetic, tmp_path_factory):
    """A minute of turns on the flat, and one on a plane."""
    odometry = synthetic.commands(np.random.default_rng(21), 600, rate_hz=5.0, held=8)
    on_plane = synthetic.plane(TILT_RAD)

    def attitude_of(stamp_s, yaw):
        return on_plane(stamp_s, yaw) if stamp_s >= FLAT_S else (0.0, 0.0)

    return Run.read(
        synthetic.write(
            tmp_path_factory.mktemp("sloped") / "run",
            odometry,
            np.arange(0, 119.5, 0.3),
            synthetic.slope_twist(synthetic.slope),
            attitude_of=attitude_of,
        )
    )


@pytest.fixture(scope="module")
def in_two_stages(sloped, synthetic):
    base = {name: synthetic.slope[name] for name in BASE}

    def fit_to(run=sloped, config=None, *, fixed=base, released=(), windows=None, loss="huber"):
        config = config or WindowConfig()
        return fit_in_two_stages(
            IcrSlope(),
            windows_of([run], config) if windows is None else windows,
            run.robot,
            stages=IcrSlope.stages,
            fixed=fixed,
            released=frozenset(released),
            window_config=config,
            solver_config=SolverConfig(starts=1, loss=loss),
        )

    return fit_to


def test_all_parameters_come_back_without_noise(in_two_stages, synthetic):
    found = in_two_stages()
    assert found.names == NAMES
    assert found.values == pytest.approx(synthetic.slope, abs=1e-7)
    assert found.undetermined == ()


def test_the_window_that_enters_the_slope_is_of_the_second_stage(sloped, in_two_stages):
    """Only the windows after the flat minute, and the one across its end, are tilted."""
    windows = windows_of([sloped], WindowConfig())
    tilted = mean_tilt_rad(windows) > np.radians(1.5)
    duration_s = np.array(
        [windows.steps_s[i:j].sum() for i, j in zip(windows.first, windows.last, strict=True)]
    )
    np.testing.assert_array_equal(tilted, windows.start_s + duration_s > FLAT_S + 1)
    found = in_two_stages()
    assert len(found.windows) == len(found.residuals) == len(found.weights) == len(windows)


def test_tilt_is_that_of_the_plane(sloped):
    """The angle between the body's z and the vertical does not change with the heading."""
    windows = windows_of([sloped], WindowConfig())
    tilt = mean_tilt_rad(windows)
    on_plane = windows.start_s >= FLAT_S
    assert on_plane.sum() > 5
    np.testing.assert_allclose(tilt[on_plane], TILT_RAD, rtol=1e-9)


def test_the_first_stage_hears_nothing_of_the_slope(in_two_stages, sloped, synthetic):
    """Motion on the slope that is measured wrongly moves lambda_1 and lambda_2 alone."""
    windows = windows_of([sloped], WindowConfig())
    tilted = mean_tilt_rad(windows) > np.radians(1.5)
    spoilt = replace(windows, measured=windows.measured + 0.05 * tilted[:, None])
    found = in_two_stages(windows=spoilt)
    for name in NAMES[:5]:
        assert found.values[name] == pytest.approx(synthetic.slope[name], abs=1e-7)
    assert abs(found.values["lambda_1"] - synthetic.slope["lambda_1"]) > 1e-3


def test_v_max_is_the_largest_mean_tread_speed_unless_it_is_fixed(in_two_stages, sloped, synthetic):
    fixed = {name: synthetic.slope[name] for name in BASE if name != "v_max"}
    speeds = sloped.odometry.stack("v_left", "v_right")
    largest = max(abs(left + right) / 2 for left, right in speeds)
    assert in_two_stages(fixed=fixed).values["v_max"] == pytest.approx(largest, rel=1e-12)
    assert in_two_stages(fixed=fixed | {"v_max": 1.2}).values["v_max"] == 1.2


def test_fixed_parameters_of_either_stage_stay(in_two_stages, synthetic):
    fixed = {name: synthetic.slope[name] for name in BASE}
    held = {"alpha_left": synthetic.slope["alpha_left"], "lambda_2": synthetic.slope["lambda_2"]}
    found = in_two_stages(fixed=fixed | held)
    assert found.names == tuple(name for name in NAMES if name not in held)
    assert found.covariance.shape == (5, 5)
    assert found.values == pytest.approx(synthetic.slope, abs=1e-7)


def test_an_unknown_name_is_reported(in_two_stages):
    with pytest.raises(ParameterError, match="'mu' is no parameter of 'icr_slope'"):
        in_two_stages(fixed={"mu": 0.5})


@pytest.mark.parametrize(
    ("flat", "words"),
    [
        (True, r"0 windows are tilted more than 1\.5 degrees .*lambda_1, lambda_2"),
        (False, r"0 windows lie on terrain flatter than 1\.5 degrees, too few for y_left"),
    ],
)
def test_a_stage_without_windows_is_reported(in_two_stages, sloped, flat, words):
    windows = windows_of([sloped], WindowConfig())
    tilted = mean_tilt_rad(windows) > np.radians(1.5)
    with pytest.raises(IdentificationError, match=words):
        in_two_stages(windows=windows.where(~tilted if flat else tilted))


def test_with_the_icrs_given_a_run_on_the_slope_alone_will_do(in_two_stages, sloped, synthetic):
    """As the refusal of a run without flat ground proposes: "or fix these"."""
    windows = windows_of([sloped], WindowConfig())
    tilted = windows.where(mean_tilt_rad(windows) > np.radians(1.5))
    held = {name: value for name, value in synthetic.slope.items() if "lambda" not in name}
    found = in_two_stages(windows=tilted, fixed=held)
    assert found.names == ("lambda_1", "lambda_2")
    assert found.values == pytest.approx(synthetic.slope, abs=1e-7)


def test_two_stages_and_all_at_once_agree_within_their_deviations(
    in_two_stages, sloped, synthetic, stated
):
    """A joint search over all windows; it has more data, so its errors are part of the other's."""
    run = synthetic.noisy(sloped, np.random.default_rng(1))
    found = in_two_stages(run, stated)
    free = np.array([name in NAMES for name in synthetic.slope])
    windows = windows_of([run], stated)
    values = IcrSlope().pack(synthetic.slope)
    problem = Problem(IcrSlope(), windows, values, free, pose_variances(stated))
    sizes = np.array([0.4, 0.4, 0.25, 1, 1, 1, 1])
    joint = solve(problem, values[free], sizes, SolverConfig(starts=1))
    sigmas = np.array(list(found.sigmas.values()))
    assert np.all(np.abs(found.packed[free] - joint.chosen) < 3.5 * sigmas)
    assert np.any(np.abs(found.packed[free] - joint.chosen) > 0.01 * sigmas)


@pytest.fixture(scope="module")
def many(in_two_stages, sloped, synthetic, stated):
    """Errors (S, 7) and stated covariances (S, 7, 7) of noisy runs."""
    truth = np.array([synthetic.slope[name] for name in NAMES])
    errors, covariances = [], []
    for seed in SEEDS:
        run = synthetic.noisy(sloped, np.random.default_rng([seed, 31]))
        found = in_two_stages(run, stated, loss="squares")
        errors.append([found.values[name] for name in NAMES] - truth)
        covariances.append(found.covariance)
    return np.array(errors), np.array(covariances)


def assert_not_too_small_and_at_most_twice_too_large(total, freedom, rare):
    """Of variances: what residuals have beyond the stated noise counts where it is positive.

    With the fifteen windows of a stage that alone makes them a third larger.
    """
    low, high = chi2.ppf([rare, 1 - rare], freedom)
    assert np.all((low / 2 < total) & (total < high)), total / freedom


@pytest.mark.slow
def test_joint_covariance_by_many_draws(many):
    errors, covariances = many
    factors = np.linalg.cholesky(covariances)
    whitened = np.linalg.solve(factors, errors[..., None])[..., 0]
    for part in (whitened, whitened[:, 5:]):  # all; the lambdas given the ICRs of level ground
        assert_not_too_small_and_at_most_twice_too_large(np.sum(part**2), part.size, RARE)


def test_variance_of_each_parameter_by_many_draws(many):
    errors, covariances = many
    variances = np.diagonal(covariances, axis1=1, axis2=2)
    totals = np.sum(errors**2 / variances, axis=0)
    assert_not_too_small_and_at_most_twice_too_large(totals, len(errors), RARE / 7)


def test_cross_terms_are_how_the_lambdas_follow_the_icrs(in_two_stages, sloped, synthetic, stated):
    """Fit the second stage again with each parameter of the first a little off."""
    run = synthetic.noisy(sloped, np.random.default_rng(2))
    found = in_two_stages(run, stated, loss="squares")
    base = {name: synthetic.slope[name] for name in BASE}
    level = {name: found.values[name] for name in NAMES[:5]}

    def second_stage(held):
        return fit(
            IcrSlope(),
            found.windows.where(mean_tilt_rad(found.windows) > np.radians(1.5)),
            run.robot,
            fixed=base | held,
            window_config=stated,
            solver_config=SolverConfig(starts=1, loss="squares"),
        )

    step, moves = 1e-4, np.zeros((2, 5))
    for i, name in enumerate(NAMES[:5]):
        ends = [second_stage(level | {name: level[name] + sign * step}).values for sign in (1, -1)]
        moves[:, i] = [(ends[0][lam] - ends[1][lam]) / (2 * step) for lam in NAMES[5:]]
    flat, alone = found.covariance[:5, :5], second_stage(level).covariance
    expected = np.block([[flat, flat @ moves.T], [moves @ flat, alone + moves @ flat @ moves.T]])
    unit = np.outer(*2 * [np.sqrt(np.diag(expected))])
    # Gauss-Newton's curvature leaves out what the residuals bend: some hundredths.
    np.testing.assert_allclose(found.covariance / unit, expected / unit, rtol=0, atol=0.05)
