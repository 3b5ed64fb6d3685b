"""ICR kinematics on slopes against a scalar program in the paper's own frame."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from odometry.models.icr import Icr
from odometry.models.icr_slope import IcrSlope
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot

MODEL = IcrSlope()
LAZARO = {
    "y_left": 0.44,
    "y_right": -0.42,
    "x_icr": 0.03,
    "lambda_1": 4.68,
    "lambda_2": 6.54,
    "v_max": 0.28,
    "half_width": 0.2,
    "half_length": 0.2,
}


def paper_attitude(roll, pitch):
    """alpha and phi of Rz(psi) Ry(alpha) Rx(phi), X right and Y forward, of the same body.

    That rotation lifts X by -sin(alpha), Y by sin(phi) cos(alpha) and Z by cos(phi) cos(alpha).
    """
    body = Rotation.from_euler("ZYX", [0.7, pitch, roll]).as_matrix()
    forward, left, up = body[2]
    alpha = math.asin(left)  # X points right
    phi = math.asin(forward / math.cos(alpha))
    assert math.isclose(math.cos(phi) * math.cos(alpha), up)
    return alpha, phi


def paper_icrs(p, alpha, phi, V_l, V_r):
    """Martinez 2024 eq. 5-10 and limits I-III, line by line: x_ICR^l, x_ICR^r, y_ICR."""
    if V_r > V_l:
        sign = 1
    elif V_r < V_l:
        sign = -1
    else:
        sign = 0
    left_over = p["v_max"] - abs(V_r + V_l) / 2
    left_over = max(left_over, 0)
    x_l = -p["y_left"] + sign * left_over * p["lambda_1"] * phi
    x_r = -p["y_right"] + sign * left_over * p["lambda_1"] * phi
    y = p["x_icr"] + sign * left_over * p["lambda_1"] * alpha
    if (V_r > V_l and -phi > abs(alpha)) or (V_r < V_l and phi > abs(alpha)):
        x_l += (1 - abs(alpha / phi)) * sign * left_over * p["lambda_2"] * phi
    if (V_r > V_l and phi > abs(alpha)) or (V_r < V_l and -phi > abs(alpha)):
        x_r += (1 - abs(alpha / phi)) * sign * left_over * p["lambda_2"] * phi
    x_l = min(x_l, -p["half_width"])
    x_r = max(x_r, p["half_width"])
    if abs(y) > p["half_length"]:
        y = math.copysign(p["half_length"], y)
    return x_l, x_r, y


def paper_twist(p, alpha, phi, v_l, v_r):
    """Eq. 11 and 4: v_x to the right, v_y ahead, omega."""
    V_l, V_r = p["alpha_left"] * v_l, p["alpha_right"] * v_r
    x_l, x_r, y = paper_icrs(p, alpha, phi, V_l, V_r)
    D = x_r - x_l
    return (-y * V_l + y * V_r) / D, (x_r * V_l - x_l * V_r) / D, (-V_l + V_r) / D


def random_case(rng):
    named = {
        "y_left": rng.uniform(0.1, 0.8),
        "y_right": -rng.uniform(0.1, 0.8),
        "x_icr": rng.uniform(-0.4, 0.4),
        "alpha_left": rng.uniform(0.8, 1.1),
        "alpha_right": rng.uniform(0.8, 1.1),
        "lambda_1": rng.uniform(0, 5),
        "lambda_2": rng.uniform(0, 7),
        "v_max": rng.uniform(0.2, 1.5),
        "half_width": rng.uniform(0.05, 0.4),
        "half_length": rng.uniform(0.05, 0.6),
    }
    speeds = rng.uniform(-1.2, 1.2, 2) if rng.random() < 0.9 else np.full(2, rng.uniform(-1, 1))
    tilt = rng.uniform(-0.4, 0.4, 2) * rng.choice([0, 1], 2, p=[0.1, 0.9])
    return named, speeds, *tilt


def test_twists_and_icrs_are_those_of_the_paper(rng):
    aggravated = limited = 0
    for _ in range(2000):
        named, (v_l, v_r), roll, pitch = random_case(rng)
        alpha, phi = paper_attitude(roll, pitch)
        values = MODEL.pack(named)
        inputs = Inputs(np.array([v_l, v_r]), np.array(roll), np.array(pitch))
        right, ahead, omega = paper_twist(named, alpha, phi, v_l, v_r)
        expected = [ahead, -right, omega]
        np.testing.assert_allclose(MODEL.twist(values, inputs), expected, rtol=1e-11, atol=1e-13)
        V_l, V_r = named["alpha_left"] * v_l, named["alpha_right"] * v_r
        x_l, x_r, y = paper_icrs(named, alpha, phi, V_l, V_r)
        np.testing.assert_allclose(MODEL.icrs(values, inputs), [-x_l, -x_r, y], atol=1e-13)
        aggravated += abs(phi) > abs(alpha)
        limited += named["half_width"] in (-x_l, x_r)
    assert 600 < aggravated < 1400
    assert limited > 100


def test_level_ground_and_a_straight_are_the_flat_model(rng):
    values = MODEL.pack(LAZARO)
    inputs = Inputs(rng.uniform(-1, 1, (50, 2)))
    np.testing.assert_array_equal(MODEL.twist(values, inputs), Icr().twist(values[:5], inputs))
    straight = Inputs(np.array([0.2, 0.2]), np.array(0.1), np.array(-0.2))
    np.testing.assert_array_equal(MODEL.twist(values, straight), Icr().twist(values[:5], straight))


@pytest.mark.parametrize("speeds", [(0.1, 0.6), (-0.1, -0.6), (0.2, 0.36)])
def test_at_and_above_v_max_a_slope_changes_nothing(speeds):
    values = MODEL.pack(LAZARO)
    inputs = Inputs(np.array(speeds), np.array(0.1), np.array(-0.2))
    np.testing.assert_allclose(MODEL.icrs(values, inputs), values[:3], rtol=1e-12)


def test_nose_up_in_a_left_turn_the_icrs_move_right():
    """sign 1, phi > 0: eq. 5 and 6 add to x, which points right; eq. 10 adds to the right one."""
    values = MODEL.pack({**LAZARO, "half_width": 0.01})
    inputs = Inputs(np.array([-0.2, 0.2]), np.array(0.0), np.array(-0.05))
    shift, lobe = 0.28 * 4.68 * 0.05, 0.28 * 6.54 * 0.05
    np.testing.assert_allclose(
        MODEL.icrs(values, inputs), [0.44 - shift, -0.42 - shift - lobe, 0.03], rtol=1e-12
    )


def test_right_side_down_in_a_left_turn_the_icrs_move_ahead():
    """sign 1, alpha > 0: eq. 7; the roll exceeds the pitch, so nothing is aggravated."""
    values = MODEL.pack(LAZARO)
    inputs = Inputs(np.array([-0.2, 0.2]), np.array(0.05), np.array(0.0))
    np.testing.assert_allclose(
        MODEL.icrs(values, inputs), [0.44, -0.42, 0.03 + 0.28 * 4.68 * 0.05], rtol=1e-12
    )


def test_the_twist_is_continuous_where_its_derivatives_jump():
    values = MODEL.pack(LAZARO)
    tilt = np.array(0.08), np.array(-0.1)
    for speeds in ([0.1, 0.1], [-0.2, 0.2], [0.08, 0.48]):
        near = np.array(speeds) + 1e-9 * np.array([[-1.0, 1.0], [0, 0], [1, -1], [1, 1], [-1, -1]])
        twists = MODEL.twist(values, Inputs(near, *tilt))
        np.testing.assert_allclose(twists, np.broadcast_to(twists[1], (5, 3)), atol=1e-7)


def test_attitudes_of_one_tread_speed_make_a_stack():
    values, rolls = MODEL.pack(LAZARO), np.linspace(-0.1, 0.1, 7)
    inputs = Inputs(np.array([-0.2, 0.2]), rolls, np.array(0.05))
    assert MODEL.icrs(values, inputs).shape == (7, 3)
    assert MODEL.twist(values, inputs).shape == (7, 3)
    assert MODEL.parameter_jacobian(values, inputs).shape == (7, 3, 10)
    assert MODEL.speed_jacobian(values, inputs).shape == (7, 3, 2)


def test_the_guess_takes_the_base_rectangle_from_the_robot():
    assert MODEL.guess(Robot(0.6))["half_length"] == 0.3
    guess = MODEL.guess(Robot(0.6, length=2.0))
    assert (guess["half_width"], guess["half_length"]) == (0.3, 0.7)
