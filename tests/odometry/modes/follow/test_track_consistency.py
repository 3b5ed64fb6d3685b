"""Over 50 simulated runs, modes err as much as they say (Bar-Shalom et al. 2001, 5.4).

The truth is drawn here: linear answers by ground, integrated in small steps, the time on each
ground from an exponential law, white noise. Errors do not last, so that every innovation counts.
Grounds that differ by little against the noise: see tests/odometry/estimation/test_imm_consistency.
"""

import numpy as np
import pytest

from odometry.estimation.imm.ekf_bank import EkfBank
from odometry.estimation.imm.estimator import Imm
from odometry.estimation.imm.markov import ModeChain
from odometry.estimation.imm.mode_belief import ModeBelief
from odometry.evaluation.open_loop_consistency import consistency, normalised_squared_errors
from odometry.modes.follow.tempered_bank import TemperedBank, with_shared_bias
from odometry.modes.follow.track import follow_signals
from odometry.modes.models.mode_set import ModeSet
from odometry.modes.models.velocity import FIRST_SIGMAS, VelocityModes
from odometry.modes.recorded.bank_inputs import Signals
from tests.odometry.modes.mode_drives import integrated

RUNS, STEPS, STEP_S = 50, 120, 0.05
DWELL_S = np.array([4.0, 3.0, 2.0])
SHARES = DWELL_S / DWELL_S.sum()  # of all time, as each mode leads to every other equally
A = np.array([[[-4.0, 0.2], [0.0, -6.0]], [[-4.0, 0.0], [0.3, -5.0]], [[-3.0, 0.0], [0.5, -4.0]]])
SETTLED = np.array(
    [[[0.5, 0.5], [-0.7, 0.7]], [[0.48, 0.48], [-0.5, 0.5]], [[0.45, 0.45], [-0.3, 0.3]]]
)
B = -A @ SETTLED
PROCESS = np.array([[0.01, 0.02], [0.015, 0.03], [0.02, 0.04]])
MEASUREMENT = np.array([[0.03, 0.04], [0.03, 0.04], [0.04, 0.05]]) ** 2
FINE = 8


def mode_set(factor=1.0):
    modes = VelocityModes(("a", "b", "c"), A, B, PROCESS * factor, MEASUREMENT * factor)
    assert modes.errors_last_s == 0.0
    return ModeSet(modes, DWELL_S)


def grounds(rng):
    """The mode at each stamp; stays are drawn as exponential times, the first by their shares."""
    mode, until_s, found = rng.choice(3, p=SHARES), 0.0, []
    until_s += rng.exponential(DWELL_S[mode])
    for row in range(STEPS + 1):
        while until_s < row * STEP_S:
            mode = (mode + rng.integers(1, 3)) % 3
            until_s += rng.exponential(DWELL_S[mode])
        found.append(mode)
    return np.array(found)


def simulated(rng):
    """Modes, states, and signals of which the first is not measured."""
    t, modes = STEP_S * np.arange(STEPS + 1), grounds(rng)
    treads = np.column_stack([1.0 + 0.4 * np.sin(t), 1.0 - 0.5 * np.sin(0.6 * t)])
    states = [np.array([treads[0].mean(), 0.0]) + FIRST_SIGMAS[:2] * rng.normal(size=2)]
    bias = FIRST_SIGMAS[2] * rng.normal()
    for mode, u in zip(modes[1:], treads[:-1], strict=True):
        a, b = A[mode], B[mode]
        moved = integrated(lambda q, a=a, b=b, u=u: a @ q + b @ u, states[-1], STEP_S, FINE)
        states.append(moved + np.sqrt(PROCESS[mode] * STEP_S) * rng.normal(size=2))
    states = np.array(states)
    seen = states + np.sqrt(MEASUREMENT[modes]) * rng.normal(size=states.shape)
    seen[:, 1] += bias
    seen[0] = np.nan
    states = np.column_stack([states, np.full(len(t), bias)])
    return modes, states, Signals(t, treads, seen, np.full(len(t), "unknown", dtype=object))


def filtered(factor=1.0, runs=RUNS):
    """NEES and NIS (runs, STEPS), the latter of each run's tracks, and the share of right modes."""
    rng, with_set = np.random.default_rng(12), mode_set(factor)
    modes = with_set.modes
    imm = Imm(TemperedBank(EkfBank(modes.model(), 3), 1.0), ModeChain(DWELL_S).transition)
    nees, nis, right = np.zeros((3, runs, STEPS))
    for run in range(runs):
        truth, states, signals = simulated(rng)
        belief = ModeBelief.alike(*modes.start(signals), SHARES)
        means = []
        for row in range(1, STEPS + 1):
            predicted = imm.predicted(belief, signals.tread_speeds_m_s[row - 1], STEP_S)
            mean, P = imm.merged(predicted)
            R = np.diag(predicted.probabilities @ modes.measurement_variance)
            H = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 1.0]])
            left = signals.measured[row] - H @ mean
            nis[run, row - 1] = normalised_squared_errors(left, H @ P @ H.T + R)
            belief = with_shared_bias(imm.updated(predicted, signals.measured[row]), 1.0)
            mean, P = imm.merged(belief)
            off = (mean - states[row])[:2]  # a bias is one error of the whole run
            nees[run, row - 1] = normalised_squared_errors(off, P[:2, :2])
            right[run, row - 1] = belief.probabilities.argmax() == truth[row]
            means.append(mean)
        if run < 3:  # what is checked here is what `follow_modes` does
            track = follow_signals(signals, with_set)
            np.testing.assert_allclose(track.means[1:], means, atol=1e-12)
    return nees, nis, float(right.mean())


@pytest.mark.slow
def test_nees_and_nis_lie_within_their_bounds():
    """NEES 2.031, NIS 1.984 of 1.950 to 2.051; with noise 25 % wrong they are 1.65 to 2.45.

    Of 120 steps 0.95 are expected inside; 0.88 is the 99.9 % bound of independent steps.
    """
    nees, nis, right = filtered()
    assert right > 0.6
    for squared in (nees, nis):
        result = consistency(squared, 2)
        assert result.mean_bounds[0] < result.mean < result.mean_bounds[1]
        assert result.inside >= 0.88


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_wrong_noise_is_found(factor):
    nees, nis, _ = filtered(factor, runs=15)
    for squared in (nees, nis):
        result = consistency(squared, 2)
        assert not 1.5 < result.mean < 2.7
        assert result.inside < 0.5


def test_innovations_of_the_probable_mode_are_one_on_average():
    rng = np.random.default_rng(13)
    squared = np.array(
        [follow_signals(simulated(rng)[2], mode_set()).normalised_squared for _ in range(10)]
    )
    assert np.isnan(squared[:, 0]).all()
    assert np.nanmean(squared) == pytest.approx(1.0, abs=0.1)
