import numpy as np
import pytest
from scipy.optimize import minimize

from odometry.estimation.kalman import (
    gate_threshold,
    normalised_squared,
    project_above,
    project_into,
)


@pytest.mark.parametrize("probability", [0.5, 0.95, 0.9999])
def test_the_gate_of_two_dimensions_in_closed_form(probability):
    """In two dimensions the squared length is exponential with mean 2."""
    assert gate_threshold(probability, 2) == pytest.approx(-2 * np.log(1 - probability), rel=1e-12)


def test_the_gate_of_three_dimensions_from_a_printed_table():
    """Chi-squared with 3 degrees of freedom, upper 5 % and 1 %: 7.815 and 11.345."""
    assert gate_threshold(0.95, 3) == pytest.approx(7.815, abs=5e-4)
    assert gate_threshold(0.99, 3) == pytest.approx(11.345, abs=5e-4)


def test_a_gate_of_certainty_refuses_nothing():
    assert gate_threshold(1.0, 3) == np.inf


def test_normalised_squared_by_hand():
    covariance = np.array([[4.0, 0.0], [0.0, 0.25]])
    assert normalised_squared(np.array([2.0, 1.0]), covariance) == pytest.approx(1 + 4)


def test_what_obeys_is_left_alone(rng):
    mean = rng.normal(size=3)
    assert project_above(mean, np.eye(3), np.array([1.0, 0, 0]), mean[0] - 1) is mean


def test_projection_is_the_most_probable_point_that_obeys(rng):
    for _ in range(5):
        root = rng.normal(size=(4, 4))
        covariance, mean, direction = root @ root.T, rng.normal(size=4), rng.normal(size=4)
        least = float(direction @ mean) + 2.0
        projected = project_above(mean, covariance, direction, least)
        information = np.linalg.inv(covariance)
        best = minimize(
            lambda x, m=mean, i=information: (x - m) @ i @ (x - m),
            mean,
            jac=lambda x, m=mean, i=information: 2 * i @ (x - m),
            constraints={"type": "eq", "fun": lambda x, d=direction, b=least: d @ x - b},
            method="SLSQP",
            options={"ftol": 1e-14, "maxiter": 500},
        )
        assert direction @ projected == pytest.approx(least)
        cost = (projected - mean) @ information @ (projected - mean)
        assert cost == pytest.approx(best.fun, rel=1e-5)


@pytest.mark.parametrize("seed", range(20))
def test_two_constraints_give_the_nearest_point_of_a_search(seed):
    """Against scipy's constrained minimiser of the squared Mahalanobis distance."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(3, 3))
    covariance, mean = root @ root.T + 0.1 * np.eye(3), rng.normal(size=3)
    directions, least = np.array([[1.0, 0, 0], [0, -1.0, 0]]), rng.uniform(-0.5, 1.5, 2)
    found = project_into(mean, covariance, directions, least)
    bound = {"type": "ineq", "fun": lambda x: directions @ x - least}
    inverse = np.linalg.inv(covariance)
    best = minimize(
        lambda x: (x - mean) @ inverse @ (x - mean),
        mean + 5,
        constraints=bound,
        options={"ftol": 1e-14, "maxiter": 500},
    )
    assert np.all(directions @ found >= least - 1e-9)
    cost = (found - mean) @ inverse @ (found - mean)
    assert cost == pytest.approx(best.fun, rel=1e-4, abs=1e-6)
