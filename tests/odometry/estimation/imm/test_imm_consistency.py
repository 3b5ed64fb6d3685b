"""The IMM over many simulated runs of a robot whose ground changes by chance.

The truth is drawn from its own equations: linear velocity models by ground, the time on each drawn
from an exponential law, white noise. The mode is not known to the filter.

What is exact: with the right covariance of the error e given the measurements, e' P^-1 e has the
mean n, whatever its law. An IMM's P approximates that covariance. The chi-squared bounds take the
law of e to be Gaussian as well, and a mixture's is not: where grounds differ by little against the
noise it is nearly so; where they differ by much, the innovations of the merged prediction fall in
clusters and their squares spread more than chi-squared, though about the right mean.
"""

import numpy as np
import pytest

from odometry.estimation.imm.ekf_bank import EkfBank, EkfModel
from odometry.estimation.imm.estimator import Imm
from odometry.estimation.imm.markov import ModeChain
from odometry.estimation.imm.mode_belief import ModeBelief
from odometry.evaluation.open_loop_consistency import consistency, normalised_squared_errors

RUNS, STEPS, STEP_S = 100, 200, 0.05
DWELL_S = np.array([4.0, 3.0, 2.0])
F = np.array([[[0.80, 0.0], [0.0, 0.70]], [[0.80, 0.0], [0.0, 0.70]], [[0.90, 0.05], [0.0, 0.85]]])
LIKE_EACH_OTHER = np.array(
    [
        [[0.10, 0.10], [-0.30, 0.30]],
        [[0.08, 0.08], [-0.18, 0.18]],
        [[0.03, 0.03], [-0.05, 0.05]],
    ]
)
FAR_APART = LIKE_EACH_OTHER.mean(axis=0) + 4 * (LIKE_EACH_OTHER - LIKE_EACH_OTHER.mean(axis=0))
Q = np.array([np.diag([0.02, 0.03]), np.diag([0.03, 0.04]), np.diag([0.04, 0.06])]) ** 2
R = np.diag([0.03, 0.02]) ** 2
START = np.diag([0.1, 0.1]) ** 2


def speeds(step):
    return np.array([1.0 + 0.4 * np.sin(0.05 * step), 1.0 - 0.5 * np.sin(0.03 * step)])


def modes_of_a_run(rng):
    """The mode at each stamp after the first: stays drawn as exponential times."""
    mode, until_s, modes = rng.integers(3), 0.0, []
    until_s += rng.exponential(DWELL_S[mode])
    for step in range(1, STEPS + 1):
        while until_s < step * STEP_S:
            mode = (mode + rng.integers(1, 3)) % 3
            until_s += rng.exponential(DWELL_S[mode])
        modes.append(mode)
    return modes


def simulated(rng, G):
    """Modes (STEPS,), states and measurements (STEPS, 2) of one run."""
    state, modes = rng.multivariate_normal([1.0, 0.0], START), modes_of_a_run(rng)
    disturbed, misread = rng.standard_normal((2, STEPS, 2))  # all covariances are diagonal
    states = []
    for step, mode in enumerate(modes):
        moved = F[mode] @ state + G[mode] @ speeds(step)
        state = moved + np.sqrt(np.diag(Q[mode])) * disturbed[step]
        states.append(state)
    return np.array(modes), np.array(states), states + np.sqrt(np.diag(R)) * misread


def imm_of(G, noise_factor):
    model = EkfModel(
        states=2,
        transition=lambda x, u, _: (F @ x[..., None])[..., 0] + G @ u,
        transition_jacobian=lambda *_: F,
        process_noise=lambda *_: Q * noise_factor,
        measurement=lambda x: x,
        measurement_jacobian=lambda _: np.eye(2),
        measurement_covariance=R * noise_factor,
    )
    return Imm(EkfBank(model, 3), ModeChain(DWELL_S).transition)


def filtered(G, noise_factor=1.0, runs=RUNS):
    """NEES and NIS (runs, STEPS), and the share of time in the right mode."""
    rng = np.random.default_rng(5)
    imm = imm_of(G, noise_factor)
    nees, nis, right = np.zeros((3, runs, STEPS))
    for run in range(runs):
        modes, states, seen = simulated(rng, G)
        belief = ModeBelief.alike(np.array([1.0, 0.0]), START, np.full(3, 1 / 3))
        for step in range(STEPS):
            predicted = imm.predicted(belief, speeds(step), STEP_S)
            mean, covariance = imm.merged(predicted)
            S = covariance + R * noise_factor
            nis[run, step] = normalised_squared_errors(seen[step] - mean, S)
            belief = imm.updated(predicted, seen[step])
            mean, covariance = imm.merged(belief)
            nees[run, step] = normalised_squared_errors(mean - states[step], covariance)
            right[run, step] = belief.log_probabilities.argmax() == modes[step]
    return nees, nis, float(right.mean())


def standard_errors_off(squared):
    """Mean over all less 2, in standard errors from the spread between independent runs."""
    means = squared.mean(axis=1)
    return (means.mean() - 2) / (means.std(ddof=1) / np.sqrt(len(means)))


@pytest.mark.slow
def test_terrains_that_are_like_each_other():
    """Both within their 95 % bounds: NEES 1.999, NIS 1.983 of 1.972 to 2.028; 96 and 93 % of steps.

    Of 200 steps 0.95 are expected inside; 0.89 is the 99.9 % bound of independent steps.
    """
    nees, nis, right = filtered(LIKE_EACH_OTHER)
    assert right > 0.9
    for squared in (nees, nis):
        result = consistency(squared, 2)
        assert result.mean_bounds[0] < result.mean < result.mean_bounds[1]
        assert result.inside >= 0.89
        assert abs(standard_errors_off(squared)) < 3


@pytest.mark.slow
def test_terrains_that_are_far_apart():
    """The means hold, 2.006 and 1.960; of the steps' NIS only 54 % lie inside, as said above."""
    nees, nis, right = filtered(FAR_APART, runs=50)
    assert right > 0.99
    assert consistency(nees, 2).inside >= 0.89
    assert abs(standard_errors_off(nees)) < 3
    assert abs(standard_errors_off(nis)) < 3


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_wrong_noise_is_seen(factor):
    """Too sure by a factor of two in all variances, or too timid."""
    nees, nis, _ = filtered(LIKE_EACH_OTHER, factor, runs=20)
    for squared in (nees, nis):
        result = consistency(squared, 2)
        assert not 1.5 < result.mean < 2.7
        assert result.inside < 0.5
