"""The effective width over the radius of curvature, against Baril 2020 eq. 10-11 as printed."""

import numpy as np
import pytest

from odometry.errors import ParameterError
from odometry.models.inputs import Inputs
from odometry.models.radius_of_curvature import RadiusOfCurvature

MODEL = RadiusOfCurvature()
SNOW = np.array([0.8, 1.36, -0.18, 1.2])  # Table I: the pole is at lambda = 1 / 0.18^2 = 30.9


def printed_twist(values, left, right):
    """Eq. 8 with eq. 10 and 11, for unequal speeds."""
    alpha, beta_1, beta_2, b = values
    curvature = abs((right + left) / (right - left))
    y_0 = b / 2 * (1 + beta_1 / (1 + beta_2 * curvature**0.5))
    return [alpha * (left + right) / 2, 0, alpha * (right - left) / (2 * y_0)]


def at_lambda(curvature):
    """Tread speeds of a left turn with a mean of 1 m/s."""
    return Inputs(np.array([1 - 1 / curvature, 1 + 1 / curvature]))


def test_it_is_what_the_paper_prints_where_the_width_is_positive(rng):
    for low, high in [
        ([0.5, 0.0, 0.0, 0.3], [1, 50, 12, 1.5]),
        ([0.5, -0.9, 0, 0.3], [1, 0, 1, 1]),
    ]:
        for values in rng.uniform(low, high, (20, 4)):
            left, right = rng.uniform(-2, 2, 2)
            twist = MODEL.twist(values, Inputs(np.array([left, right])))
            np.testing.assert_allclose(twist, printed_twist(values, left, right), rtol=1e-12)


@pytest.mark.parametrize(("beta_2", "width"), [(0.5, 1.2), (1e-3, 1.2), (0.0, 1.2 * 2.36)])
def test_the_width_towards_a_straight(beta_2, width):
    """The track width, unless beta_2 = 0 takes the curvature out of eq. 11."""
    values = np.array([0.8, 1.36, beta_2, 1.2])
    for mean in (1.0, -1.0):
        by_speed = MODEL.speed_jacobian(values, Inputs(np.array([mean, mean])))
        np.testing.assert_allclose(by_speed[2], np.array([-0.8, 0.8]) / width, rtol=1e-14)
    far = at_lambda(1e16)
    turn = MODEL.twist(values, far)[2]
    np.testing.assert_allclose(turn, 0.8 * (far.right - far.left) / width, rtol=1e-4)


def test_the_slope_at_a_straight_is_reached_with_the_root_of_the_difference():
    """factor = 1 - beta_1 / beta_2 p / q + ...: the error of a difference falls as sqrt(step)."""
    values = np.array([0.8, 1.36, 0.5, 1.2])
    exact = MODEL.speed_jacobian(values, Inputs(np.array([1.0, 1.0])))[2, 1]
    errors = []
    for step in (1e-6, 1e-8):
        ahead, behind = (
            MODEL.twist(values, Inputs(np.array([1.0, 1.0 + s])))[2] for s in (step, -step)
        )
        errors.append(exact - (ahead - behind) / (2 * step))
    np.testing.assert_allclose(errors[0] / errors[1], 10, rtol=0.01)
    np.testing.assert_allclose(errors[0], exact * 1.36 / 0.5 * (1e-6 / 2) ** 0.5, rtol=0.01)


def test_at_a_standstill_the_slope_is_that_on_the_spot():
    """Width 1.2 (1 + 1.36)."""
    for speeds in ([0.0, 0.0], [-1.0, 1.0]):
        by_speed = MODEL.speed_jacobian(SNOW, Inputs(np.array(speeds)))
        np.testing.assert_allclose(by_speed[2], np.array([-0.8, 0.8]) / (1.2 * 2.36), rtol=1e-14)


def test_on_snow_the_turn_fades_out_at_the_pole_and_stays_out():
    pole = 1 / 0.18**2
    np.testing.assert_allclose(pole, 30.9, atol=0.05)
    curvatures = np.linspace(1, 400, 4000)
    turns = np.array([MODEL.twist(SNOW, at_lambda(c))[2] for c in curvatures])
    ideal = 0.8 * 2 / curvatures / 1.2
    assert np.all(turns[curvatures < pole] > 0)
    assert np.all(turns[curvatures >= pole] == 0)
    assert np.all(np.diff(turns / ideal)[curvatures[1:] < pole] < 0)
    just_below = MODEL.twist(SNOW, at_lambda(pole * (1 - 1e-9)))[2]
    assert 0 < just_below < 1e-9


def test_beyond_the_pole_nothing_changes_the_turn():
    straighter = at_lambda(40.0)
    assert np.all(MODEL.parameter_jacobian(SNOW, straighter)[2] == 0)
    assert np.all(MODEL.speed_jacobian(SNOW, straighter)[2] == 0)


def test_a_width_that_falls_to_zero_is_refused():
    """beta_1 = -0.5, beta_2 = -0.1: zero width at sqrt(lambda) = 5."""
    with pytest.raises(ParameterError, match=r"beta_1 = -0.5 and beta_2 = -0.1"):
        MODEL.pack({"alpha": 1.0, "beta_1": -0.5, "beta_2": -0.1, "track_width": 1.0})
    assert MODEL.pack({"alpha": 1.0, "beta_1": -0.5, "beta_2": 0.1, "track_width": 1.0})[1] == -0.5
