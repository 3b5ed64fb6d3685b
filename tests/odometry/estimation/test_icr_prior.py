import numpy as np
import pytest

from odometry.errors import ParameterError
from odometry.estimation.terrain_beliefs import crossed, prior_belief
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.parameters import ParameterSet, TerrainParameters

WIDTH = 0.6
RESET_M, RESET_ALPHA = 0.1, 0.05


def prior_of(table, terrain="here"):
    return prior_belief(ParameterSet({"here": table}), terrain, WIDTH, RESET_M, RESET_ALPHA)


def icr_block(belief):
    assert np.all(belief.covariance[:3, 3:] == 0)
    return belief.covariance[:3, :3]


def test_a_terrain_without_a_table_has_a_broad_prior_centred_on_the_track_width():
    belief = prior_belief(ParameterSet(), "somewhere", WIDTH, RESET_M, RESET_ALPHA)
    np.testing.assert_allclose(belief.icrs, [0.3, -0.3, 0])
    np.testing.assert_array_equal(belief.alphas, [1, 1])
    np.testing.assert_allclose(icr_block(belief), 0.3**2 * np.eye(3))


def test_a_table_without_uncertainty_has_that_of_a_reset():
    belief = prior_of(TerrainParameters("icr", {"y_left": 0.4, "y_right": -0.5, "x_icr": 0.1}))
    np.testing.assert_array_equal(belief.icrs, [0.4, -0.5, 0.1])
    np.testing.assert_allclose(icr_block(belief), RESET_M**2 * np.eye(3))


def test_a_table_with_uncertainty_keeps_it_by_name():
    values = {"y_left": 0.4, "y_right": -0.5, "x_icr": 0.1}
    order, matrix = ("x_icr", "y_left", "y_right"), np.diag([3.0, 1.0, 2.0])
    belief = prior_of(TerrainParameters("icr", values, order, matrix))
    np.testing.assert_array_equal(icr_block(belief), np.diag([1.0, 2.0, 3.0]))


@pytest.mark.parametrize(
    ("model", "values"),
    [
        (
            "icr",
            {"y_left": 0.4, "y_right": -0.5, "x_icr": 0.1, "alpha_left": 0.9, "alpha_right": 0.8},
        ),
        ("icr_symmetric", {"alpha": 0.8, "b_hat": 0.9}),
        ("differential_drive", {"track_width": 0.7}),
        ("traction_mode", {"k": 0.9, "m": 0.6, "track_width": 0.4}),
    ],
)
def test_the_icr_form_moves_as_the_model_does(model, values, rng):
    belief = prior_of(TerrainParameters(model, values))
    as_icr = np.concatenate([belief.icrs, belief.alphas])
    for speeds in rng.uniform(-2, 2, (5, 2)):
        np.testing.assert_allclose(
            MODELS["icr"].twist(as_icr, Inputs(speeds)),
            MODELS[model].twist(MODELS[model].pack(values), Inputs(speeds)),
            atol=1e-14,
        )


def test_the_traction_mode_of_the_conventions():
    """alpha_left = alpha_right = k and y_left - y_right = b k / m."""
    belief = prior_of(TerrainParameters("traction_mode", {"k": 0.9, "m": 0.6, "track_width": 0.4}))
    np.testing.assert_allclose(belief.icrs, [0.3, -0.3, 0])
    np.testing.assert_array_equal(belief.alphas, [0.9, 0.9])


def test_a_model_without_constant_icrs_is_refused():
    values = {"alpha": 0.9, "beta_1": 1.0, "beta_2": 1.0, "track_width": 1.2}
    with pytest.raises(ParameterError, match=r"terrain\.here.*radius_of_curvature"):
        prior_of(TerrainParameters("radius_of_curvature", values))


def test_what_a_table_states_of_one_coordinate_is_kept():
    values = {"y_left": 0.4, "y_right": -0.5, "x_icr": 0.1}
    belief = prior_of(TerrainParameters("icr", values, ("y_left",), np.array([[4e-4]])))
    np.testing.assert_allclose(icr_block(belief), np.diag([4e-4, RESET_M**2, RESET_M**2]))


@pytest.mark.parametrize(
    ("model", "values", "name"),
    [
        ("icr_symmetric", {"alpha": 0.8, "b_hat": 0.9}, "b_hat"),
        ("differential_drive", {"track_width": 0.7}, "track_width"),
    ],
)
def test_half_the_uncertainty_of_a_width_is_that_of_each_side(model, values, name):
    belief = prior_of(TerrainParameters(model, values, (name,), np.array([[0.06**2]])))
    np.testing.assert_allclose(np.sqrt(np.diag(icr_block(belief))), [0.03, 0.03, RESET_M])


@pytest.mark.parametrize(
    ("mode", "expected"),
    [
        ({"k": 0.9, "m": 0.0}, "expected both above 0"),
        ({"k": 0.0, "m": 1.0}, "expected both above 0"),
        ({"k": 0.9, "m": -1.0}, "m = -1.0, expected a finite number from 0"),
    ],
)
def test_a_traction_mode_without_a_width_is_an_error(mode, expected):
    with pytest.raises(ParameterError, match=rf"terrain\.here.*{expected}"):
        prior_of(TerrainParameters("traction_mode", {"track_width": 0.6, **mode}))


def test_the_uncertainty_of_a_traction_mode_is_that_of_its_width():
    """width = b k / m: to first order by hand, the sides as independent as for any width."""
    values = {"k": 0.9, "m": 0.6, "track_width": 0.4}
    covariance = np.array([[4e-4, 1e-4], [1e-4, 9e-4]])
    belief = prior_of(TerrainParameters("traction_mode", values, ("k", "m"), covariance))
    by_k, by_m = 0.4 / 0.6, -0.4 * 0.9 / 0.6**2
    variance = by_k**2 * 4e-4 + 2 * by_k * by_m * 1e-4 + by_m**2 * 9e-4
    np.testing.assert_allclose(
        icr_block(belief), np.diag([variance / 4, variance / 4, RESET_M**2]), atol=1e-15
    )


