import numpy as np
import pytest
from scipy.stats import t as student

from odometry.errors import IdentificationError, ParameterError
from odometry.identification.fit import fit
from odometry.identification.start import SolverConfig
from odometry.models.catalogue import MODELS
from odometry.models.icr import Icr
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.motion import window_motion
from odometry.windows.travel.windows import windows_of


@pytest.fixture(scope="module")
def fitted(winding):
    """Fit a model to the run of two minutes, or to another one."""

    def fit_to(model="icr", run=winding, fixed=None, released=(), config=None, **solver):
        config = config or WindowConfig()
        return fit(
            MODELS[model],
            windows_of([run], config),
            run.robot,
            fixed=fixed or {},
            released=frozenset(released),
            window_config=config,
            solver_config=SolverConfig(**{"starts": 1} | solver),
        )

    return fit_to


def test_without_noise_the_truth_comes_back(fitted, synthetic):
    found = fitted()
    assert found.values == pytest.approx(synthetic.icrs, abs=1e-9)
    assert found.names == tuple(synthetic.icrs)
    assert found.scale == pytest.approx(0, abs=1e-9)
    assert (found.undetermined, found.by_trial, found.at_bound) == ((), (), ())
    np.testing.assert_allclose(found.residuals, 0, atol=1e-9)


def test_a_fit_gives_its_numbers_consistently(fitted, winding, synthetic, stated):
    run = synthetic.noisy(winding, np.random.default_rng(1))
    found = fitted(run=run, config=stated, starts=3)
    assert found.packed.tolist() == list(found.values.values())
    assert list(found.values) == list(synthetic.icrs)
    sigmas = np.sqrt(np.diag(found.covariance))
    assert found.sigmas == dict(zip(found.names, sigmas, strict=True))
    for name, freedom in zip(found.names, found.freedom, strict=True):
        half = student.ppf(0.975, freedom) * found.sigmas[name]
        of = found.intervals[name]
        assert (of.low, of.high) == pytest.approx(
            (found.values[name] - half, found.values[name] + half), rel=1e-9
        )
        assert of.freedom == freedom
    expected = window_motion(Icr(), found.packed, found.windows) - found.windows.measured
    expected[:, 2] = np.remainder(expected[:, 2] + np.pi, 2 * np.pi) - np.pi
    np.testing.assert_allclose(found.residuals, expected, rtol=0, atol=1e-14)
    assert found.weights.shape == (len(found.windows),)
    assert 1 <= found.agreeing <= found.starts == 3


def test_fixed_parameters_stay_and_have_no_variance(fitted, synthetic):
    held = {"alpha_left": 0.97, "x_icr": 0.06}
    found = fitted(fixed=held)
    assert found.names == ("y_left", "y_right", "alpha_right")
    assert found.covariance.shape == (3, 3)
    assert found.values == pytest.approx(synthetic.icrs, abs=1e-9)
    wrong = fitted(fixed={"x_icr": 0.2})
    assert wrong.values["x_icr"] == 0.2
    assert np.abs(wrong.residuals).max() > 0.01


def test_what_is_known_is_not_identified_unless_released(fitted, synthetic, tmp_path):
    """Half the width at k = 1 and m = 1 / 2 looks like the whole width at m = 1."""
    odometry = synthetic.commands(np.random.default_rng(2), 600)
    wide = {"y_left": 0.5, "y_right": -0.5, "x_icr": 0.0, "alpha_left": 1.0, "alpha_right": 1.0}
    pose_s = np.arange(0, 59, 0.4)
    run = Run.read(synthetic.write(tmp_path, odometry, pose_s, synthetic.icr_twist(wide)))
    usual = fitted("traction_mode", run)
    assert usual.names == ("k", "m")
    assert usual.values == pytest.approx({"k": 1.0, "m": 0.5, "track_width": 0.5}, abs=1e-9)
    released = fitted("traction_mode", run, fixed={"m": 1.0}, released=["track_width"])
    assert released.names == ("k", "track_width")
    assert released.values == pytest.approx({"k": 1.0, "m": 1.0, "track_width": 1.0}, abs=1e-9)
    alone = fitted("differential_drive", run, released=["track_width"])
    assert alone.values == pytest.approx({"track_width": 1.0}, abs=1e-9)


def test_m_and_the_width_together_are_distinguished_by_nothing(fitted, winding, synthetic):
    run = synthetic.noisy(winding, np.random.default_rng(1))
    found = fitted("traction_mode", run, released=["track_width"])
    (open_,) = found.undetermined
    assert set(open_.direction) == {"m", "track_width"}


@pytest.mark.parametrize("model", ["differential_drive", "icr"])
def test_a_model_of_which_everything_is_given_is_fitted_all_the_same(fitted, synthetic, model):
    """Its residuals, its scale and its errors are still of interest."""
    fixed = synthetic.icrs if model == "icr" else {}
    found = fitted(model, fixed=fixed)
    assert found.names == ()
    assert found.covariance.shape == (0, 0)
    expected = window_motion(MODELS[model], found.packed, found.windows) - found.windows.measured
    np.testing.assert_allclose(found.residuals[:, :2], expected[:, :2], rtol=0, atol=1e-14)


