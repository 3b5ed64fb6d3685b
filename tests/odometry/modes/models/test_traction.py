from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from odometry.models.inputs import Inputs
from odometry.models.symmetric import TractionMode
from odometry.modes.models.traction import (
    LEFT_TURN,
    RIGHT_TURN,
    TractionModes,
    requested,
    turns_of,
    twists_of,
)
from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.vehicle import read_contact_vehicle
from tests.odometry.modes.mode_drives import asked_twists, integrated
from tests.odometry.modes.traction_examples import GAINS, LAGS_S, MODES, WIDTH

VEHICLE = Path(__file__).parents[4] / "data" / "vehicles" / "husky_like.toml"
states = arrays(float, (3, 5), elements=st.floats(-3, 3))
speeds = arrays(float, 2, elements=st.floats(-1.5, 1.5))
steps_s = st.floats(0.005, 0.3)


def finely(state, u, lasts_s, mode, pieces=2000):
    """Eq. 3 with its gains of this turn, the yaw rate following them with a lag."""
    v_x, v_y, wanted = asked_twists(GAINS[mode], [u], WIDTH)[0]
    lag_s = max(LAGS_S[mode], 1e-3)

    def rates(q):
        c, s = np.cos(q[2]), np.sin(q[2])
        moved = [c * v_x - s * v_y, s * v_x + c * v_y, q[3], (wanted - q[3]) / lag_s]
        return np.array([*moved, 0.0])  # the bias stays

    return integrated(rates, state, lasts_s, pieces)


def angle_apart(first, second):
    return np.angle(np.exp(1j * (first - second)))


@pytest.mark.parametrize("u", [(0.4, 0.9), (0.9, 0.4), (-0.6, -0.2), (0.7, 0.7), (-0.5, 0.5)])
def test_yaw_and_its_rate_are_what_small_steps_make(u):
    start = np.array(
        [[0.3, -0.2, 3.0, 0.5, 0.1], [1.0, 2.0, -1.0, -0.7, 0.0], [0.0, 0.0, 0.4, 0.0, -0.1]]
    )
    moved = MODES.model().transition(start, np.array(u), 0.25)
    for mode in range(3):
        expected = finely(start[mode], u, 0.25, mode)
        assert abs(angle_apart(moved[mode, 2], expected[2])) < 1e-8
        assert moved[mode, 3] == pytest.approx(expected[3], abs=1e-8)
        assert moved[mode, 4] == start[mode, 4]


@pytest.mark.parametrize("mode", [1, 2])
def test_the_place_is_of_second_order(mode):
    """The yaw rate of a step is its mean: half the step, a quarter of the error or less."""
    move, u = MODES.model().transition, np.array([0.2, 0.9])
    start = np.tile([0.3, -0.2, 1.0, -1.0, 0.0], (3, 1))
    truth = finely(start[mode], u, 0.4, mode)
    errors = []
    for steps in (4, 8, 16):
        state = start
        for _ in range(steps):
            state = move(state, u, 0.4 / steps)
        errors.append(np.hypot(*(state[mode, :2] - truth[:2])))
    assert errors[0] < 2e-3
    assert errors[1] < 0.27 * errors[0]
    assert errors[2] < 0.27 * errors[1]


def test_a_settled_turn_is_an_exact_arc():
    u = np.array([0.2, 0.9])
    wanted = np.array([asked_twists(of, [u], WIDTH)[0, 2] for of in GAINS])
    start = np.column_stack([np.zeros((3, 3)), wanted, np.zeros(3)])
    moved = MODES.model().transition(start, u, 1.0)
    for mode in range(3):
        np.testing.assert_allclose(moved[mode], finely(start[mode], u, 1.0, mode), atol=1e-9)


@given(states, speeds, steps_s)
def test_the_jacobian_is_that_of_differences(x, u, step_s):
    model = MODES.model()
    columns = []
    for h in 1e-5 * np.eye(5):
        ahead, behind = (model.transition(x + s * h, u, step_s) for s in (1, -1))
        apart = ahead - behind
        apart[:, 2] = angle_apart(ahead[:, 2], behind[:, 2])
        columns.append(apart / 2e-5)
    jacobian = model.transition_jacobian(x, u, step_s)
    np.testing.assert_allclose(jacobian, np.stack(columns, axis=-1), atol=2e-9)


@given(speeds)
def test_the_side_of_the_turning_centre_chooses_the_gains(u):
    expected = [asked_twists(of, [u], WIDTH)[0] for of in GAINS]
    np.testing.assert_allclose(twists_of(GAINS, u, WIDTH), expected, atol=1e-14)


def test_what_was_requested_by_hand():
    """u_1 = 3, w = 4, h^2 = 25; to the left, to the right, the first backward, on the spot."""
    left, turn = [1.0, 5.0], 4 / WIDTH
    square, wide, aside = 3 * 16 / 25, 4 * 9 / 25, 9 * turn
    for treads, expected, side in [
        (left, [3, turn, square, wide, aside], LEFT_TURN),
        (left[::-1], [3, -turn, square, -wide, -aside], RIGHT_TURN),
        ([-1.0, -5.0], [-3, -turn, -square, -wide, aside], LEFT_TURN),
        ([-5.0, -1.0], [-3, turn, -square, wide, -aside], RIGHT_TURN),
        ([-2.0, 2.0], [0, turn, 0, 0, 0], LEFT_TURN),
        ([0.0, 0.0], [0, 0, 0, 0, 0], LEFT_TURN),
    ]:
        np.testing.assert_allclose(requested(np.array(treads), WIDTH), expected, atol=1e-12)
        assert turns_of(np.array(treads)) == side


