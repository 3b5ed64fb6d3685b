import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import ParameterError
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.recorded.bank_inputs import BIAS_SIGMA_RAD_S, BIAS_WALK_RAD2_S3
from tests.odometry.modes.mode_drives import integrated, run_of_tables

NAMES = ("ice", "mud", "tar")
A = np.array(
    [
        [[-2.0, 0.3], [0.1, -3.0]],
        [[-4.0, -0.5], [0.8, -6.0]],
        [[-1.0, 20.0], [-20.0, -1.0]],  # swings: eigenvalues -1 +- 20i
    ]
)
B = np.array([[[1.0, 1.1], [-2.5, 2.4]], [[1.7, 1.9], [-5.0, 4.0]], [[0.4, 0.5], [-1.0, 1.3]]])
PROCESS = np.array([[1e-3, 2e-3], [3e-3, 4e-3], [5e-3, 6e-3]])
MODES = VelocityModes(NAMES, A, B, PROCESS, 10 * PROCESS)
microseconds = st.integers(1, 400_000)
speeds = st.tuples(st.floats(-3, 3), st.floats(-3, 3)).map(np.array)


WITH_BIAS = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 1.0]])


def states_of(seed):
    return np.random.default_rng(seed).normal(size=(3, 3))


def moved(states, u, step_s, pieces=300):
    """Speed and yaw rate in small steps; the bias stays."""
    rates = integrated(
        lambda q: np.einsum("mij,mj->mi", A, q) + B @ u, states[:, :2], step_s, pieces
    )
    return np.column_stack([rates, states[:, 2]])


@given(st.integers(0, 99), speeds, microseconds)
def test_a_step_is_what_small_steps_make(seed, u, step_us):
    states, step_s = states_of(seed), step_us * 1e-6
    expected = moved(states, u, step_s)
    np.testing.assert_allclose(MODES.model().transition(states, u, step_s), expected, atol=1e-6)


@given(st.integers(0, 99), speeds, microseconds, microseconds)
def test_splitting_a_step_changes_nothing(seed, u, first_us, second_us):
    move, states = MODES.model().transition, states_of(seed)
    halfway = move(states, u, first_us * 1e-6)
    whole = move(states, u, (first_us + second_us) * 1e-6)
    np.testing.assert_allclose(move(halfway, u, second_us * 1e-6), whole, atol=1e-12)


@given(st.integers(0, 99), speeds, microseconds)
def test_the_jacobian_is_that_of_differences(seed, u, step_us):
    model, states, step_s = MODES.model(), states_of(seed), step_us * 1e-6
    columns = [
        (model.transition(states + h, u, step_s) - model.transition(states - h, u, step_s)) / 2e-3
        for h in 1e-3 * np.eye(3)
    ]
    jacobian = model.transition_jacobian(states, u, step_s)
    np.testing.assert_allclose(jacobian, np.stack(columns, axis=-1), atol=1e-11)


def test_no_time_moves_nothing():
    model, states = MODES.model(), states_of(0)
    np.testing.assert_allclose(model.transition(states, np.ones(2), 0.0), states, atol=1e-15)


def test_other_modes_are_not_mistaken_for_these():
    other = VelocityModes(NAMES, 2 * A, B, PROCESS, PROCESS)
    states, u = states_of(1), np.ones(2)
    first, second = (one.model().transition(states, u, 0.1) for one in (MODES, other))
    assert np.abs(first - second)[:, :2].min() > 1e-4


def test_steady_gains_by_cramers_rule():
    for gains, a, b in zip(MODES.steady_gains(), A, B, strict=True):
        determinant = a[0, 0] * a[1, 1] - a[0, 1] * a[1, 0]
        adjugate = np.array([[a[1, 1], -a[0, 1]], [-a[1, 0], a[0, 0]]])
        np.testing.assert_allclose(gains, -adjugate @ b / determinant, rtol=1e-12)


@given(speeds)
def test_steady_gains_are_what_a_long_time_makes(u):
    settled = MODES.model().transition(states_of(2), u, 60.0)
    np.testing.assert_allclose(settled[:, :2], MODES.steady_gains() @ u, atol=1e-10)


def test_process_noise_is_that_of_the_table_and_linear_in_time():
    noise = MODES.model().process_noise
    blank = np.zeros((3, 3)), np.zeros(2)
    expected = [np.diag([*row, BIAS_WALK_RAD2_S3]) for row in PROCESS]
    np.testing.assert_array_equal(noise(*blank, 1.0), expected)
    slower = MODES.model(independent=0.25).process_noise(*blank, 1.0)
    np.testing.assert_allclose(slower[:, 2, 2], BIAS_WALK_RAD2_S3 / 4)
    split = noise(*blank, 0.3) + noise(*blank, 0.7)
    np.testing.assert_allclose(split, noise(*blank, 1.0), rtol=1e-14)


def test_what_is_measured_is_the_state_and_the_bias_of_the_gyroscope():
    model, states = MODES.model(), states_of(3)
    expected = [[speed, omega + bias] for speed, omega, bias in states]
    np.testing.assert_allclose(model.measurement(states), expected)
    np.testing.assert_array_equal(model.measurement_jacobian(states), WITH_BIAS)
    np.testing.assert_array_equal(
        model.measurement_covariance, [np.diag(10 * row) for row in PROCESS]
    )


@pytest.mark.parametrize("rate", [10.0, 1e3])
def test_a_mode_that_runs_away_is_refused_by_name(rate):
    away = A.copy()
    away[1] = [[rate, 0.0], [5.0, -2.0]]
    with pytest.raises(ParameterError, match=rf"\[mode\.mud\] A: grows at {rate:g} per second"):
        VelocityModes(NAMES, away, B, PROCESS, PROCESS)
    away[1, 0, 0] = 9.9
    VelocityModes(NAMES, away, B, PROCESS, PROCESS)


@pytest.mark.parametrize(("gyro", "omega"), [(0.3, 0.3), (np.nan, 0.0)])
def test_it_starts_as_the_wheels_turn(gyro, omega):
    t = np.array([0.0, 0.1])
    columns = {"t": t, "v_left": t + 0.4, "v_right": t + 0.8, "gyro_z": np.array([gyro, 0.9])}
    mean, covariance = MODES.start(MODES.signals(run_of_tables(columns)), 0.5)
    np.testing.assert_allclose(mean, [0.6, omega, 0.0])
    expected = np.diag([0.25, 0.25, 0.5 * BIAS_SIGMA_RAD_S**2])
    np.testing.assert_allclose(covariance, expected)