@pytest.mark.parametrize("given", [{"fixed": {"mu": 0.5}}, {"released": ["mu"]}])
def test_an_unknown_name_is_reported_with_the_known_ones(fitted, given):
    with pytest.raises(ParameterError, match=r"'mu' is no parameter of 'icr'.*alpha_left"):
        fitted(**given)


@pytest.mark.parametrize("fixed", [{"alpha_left": 2.5}, {"y_left": -0.5}, {"x_icr": np.nan}])
def test_a_fixed_value_out_of_bounds_is_reported(fitted, fixed):
    (name,) = fixed
    with pytest.raises(ParameterError, match=name):
        fitted(fixed=fixed)


def test_what_is_open_goes_by_the_residuals_where_these_are_larger_than_stated(
    fitted, winding, synthetic
):
    """Noise stated two and eight times too small leaves the same deviations."""
    run = synthetic.noisy(winding, np.random.default_rng(1))
    deviations = []
    for share in (2, 8):
        stated = {name: sigma / share for name, sigma in synthetic.stated.items()}
        found = fitted(run=run, config=WindowConfig(**stated), loss="squares", undetermined=1e-6)
        assert found.scale == pytest.approx(share, rel=0.3)
        assert len(found.undetermined) == 5
        deviations.append([open_.deviation for open_ in found.undetermined])
    np.testing.assert_allclose(*deviations, rtol=1e-3)


def test_what_is_open_goes_by_the_stated_noise_where_the_residuals_are_smaller(
    fitted, winding, synthetic
):
    """Poses that agree by chance determine no more than their sensor can."""
    run = synthetic.noisy(winding, np.random.default_rng(1))
    deviations = []
    for share in (2, 8):
        stated = {name: sigma * share for name, sigma in synthetic.stated.items()}
        found = fitted(run=run, config=WindowConfig(**stated), loss="squares", undetermined=1e-6)
        deviations.append(np.array([open_.deviation for open_ in found.undetermined]))
    np.testing.assert_allclose(deviations[1], 4 * deviations[0], rtol=1e-3)


def test_too_few_windows_tell_how_many_there_are(fitted):
    config = WindowConfig(horizon_m=100.0, shortest=0.5)
    with pytest.raises(
        IdentificationError, match="1 windows do not determine 5 parameters of 'icr'"
    ):
        fitted(config=config)
    found = fitted("icr_symmetric", config=config)
    assert found.names == ("alpha", "b_hat")


def test_a_best_fit_that_contradicts_itself_is_refused(fitted, synthetic, tmp_path):
    """A robot that turns the other way round, with its right ICR held on the left."""
    odometry = synthetic.commands(np.random.default_rng(2), 400)
    mirrored = synthetic.icrs | {"y_left": 0.3, "y_right": 0.9}
    pose_s = np.arange(0, 39, 0.1)
    run = Run.read(synthetic.write(tmp_path, odometry, pose_s, synthetic.icr_twist(mirrored)))
    config = WindowConfig(horizon_m=0.3)
    with pytest.raises(IdentificationError, match=r"best fit of 'icr'.*expected y_left > y_right"):
        fitted(run=run, fixed={"y_right": 0.37}, config=config, starts=8)


@pytest.mark.parametrize("alpha_left", [2.1, -0.1])
def test_what_ends_at_the_edge_of_its_range_is_named(fitted, synthetic, tmp_path, alpha_left):
    odometry = synthetic.commands(np.random.default_rng(3), 400)
    truth = synthetic.icrs | {"alpha_left": alpha_left, "alpha_right": 1.7}
    folder = synthetic.write(tmp_path, odometry, np.arange(0, 39, 0.1), synthetic.icr_twist(truth))
    found = fitted(run=Run.read(folder), config=WindowConfig(horizon_m=0.5))
    assert found.at_bound == ("alpha_left",)


def test_the_same_seed_gives_the_same_bytes(fitted, winding, synthetic):
    run = synthetic.noisy(winding, np.random.default_rng(1))
    one, two = (fitted(run=run, starts=3, seed=8) for _ in range(2))
    assert one.packed.tobytes() == two.packed.tobytes()
    assert one.covariance.tobytes() == two.covariance.tobytes()


def test_a_fixed_sign_is_not_tried(fitted, inertial, synthetic):
    names = ("mass", "x_cm", "y_cm", "track_width", "h")
    found = fitted("icr_inertia", inertial, fixed={name: synthetic.inertia[name] for name in names})
    assert found.by_trial == ()
    assert found.values == pytest.approx(synthetic.inertia, rel=1e-6)


def test_the_force_of_inertia_does_not_determine_the_mass(fitted, inertial, synthetic):
    """Mass times the coefficients is all that shows: a message says so to whoever releases it."""
    run = synthetic.noisy(inertial, np.random.default_rng(1))
    fixed = {name: synthetic.inertia[name] for name in ("x_cm", "y_cm", "track_width", "h")}
    found = fitted("icr_inertia", run, fixed=fixed, released=["mass"])
    assert "mass" in {name for open_ in found.undetermined for name in open_.direction}