def test_inertia_pushes_outward_also_backward():
    """As in the contact simulator: the lateral speed of a turn is that of the turn driven back."""
    vehicle = read_contact_vehicle(VEHICLE)
    treads = np.array([0.4, 1.0])
    aside, inertia = [], []
    for back in (1.0, -1.0):
        found = simulate_contact(vehicle, np.tile(back * treads, (100, 1)), 0.02)
        aside.append(found.twists_body[-1, 1])
        inertia.append(requested(back * treads, WIDTH)[4])
    assert aside[0] == pytest.approx(aside[1], rel=1e-3)
    assert aside[0] < -0.01
    assert inertia[0] == inertia[1] > 0


@given(speeds, st.floats(0.1, 5))
def test_all_but_what_inertia_adds_grows_with_the_treads_and_goes_back(u, factor):
    gains = GAINS * [1, 1, 1, 1, 0]
    once = twists_of(gains, u, WIDTH)
    np.testing.assert_allclose(twists_of(gains, factor * u, WIDTH), factor * once, atol=1e-12)
    np.testing.assert_allclose(twists_of(gains, -u, WIDTH), -once, atol=1e-12)


@pytest.mark.parametrize("at", [(0.8, 0.8), (-0.8, -0.8), (-0.5, 0.5), (0.5, -0.5), (0.0, 0.0)])
def test_twists_do_not_jump_where_a_left_turn_becomes_a_right_one(at):
    """Where the turns share what u_1 and u_2 move: on straights, and on the spot."""
    gains = GAINS.copy()
    gains[:, 1, :, :2] = gains[:, 0, :, :2]
    around = np.array(at) + 1e-7 * np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
    assert set(turns_of(around).tolist()) == {LEFT_TURN, RIGHT_TURN}
    twists = twists_of(gains[0], around, WIDTH)
    np.testing.assert_allclose(twists, np.broadcast_to(twists[0], twists.shape), atol=1e-6)


def test_gains_by_hand():
    """u_1 = 2, u_2 = +-4 and w = +-2: rows of the gains times u_1 and u_2, then the others."""
    gains = np.zeros((2, 3, 5))
    gains[..., :2] = np.arange(12).reshape(2, 3, 2)
    np.testing.assert_allclose(twists_of(gains, np.array([1.0, 3.0]), WIDTH), [4, 16, 28])
    np.testing.assert_allclose(twists_of(gains, np.array([3.0, 1.0]), WIDTH), [-16, -20, -24])
    gains[0, :, 2:] = np.arange(9).reshape(3, 3)
    square, wide, aside = 2 * 4 / 8, 2 * 4 / 8, 4 * 4
    expected = [4 + wide + 2 * aside, 16 + 3 * square + 4 * wide + 5 * aside]
    expected.append(28 + 6 * square + 7 * wide + 8 * aside)
    np.testing.assert_allclose(twists_of(gains, np.array([1.0, 3.0]), WIDTH), expected)


@given(arrays(float, (7, 2), elements=st.floats(-2, 2)), st.floats(0.3, 1.5), st.floats(0.1, 1.5))
def test_the_papers_gains_are_the_traction_mode(treads, k, m):
    gains = np.zeros((2, 3, 5))
    gains[:, 0, 0], gains[:, 2, 1] = k, m
    of_model = TractionMode().twist(np.array([k, m, WIDTH]), Inputs(treads))
    np.testing.assert_allclose(twists_of(gains, treads, WIDTH), of_model, atol=1e-13)


def test_k_and_m_are_where_eq_3_has_them():
    gains = np.zeros((1, 2, 3, 5))
    gains[0, :, 0, 0], gains[0, :, 2, 1] = [0.9, 0.8], [0.5, 0.4]
    modes = TractionModes(
        ("x",), gains, LAGS_S[:1], WIDTH, MODES.process_variance, MODES.measurement_variance
    )
    np.testing.assert_array_equal(modes.k, [[0.9, 0.8]])
    np.testing.assert_array_equal(modes.m, [[0.5, 0.4]])


@pytest.mark.parametrize("speed", [1e-3, -1e-3])
def test_m_is_the_share_of_wide_slow_turns(speed):
    for side, turn in ((1, LEFT_TURN), (-1, RIGHT_TURN)):
        treads = speed * np.array([1 - 1e-4 * side, 1 + 1e-4 * side])
        straight = twists_of(MODES.gains, np.full(2, speed), WIDTH)[:, 2]
        asked = 2e-4 * side * speed / WIDTH
        share = (twists_of(MODES.gains, treads, WIDTH)[:, 2] - straight) / asked
        if turn == RIGHT_TURN:  # straight is a left turn, whose gain of u_1 is its own here
            share += (MODES.gains[:, 0, 2, 0] - MODES.gains[:, 1, 2, 0]) * speed / asked
        np.testing.assert_allclose(share, MODES.m[:, turn], atol=1e-3)


def test_what_is_measured_is_the_state_and_the_bias_of_the_gyroscope():
    model, x = MODES.model(), np.random.default_rng(3).normal(size=(3, 5))
    expected = np.column_stack([x[:, :3], x[:, 3] + x[:, 4]])
    np.testing.assert_allclose(model.measurement(x), expected)
    np.testing.assert_allclose(model.measurement_jacobian(x) @ x[0], expected[0])


def test_the_yaw_is_an_angle_to_the_filters():
    model = MODES.model()
    assert model.state_angles == model.measurement_angles == (2,)
