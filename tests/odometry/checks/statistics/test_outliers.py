import numpy as np

from odometry.checks.statistics.outliers import spikes, without_spikes


def test_one_sample_far_out_is_a_spike_and_a_step_is_none(rng):
    speeds = np.concatenate([np.full(50, 0.2), np.full(50, 1.4)]) + rng.normal(0, 0.01, 100)
    assert not spikes(speeds).any()
    speeds[30] = -7.0
    assert np.flatnonzero(spikes(speeds)).tolist() == [30]
    assert abs(without_spikes(speeds)[30] - 0.2) < 0.05


def test_three_samples_may_be_one_spike():
    speeds = np.sin(np.arange(200) / 9)
    speeds[80:83] = 30.0
    assert np.flatnonzero(spikes(speeds)).tolist() == [80, 81, 82]


def test_nothing_is_said_of_few_samples():
    assert not spikes(np.array([0.0, 9.0, 0.0])).any()
