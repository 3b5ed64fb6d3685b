"""Standing teaches the bias of the gyroscope: readings are drawn about one that is known."""

import numpy as np
import pytest

from odometry.modes.follow.gyroscope_bias import SETTLES_S, moving, standing_biases
from odometry.modes.follow.track import follow_signals
from odometry.modes.recorded.bank_inputs import BIAS_SIGMA_RAD_S, Signals
from tests.odometry.modes.mode_examples import velocity_set

STEP_S, NOISE_RAD_S, SIZE = 0.02, 0.01, 1000
STAMPS_S = STEP_S * np.arange(SIZE)
BIAS_RAD_S = 0.06


def signals_of(stands, bias_rad_s, noise_rad_s=NOISE_RAD_S):
    """Straight on at 0.5 m/s, but between the rows of each stand."""
    speeds = np.full((SIZE, 2), 0.5)
    for first, last in stands:
        speeds[first:last] = 0.0
    omega = bias_rad_s + noise_rad_s * np.random.default_rng(3).normal(size=SIZE)
    measured = np.column_stack([np.full(SIZE, np.nan), omega])
    return Signals(STAMPS_S, speeds, measured, np.full(SIZE, "ice", dtype=object))


def test_a_stand_is_the_mean_of_what_is_read_once_it_settled():
    signals = signals_of([(0, 100), (400, 700)], BIAS_RAD_S)
    found = standing_biases(signals)
    assert list(found) == [100, 700]
    settled = round(SETTLES_S / STEP_S)
    readings = signals.measured[401 + settled : 701, 1]
    bias_rad_s, variance = found[700]
    assert bias_rad_s == pytest.approx(readings.mean())
    assert variance == pytest.approx(NOISE_RAD_S**2 / len(readings), rel=0.2)


@pytest.mark.parametrize(
    ("stands", "bias_rad_s", "noise_rad_s"),
    [
        ([(400, 440)], BIAS_RAD_S, NOISE_RAD_S),  # too short
        ([(400, 700)], 0.5, NOISE_RAD_S),  # it turns though no tread does
        ([(400, 700)], BIAS_RAD_S, 0.0),  # a value that is held
        ([(400, 700)], np.nan, NOISE_RAD_S),
    ],
)
def test_what_is_no_bias_is_not_taken(stands, bias_rad_s, noise_rad_s):
    assert not standing_biases(signals_of(stands, bias_rad_s, noise_rad_s))


def test_a_robot_that_stood_knows_the_bias_from_then_on():
    """It is twelve times what is expected; before the stand a filter has not yet learnt it."""
    signals = signals_of([(400, 600)], BIAS_RAD_S)
    track = follow_signals(signals, velocity_set())
    assert BIAS_RAD_S > 10 * BIAS_SIGMA_RAD_S
    before, after = track.means[[399, 601], -1]
    assert before < BIAS_RAD_S - 0.01
    assert after == pytest.approx(BIAS_RAD_S, abs=4 * NOISE_RAD_S / np.sqrt(175))
    assert track.sigmas[601, -1] < 2 * NOISE_RAD_S / np.sqrt(175)
    np.testing.assert_allclose(track.probabilities[601], track.probabilities[599], atol=0.05)


def test_a_slow_robot_drives_at_what_is_rest_of_others():
    """At 0.008 m/s it turns with the treads; the turn is no bias of a robot of 0.03 m/s."""
    signals = signals_of([(400, 700)], BIAS_RAD_S)
    signals.tread_speeds_m_s[400:700] = [0.005, 0.008]
    assert list(standing_biases(signals, 1.0)) == list(standing_biases(signals)) == [700]
    assert not standing_biases(signals, 0.03)
    assert moving(signals, 0.03).sum() == moving(signals).sum() + 300
