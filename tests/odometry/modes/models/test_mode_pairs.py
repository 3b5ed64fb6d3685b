"""How long it takes to distinguish modes, against closed forms."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.models.mode_pairs import pairs
from tests.odometry.modes.mode_examples import run_of, traction_set, velocity_set


def test_the_time_of_two_velocity_modes_is_that_of_their_likelihoods():
    run, modes = run_of(1.0), velocity_set((1.0, 1.5)).modes
    half = run.odometry["v_right"] - 0.5
    apart = np.mean(((1.5 - 1.0) * 2 * half) ** 2)  # of yaw rates
    modes = replace(modes, errors_last_s=0.3)
    (pair,) = pairs(modes, [run, run])
    assert pair.names == ("ice", "tar")
    assert pair.seconds == pytest.approx(0.3 * max(1.0, np.log(9) * 2 * 0.05**2 / apart))
    (slower,) = pairs(replace(modes, measurement_variance=20 * modes.measurement_variance), [run])
    assert slower.seconds == pytest.approx(0.3 * np.log(9) * 2 * 20 * 0.05**2 / apart)


def test_modes_of_one_gain_differ_in_their_noise_alone():
    modes = velocity_set((1.0, 1.0)).modes
    (same,) = pairs(modes, [run_of(1.0)])
    assert np.isinf(same.seconds)
    noisier = replace(modes, measurement_variance=np.array([[0.01, 0.01], [0.01, 0.02]]))
    (pair,) = pairs(noisier, [run_of(1.0)])
    worse = min(2 - 1 - np.log(2), 0.5 - 1 + np.log(2)) / 2
    assert pair.seconds == pytest.approx(np.log(9) * 0.02 / worse)


def test_noise_distinguishes_no_modes_whose_models_differ_by_little():
    """`modes` takes such modes for equal, whatever their noise."""
    modes = velocity_set((1.0, 1.001)).modes
    (alike,) = pairs(modes, [run_of(1.0)])
    noisier = replace(modes, measurement_variance=np.array([[0.01, 0.01], [0.02, 0.02]]))
    (still_alike,) = pairs(noisier, [run_of(1.0)])
    assert alike.seconds > 1e3
    assert still_alike.seconds > alike.seconds


@pytest.mark.parametrize(("spread", "never"), [(0.1, True), (0.05, False)])
def test_modes_that_differ_by_less_than_one_does_from_turn_to_turn_never_are(spread, never):
    """By a seventh of the gain of the second, of which two deviations are a fifth, or a tenth."""
    modes = replace(velocity_set((6.0, 7.0)).modes, gain_spread=np.array([0.0, spread]))
    (pair,) = pairs(modes, [run_of(1.0)])
    assert np.isinf(pair.seconds) == never


def test_the_most_alike_come_first():
    found = pairs(velocity_set((1.0, 2.0, 2.1), ("a", "b", "c")).modes, [run_of(1.0)])
    assert [pair.names for pair in found] == [("b", "c"), ("a", "b"), ("a", "c")]
    times = [pair.seconds for pair in found]
    assert times == sorted(times, reverse=True)


def test_poses_distinguish_traction_modes_once_those_stand_out_of_their_noise():
    """Of the yaw alone: sqrt-free, from the quadratic (w T)^2 = 2 ln 9 (q T + r)."""
    run, modes = run_of(1.0), traction_set((0.5, 0.8)).modes
    columns = {name: run.odometry[name] for name in ("t", "v_left", "v_right")}
    blind = replace(run, odometry=replace(run.odometry, columns=columns))
    (pair,) = pairs(modes, [blind])
    turn = np.mean((0.3 * 2 * (run.odometry["v_right"] - 0.5) / 0.5) ** 2)
    travel = np.abs(run.odometry.stack("v_left", "v_right")).mean()
    q, r = 1e-4 * travel, 1e-4
    roots = np.roots([turn, -2 * np.log(9) * q, -2 * np.log(9) * r])
    assert pair.seconds == pytest.approx(roots.max(), rel=0.03)
    (sooner,) = pairs(modes, [run])
    assert sooner.seconds < pair.seconds


def test_a_stationary_robot_distinguishes_no_modes():
    run = run_of(1.0)
    columns = run.odometry.columns | {"v_left": np.zeros(400), "v_right": np.zeros(400)}
    still = replace(run, odometry=replace(run.odometry, columns=columns))
    for modes in (velocity_set().modes, traction_set().modes):
        (pair,) = pairs(modes, [still])
        assert np.isinf(pair.seconds)
