"""What holds for every filter; each row of FILTERS is a way to make one.

The truth is integrated here, by midpoints in fine steps with noise of its own: none of the
package's equations of motion is used.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import chi2

from odometry.estimation.config import PAPER, IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.frames import Frame

WIDTH = 0.5
ICRS = np.array([0.42, -0.33, 0.06])
PRIOR_SIGMA_M = 0.05
POSITION_SIGMA_M, YAW_SIGMA = 0.03, 0.02
POSITION_NOISE, YAW_NOISE, ICR_NOISE_M = 0.01, 0.01, 0.002
STEP_S = 0.1
FINE = 20  # steps of the truth within a step of odometry


def icr_ekf(**changes):
    values = dict(zip(("y_left", "y_right", "x_icr"), ICRS, strict=True))
    table = TerrainParameters("icr", values, tuple(values), PRIOR_SIGMA_M**2 * np.eye(3))
    config = (
        PAPER
        | {
            "position_sigma_m": POSITION_SIGMA_M,
            "yaw_sigma_rad": YAW_SIGMA,
            "position_noise": POSITION_NOISE,
            "yaw_noise": YAW_NOISE,
            "icr_noise_widths": ICR_NOISE_M / WIDTH,
            "gate_probability": 1.0,
        }
        | changes
    )
    return IcrEkf(WIDTH, ParameterSet({"a": table}), IcrEkfConfig(**config))


FILTERS = {"icr_ekf": icr_ekf}
each_filter = pytest.mark.parametrize("make_filter", FILTERS.values(), ids=FILTERS)


def speeds_at(time_s):
    """A weaving drive that excites all three ICR coordinates; (left, right)."""
    return np.array([0.5 + 0.4 * np.sin(0.7 * time_s), 0.5 - 0.4 * np.sin(0.45 * time_s + 1)])


def simulated(rng, runs, steps):
    """True states (steps + 1, runs, 6) under white noise; at each step the speeds hold."""
    state = np.zeros((runs, 6))
    state[:, 3:] = ICRS + rng.normal(0, PRIOR_SIGMA_M, (runs, 3))
    states = [state]
    dt = STEP_S / FINE
    density = [POSITION_NOISE, POSITION_NOISE, YAW_NOISE, *[ICR_NOISE_M] * 3]
    for k in range(steps):
        v_left, v_right = speeds_at(k * STEP_S)
        for _ in range(FINE):
            state = state.copy()
            y_left, y_right, x_icr = state[:, 3:].T
            omega = (v_right - v_left) / (y_left - y_right)
            v_x, v_y = v_left + omega * y_left, -omega * x_icr
            middle = state[:, 2] + omega * dt / 2
            state[:, 0] += (v_x * np.cos(middle) - v_y * np.sin(middle)) * dt
            state[:, 1] += (v_x * np.sin(middle) + v_y * np.cos(middle)) * dt
            state[:, 2] += omega * dt
            state += rng.normal(size=(runs, 6)) * density * np.sqrt(dt)
        states.append(state)
    return np.array(states)


def measured(rng, truth):
    poses = truth[..., :3] + rng.normal(size=(*truth.shape[:-1], 3)) * [
        POSITION_SIGMA_M,
        POSITION_SIGMA_M,
        YAW_SIGMA,
    ]
    poses[..., 2] = np.angle(np.exp(1j * poses[..., 2]))
    return poses


def filtered(ekf, poses, every=1):
    """Estimates at each stamp from poses (N, 3); a pose is shown at every so manieth step."""
    frames = [
        Frame(k * STEP_S, speeds_at(k * STEP_S), k, pose if k % every == 0 else None, None)
        for k, pose in enumerate(poses)
    ]
    estimates = [ekf.start(frames[0], "a")]
    for frame in frames[1:]:
        estimates.append(ekf.step(estimates[-1], frame, "a"))
    return estimates


def assert_covariance(covariance):
    size = np.abs(covariance).max()
    np.testing.assert_allclose(covariance, covariance.T, rtol=0, atol=1e-13 * size)
    assert np.linalg.eigvalsh((covariance + covariance.T) / 2)[0] > -1e-12 * size


@pytest.fixture(scope="module")
def experiments():
    """60 drives of 20 s with a pose at every other step: truth, and the estimates of each."""
    rng = np.random.default_rng(7)
    truth = simulated(rng, runs=60, steps=200)
    poses = measured(rng, truth)
    return truth, poses


@each_filter
def test_nees_lies_in_its_bounds(make_filter, experiments):
    """Mean of e' P^-1 e over 60 runs: chi-squared with 360 degrees over 60, 95 % two-sided.

    Of ten stamps half are bound to be outside once or so by chance; two are allowed. The whole
    state is checked, and the ICRs alone.
    """
    truth, poses = experiments
    estimates = [filtered(make_filter(), poses[:, run], every=2) for run in range(60)]
    stamps = np.arange(20, 201, 20)
    for block, degrees in ((slice(0, 6), 6), (slice(3, 6), 3)):
        nees = []
        for k in stamps:
            total = 0.0
            for run in range(60):
                error = estimates[run][k].mean[:6] - truth[k, run]
                error[2] = np.angle(np.exp(1j * error[2]))
                total += error[block] @ np.linalg.solve(
                    estimates[run][k].covariance[block, block], error[block]
                )
            nees.append(total / 60)
        low, high = chi2.ppf([0.025, 0.975], 60 * degrees) / 60
        inside = [low < value < high for value in nees]
        assert sum(inside) >= 8, nees
        assert inside[-1], nees


@each_filter
def test_it_learns(make_filter, experiments):
    """After 20 s the ICRs are known several times better than at the start, in fact and in P."""
    truth, poses = experiments
    last = [filtered(make_filter(), poses[:, run])[-1] for run in range(20)]
    errors = np.array([e.mean[3:6] - truth[-1, run, 3:] for run, e in enumerate(last)])
    assert np.all(np.sqrt((errors**2).mean(axis=0)) < PRIOR_SIGMA_M / 2)
    for estimate in last:
        assert np.all(np.sqrt(np.diag(estimate.covariance)[3:]) < PRIOR_SIGMA_M / 2)


@each_filter
def test_innovations_are_white(make_filter, experiments):
    """Their mean normalised square is 3, within 95 % bounds widened to 99.9 for 20 runs."""
    _, poses = experiments
    squares = [
        estimate.innovation.normalised_squared
        for run in range(20)
        for estimate in filtered(make_filter(), poses[:, run])[1:]
    ]
    low, high = chi2.ppf([0.0005, 0.9995], 3 * len(squares)) / len(squares)
    assert low < np.mean(squares) < high


@each_filter
def test_the_answer_does_not_depend_on_the_odometry_rate(make_filter, experiments):
    """One recording with speeds at 5 Hz, and the same held speeds written at 20 and 100 Hz.

    The mean moves along exact arcs, which do not depend on the rate. The noise of a step is the
    trapezium rule's, whose error falls with the square of the step: at 5 Hz the variance that the
    yaw noise adds to the position is 3/2 of the limit in each step, which is so little beside the
    rest that no standard deviation changes by 0.1 %, and no mean by 0.5 % of its own. At 20 Hz it
    must be sixteen times less.
    """
    _, poses = experiments
    ekf = make_filter()
    answers = []
    for parts in (1, 4, 20):
        estimate = ekf.start(Frame(0.0, speeds_at(0), 0, poses[0, 0], None), "a")
        for k in range(1, 100 * parts + 1):
            row = k // parts
            stamp_s = row * 0.2 if k % parts == 0 else 0.2 * k / parts
            pose = poses[2 * row, 0] if k % parts == 0 else None
            estimate = ekf.step(estimate, Frame(stamp_s, speeds_at(0.2 * row), k, pose, None), "a")
        answers.append(estimate)
    sigma = np.sqrt(np.diag(answers[-1].covariance)[:6])
    for answer, tolerance in zip(answers[:2], (0.005, 0.005 / 16), strict=True):
        np.testing.assert_array_less(np.abs(answer.mean - answers[-1].mean)[:6] / sigma, tolerance)
        ratio = np.sqrt(np.diag(answer.covariance)[:6]) / sigma
        np.testing.assert_allclose(ratio, 1, atol=0.2 * tolerance)


pose = st.tuples(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4), st.floats(-10, 10))
frames = st.tuples(st.floats(0, 5), st.tuples(st.floats(-5, 5), st.floats(-5, 5)), st.none() | pose)


@pytest.mark.slow
@each_filter
@settings(max_examples=60)
@given(st.lists(frames, min_size=1, max_size=15), st.sampled_from([1.0, 0.99]))
def test_whatever_comes_the_covariance_stays_one(make_filter, sequence, gate_probability):
    """Wild poses, long and empty steps, standstill: symmetric, positive, finite, width kept."""
    ekf = make_filter(gate_probability=gate_probability, gate_patience=2)
    estimate = ekf.start(Frame(0.0, np.zeros(2), 0, None, None), "a")
    stamp_s = 0.0
    for i, (step_s, speeds, measured_pose) in enumerate(sequence):
        stamp_s += step_s
        at = None if measured_pose is None else np.array(measured_pose)
        estimate = ekf.step(
            estimate, Frame(stamp_s, np.array(speeds), i, at, None), "ab"[i % 5 == 4]
        )
        assert np.all(np.isfinite(estimate.mean))
        assert estimate.mean[3] > estimate.mean[4]
        assert_covariance(estimate.covariance)


@each_filter
def test_the_same_input_gives_the_same_answer(make_filter, experiments):
    _, poses = experiments
    ekf = make_filter()
    once, again = filtered(ekf, poses[:50, 0])[-1], filtered(ekf, poses[:50, 0])[-1]
    np.testing.assert_array_equal(once.mean, again.mean)
    np.testing.assert_array_equal(once.covariance, again.covariance)
