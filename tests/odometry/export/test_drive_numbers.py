"""ICRs as the numbers of a differential drive: the same motion, and intervals that follow."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import ParameterError
from odometry.export.drive_numbers import drive_numbers
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.parameters import TerrainParameters

TRACK_M = 0.6
NAMES = ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right")
icrs = st.tuples(
    st.floats(0.05, 5), st.floats(-5, -0.05), st.floats(-3, 3), *[st.floats(0.3, 1.5)] * 2
)
speeds = st.tuples(*[st.floats(-2, 2)] * 2)


def controller(numbers, left_m_s, right_m_s):
    """v_x, v_y, omega of ROS 2's diff_drive_controller, as its odometry computes them."""
    right = right_m_s * numbers.right.value
    left = left_m_s * numbers.left.value
    separation_m = numbers.separation.value * numbers.track_width_m
    return np.array([(right + left) / 2, 0.0, (right - left) / separation_m])


def at_origin(twist, x_m, y_m):
    """The twist of a body at its origin, from that at a point of it: v - omega x r."""
    return twist + twist[2] * np.array([y_m, -x_m, 0.0])


@given(icrs, speeds)
def test_the_controller_at_the_stated_frame_moves_as_the_model(values, treads):
    table = TerrainParameters("icr", dict(zip(NAMES, values, strict=True)))
    numbers = drive_numbers("sand", table, TRACK_M)
    model = MODELS["icr"].twist(np.array(values), Inputs(np.array(treads)))
    twist = controller(numbers, *treads)
    assert twist[2] == pytest.approx(model[2], rel=1e-12, abs=1e-12)
    moved = at_origin(twist, numbers.x_icr_m.value, numbers.y_middle_m.value)
    np.testing.assert_allclose(moved, model, rtol=1e-12, atol=1e-11)


@pytest.mark.parametrize(
    ("model", "values"),
    [
        ("icr_symmetric", {"alpha": 0.9, "b_hat": 1.1}),
        ("traction_mode", {"k": 0.9, "m": 0.5, "track_width": TRACK_M}),
        ("differential_drive", {"track_width": TRACK_M}),
    ],
)
@given(treads=speeds)
def test_symmetric_models_need_no_other_frame(model, values, treads):
    numbers = drive_numbers("sand", TerrainParameters(model, values), TRACK_M)
    expected = MODELS[model].twist(np.array(list(values.values())), Inputs(np.array(treads)))
    np.testing.assert_allclose(controller(numbers, *treads), expected, rtol=1e-12, atol=1e-12)
    assert (numbers.x_icr_m.value, numbers.y_middle_m.value) == (0, 0)
    assert np.isnan(numbers.x_icr_m.low)  # supposed, not identified


def test_turning_slip_is_the_share_of_the_yaw_rate_that_is_lost():
    """On the spot, against wheels that do not slip."""
    values = dict(zip(NAMES, (0.7, -0.5, 0.1, 0.9, 0.8), strict=True))
    numbers = drive_numbers("sand", TerrainParameters("icr", values), TRACK_M)
    omega = controller(numbers, -1.0, 1.0)[2]
    assert numbers.turning_slip.value == pytest.approx(1 - omega / (2 / TRACK_M))


def test_intervals_are_those_of_sampled_parameters(rng):
    """The spread of each number over 20 000 parameters drawn from a full covariance."""
    root = rng.normal(size=(5, 5)) * [0.02, 0.03, 0.01, 0.005, 0.006]
    covariance = root.T @ root
    centre = np.array([0.7, -0.5, 0.1, 0.9, 0.8])
    table = TerrainParameters("icr", dict(zip(NAMES, centre, strict=True)), NAMES, covariance)
    numbers = drive_numbers("sand", table, TRACK_M)
    drawn = rng.multivariate_normal(centre, covariance, size=20_000)
    y_left, y_right, x_icr, left, right = drawn.T
    separation = (y_left - y_right) / TRACK_M
    sampled = {
        "separation": separation,
        "left": left,
        "right": right,
        "x_icr_m": x_icr,
        "y_middle_m": (y_left + y_right) / 2,
        "turning_slip": 1 - (left + right) / 2 / separation,
    }
    for name, values in sampled.items():
        number = getattr(numbers, name)
        half = (number.high - number.low) / 2
        assert half == pytest.approx(1.96 * values.std(), rel=0.04), name
        assert number.value == pytest.approx(values.mean(), abs=0.1 * half), name


def test_what_was_held_has_no_interval_and_spoils_no_other():
    order, sigmas = NAMES[:3], [0.02, 0.03, 0.01]
    table = TerrainParameters(
        "icr", {"y_left": 0.7, "y_right": -0.5, "x_icr": 0.1}, order, np.diag(np.square(sigmas))
    )
    numbers = drive_numbers("sand", table, TRACK_M)
    assert numbers.left.value == 1
    assert np.isnan([numbers.left.low, numbers.right.high]).all()
    half = 1.96 * np.hypot(0.02, 0.03) / TRACK_M
    assert numbers.separation.low == pytest.approx(2 - half)
    assert np.isfinite(numbers.turning_slip.low)


def test_a_model_without_constant_icrs_is_refused():
    table = TerrainParameters("radius_of_curvature", {"alpha": 1.0})
    with pytest.raises(ParameterError, match=r"sand.*radius_of_curvature.*no constant ICRs"):
        drive_numbers("sand", table, TRACK_M)


def test_a_missing_track_width_is_requested():
    table = TerrainParameters("icr", {"y_left": 0.7, "y_right": -0.5, "x_icr": 0.1})
    with pytest.raises(ParameterError, match="--track-width"):
        drive_numbers("sand", table, None)
    told = TerrainParameters("traction_mode", {"k": 0.9, "m": 0.5, "track_width": 0.5})
    assert drive_numbers("sand", told, None).separation.value == pytest.approx(1.8)
