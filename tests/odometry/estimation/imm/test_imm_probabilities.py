"""What the mode probabilities of an IMM must do; its recursion: tests/reference."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.estimation.imm.estimator import Imm, Members
from odometry.estimation.imm.mode_belief import ModeBelief
from tests.odometry.estimation.imm.imm_banks import (
    EVEN,
    LEANING,
    NOTHING,
    Saying,
    two_rates,
)


@pytest.mark.parametrize("z", [None, np.array([np.nan])])
def test_without_a_measurement_the_chain_alone_moves_probabilities(z):
    """0.5 and 0.5 go to 0.65 and 0.35 in one step; filterpy would repeat the last likelihood."""
    imm, belief = two_rates(LEANING)
    seen = imm.step(belief, NOTHING, np.array([0.3]), 0.1)
    for start in (belief, seen):
        later = imm.step(start, NOTHING, z, 0.1)
        np.testing.assert_allclose(
            later.probabilities, start.probabilities @ LEANING, rtol=0, atol=1e-12
        )
        assert later.innovations is None
    assert seen.innovations is not None


def test_the_predicted_probability_weighs_the_likelihood():
    """Eq. 9 as the recursion has it: with c_j = (0.65, 0.35), not with the (0.5, 0.5) before."""
    imm, belief = two_rates(LEANING)
    after = imm.step(belief, NOTHING, np.zeros(1), 0.1)
    logs = after.innovations.log_likelihoods
    odds = np.exp(logs[0] - logs[1]) * 0.65 / 0.35
    assert after.probabilities[0] / after.probabilities[1] == pytest.approx(odds)


@pytest.mark.parametrize("floor", [0.0, 1e-6])
def test_the_better_of_two_hopeless_modes_wins(floor):
    """Where both likelihoods underflow; filterpy leaves the worse mode 0.93."""
    imm = Imm(Members((Saying(-18.9e6), Saying(-6.1e6))), lambda _: np.array(EVEN), floor=floor)
    belief = ModeBelief.alike(np.zeros(1), np.eye(1), np.array([0.93, 0.07]))
    after = imm.step(belief, NOTHING, np.zeros(1), 0.1)
    np.testing.assert_allclose(after.probabilities, [floor, 1 - floor], rtol=1e-9)


def test_a_mode_ruled_out_for_long_comes_back():
    """The floor holds after a thousand steps against a mode; then a few steps bring it back."""
    imm, belief = two_rates(np.eye(2), floor=1e-4)
    position = 0.0
    for _ in range(1000):
        position += 0.1
        belief = imm.step(belief, NOTHING, np.array([position]), 0.1)
    np.testing.assert_allclose(belief.probabilities, [1e-4, 1 - 1e-4], rtol=1e-9)
    for _ in range(20):
        position -= 0.1
        belief = imm.step(belief, NOTHING, np.array([position]), 0.1)
    assert belief.probabilities[0] == pytest.approx(1 - 1e-4)


@pytest.mark.parametrize("floor", [0.0, 1e-3])
def test_a_mode_that_nothing_leads_to_keeps_to_itself(floor):
    """c_1 = 0: its filter goes on from its own state, its probability is the floor."""
    imm, belief = two_rates([[1.0, 0.0], [1.0, 0.0]], floor=floor)
    belief = replace(belief, means=np.array([[0.0], [5.0]]))
    for z in (np.zeros(1), None, np.zeros(1)):
        belief = imm.step(belief, NOTHING, z, 0.1)
        assert np.all(np.isfinite(belief.means))
        assert belief.probabilities[1] == pytest.approx(floor)
        assert np.all(np.isfinite(imm.merged(belief)[1]))
    start = replace(belief, log_probabilities=np.log([0.5, 0.5]))
    predicted = imm.predicted(start, NOTHING, 0.1)
    assert predicted.means[1] == pytest.approx(belief.means[1] + 0.1)