def test_half_a_traction_mode_determines_no_width():
    values = {"k": 0.9, "m": 0.6, "track_width": 0.4}
    belief = prior_of(TerrainParameters("traction_mode", values, ("k",), np.array([[4e-4]])))
    np.testing.assert_allclose(icr_block(belief), RESET_M**2 * np.eye(3))


def test_correlations_of_icrs_are_kept():
    values = {"y_left": 0.4, "y_right": -0.5, "x_icr": 0.1}
    root = np.array([[0.02, 0.0, 0.0], [0.01, 0.03, 0.0], [0.0, -0.01, 0.02]])
    order = ("y_right", "y_left", "x_icr")
    belief = prior_of(TerrainParameters("icr", values, order, root @ root.T))
    places = [1, 0, 2]
    np.testing.assert_array_equal(icr_block(belief), (root @ root.T)[np.ix_(places, places)])


def test_slip_factors_are_as_uncertain_as_a_table_states_or_a_reset():
    """A symmetric model has one for both treads; two that follow from one are taken as apart."""
    values = {"y_left": 0.4, "y_right": -0.5, "x_icr": 0.1}
    stated = TerrainParameters("icr", values, ("alpha_left",), np.array([[4e-4]]))
    variances = np.diag(prior_of(stated).covariance)[3:]
    np.testing.assert_allclose(variances, [4e-4, RESET_ALPHA**2])
    symmetric = {"alpha": 0.8, "b_hat": 0.9}
    one = prior_of(TerrainParameters("icr_symmetric", symmetric, ("alpha",), np.array([[9e-4]])))
    np.testing.assert_allclose(one.covariance[3:, 3:], np.diag([9e-4, 9e-4]))


def test_both_treads_may_slip_alike_by_more_than_they_may_differ():
    belief = prior_belief(ParameterSet(), "somewhere", WIDTH, RESET_M, RESET_ALPHA)
    of_slip = belief.covariance[3:, 3:]
    together, apart = np.array([0.5, 0.5]), np.array([1.0, -1.0])
    assert together @ of_slip @ together == pytest.approx(0.2**2, rel=0.05)
    assert apart @ of_slip @ apart == pytest.approx(0.05**2)


@pytest.mark.parametrize("order", [(), ("alpha_left",)])
def test_slip_factors_can_be_held_as_given(order):
    values = {"y_left": 0.4, "y_right": -0.5, "x_icr": 0.1}
    table = TerrainParameters("icr", values, order, 4e-4 * np.eye(len(order)))
    for terrain in ("here", "elsewhere"):
        belief = prior_belief(ParameterSet({"here": table}), terrain, WIDTH, RESET_M, 0.0)
        assert np.all(belief.covariance[3:] == 0)
        assert np.all(belief.covariance[:, 3:] == 0)


def test_slip_factors_that_are_held_are_not_correlated_with_the_icrs():
    values = {"y_left": 0.4, "y_right": -0.5, "x_icr": 0.1}
    together = np.array([[4e-4, 1e-4], [1e-4, 4e-4]])
    table = TerrainParameters("icr", values, ("y_left", "alpha_left"), together)
    belief = prior_belief(ParameterSet({"here": table}), "here", WIDTH, RESET_M, 0.0)
    expected = np.diag([4e-4, RESET_M**2, RESET_M**2, 0.0, 0.0])
    np.testing.assert_allclose(belief.covariance, expected)


def test_a_terrain_that_keeps_its_share_opens_nothing(rng):
    """What it would add to the covariance is not even looked up."""
    belief = rng.standard_normal(9), np.eye(9)
    known = {"mud": prior_belief(ParameterSet(), "mud", WIDTH, RESET_M, RESET_ALPHA)}
    mean, covariance = crossed(belief, known, {"mud": 0.4}, {"mud": 0.4}, {})
    np.testing.assert_array_equal(mean, belief[0])
    np.testing.assert_array_equal(covariance, belief[1])


SYMMETRIC = {"alpha": 1.0, "b_hat": 0.9}
SETTING = {"k": 0.9, "m": 0.6, "track_width": 0.4}


@pytest.mark.parametrize("correlation", [-0.99, -0.6, 0.6, 0.99])
@pytest.mark.parametrize(
    ("model", "values", "order"),
    [
        ("icr_symmetric", SYMMETRIC, ("alpha", "b_hat")),
        ("traction_mode", SETTING, ("k", "m")),
        ("icr", {"y_left": 0.4, "y_right": -0.5, "x_icr": 0.1}, ("y_left", "alpha_left")),
    ],
)
def test_the_prior_of_correlated_parameters_is_a_covariance(model, values, order, correlation):
    """Of GNSS positions without yaw slip and width are known as a ratio, far better than each."""
    matrix = 0.06**2 * np.array([[1.0, correlation], [correlation, 1.0]])
    belief = prior_of(TerrainParameters(model, values, order, matrix))
    assert np.linalg.eigvalsh(belief.covariance).min() > -1e-15


def test_a_width_keeps_its_correlation_with_the_slip_factor_of_the_same_tread():
    matrix = np.array([[36e-4, 35e-4], [35e-4, 36e-4]])
    belief = prior_of(TerrainParameters("icr_symmetric", SYMMETRIC, ("alpha", "b_hat"), matrix))
    expected = np.array([[35e-4, 0.0], [0.0, -35e-4], [0.0, 0.0]]) / 2
    np.testing.assert_allclose(belief.covariance[:3, 3:], expected)
