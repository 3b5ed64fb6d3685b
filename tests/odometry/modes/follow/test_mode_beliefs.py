"""Filters that mix and filters that never do take one step at once, as if each took its own."""

import numpy as np
import pytest

from odometry.estimation.imm.markov import ModeChain
from odometry.estimation.imm.mode_belief import ModeBelief
from odometry.modes.follow.mode_beliefs import ModeBeliefs, ModeEstimators
from odometry.modes.follow.tempered_bank import with_shared_bias
from odometry.modes.models.mode_set import ModeSet
from tests.odometry.modes.traction_examples import MODES

CHAIN, INDEPENDENT, STEP_S = ModeChain(np.full(3, 5.0)), 0.4, 0.1
TREADS = np.array([0.5, 0.8])
MEASURED = [
    [0.3, -0.2, 0.4, 0.5],
    [np.nan, np.nan, np.nan, 0.5],
    [np.nan] * 4,
]


@pytest.fixture
def filters():
    made = ModeEstimators(ModeSet(MODES, 5.0), [CHAIN.transition], INDEPENDENT, 1e-6)
    return made.of(0, 0.2)


def random_belief(rng):
    roots = 0.1 * rng.normal(size=(3, 5, 5))
    logs = np.log(rng.dirichlet(np.ones(3)))
    return ModeBelief(0.3 * rng.normal(size=(3, 5)), roots @ roots.swapaxes(1, 2), logs)


@pytest.mark.parametrize("measured", MEASURED)
def test_each_estimate_is_as_if_it_took_the_step_alone(rng, filters, measured):
    together, alone, z = random_belief(rng), random_belief(rng), np.array(measured)
    moved, innovations = filters.step(
        ModeBeliefs(together, alone, filters.imm.merged(together)), (TREADS, z), STEP_S, None
    )
    expected = with_shared_bias(filters.imm.step(together, TREADS, z, STEP_S), INDEPENDENT)
    np.testing.assert_allclose(moved.together.means, expected.means, atol=1e-12)
    np.testing.assert_allclose(moved.together.covariances, expected.covariances, atol=1e-12)
    np.testing.assert_allclose(moved.together.log_probabilities, expected.log_probabilities)

    means, covariances = filters.bank.predicted(alone.means, alone.covariances, TREADS, STEP_S)
    np.testing.assert_allclose(innovations, filters.bank.innovations(means, covariances, z))
    if np.isfinite(z).any():
        means, covariances, *_ = filters.imm.bank.updated(means, covariances, z)
    led = together.log_probabilities.argmax() == moved.together.log_probabilities.argmax()
    stays = np.ones(3, dtype=bool)
    stays[moved.together.log_probabilities.argmax()] = led  # a mode that takes the lead begins anew
    np.testing.assert_allclose(moved.alone.means[stays, :4], means[stays, :4], atol=1e-12)
    assert stays.sum() >= 2
