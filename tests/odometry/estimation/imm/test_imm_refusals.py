"""What an IMM cannot take, it refuses in words."""

import numpy as np
import pytest

from odometry.errors import EstimationError
from odometry.estimation.imm.estimator import Imm, Members
from odometry.estimation.imm.mode_belief import ModeBelief
from tests.odometry.estimation.imm.imm_banks import EVEN, NOTHING, Saying, two_rates


@pytest.mark.parametrize("floor", [-0.1, 0.5, np.nan])
def test_a_floor_that_cannot_hold_is_refused(floor):
    with pytest.raises(EstimationError, match=r"floor of .* expected 0 to below 0.5"):
        two_rates(EVEN, floor=floor)


@pytest.mark.parametrize(
    ("transition", "message"),
    [
        (np.eye(3), r"an estimate of 2 modes and a transition matrix of shape \(3, 3\)"),
        ([[0.9, 0.4], [0.1, 0.6]], "rows .from. that sum to 1"),
        ([[1.1, -0.1], [0.1, 0.9]], "rows .from. that sum to 1"),
    ],
)
def test_what_is_no_transition_is_refused(transition, message):
    imm, belief = two_rates(transition)
    with pytest.raises(EstimationError, match=message):
        imm.step(belief, NOTHING, None, 0.1)


@pytest.mark.parametrize(
    ("z", "message"),
    [
        (np.zeros(2), r"measurement of shape \(2,\), expected \(1,\)"),
        (np.array([np.inf]), "expected finite numbers, or NaN"),
    ],
)
def test_what_no_mode_can_take_is_refused(z, message):
    imm, belief = two_rates(EVEN)
    with pytest.raises(EstimationError, match=message):
        imm.step(belief, NOTHING, z, 0.1)


@pytest.mark.parametrize("said", [(-np.inf, -np.inf), (np.nan, 0.0), (np.inf, 0.0)])
def test_likelihoods_that_judge_nothing_are_refused(said):
    imm = Imm(Members(tuple(map(Saying, said))), lambda _: np.array(EVEN))
    belief = ModeBelief.alike(np.zeros(1), np.eye(1), np.array([0.5, 0.5]))
    with pytest.raises(EstimationError, match="expected a finite one of a possible mode"):
        imm.step(belief, NOTHING, np.zeros(1), 0.1)


def test_another_number_of_modes_is_refused():
    imm, _ = two_rates(EVEN)
    three = ModeBelief.alike(np.zeros(1), np.eye(1), np.full(3, 1 / 3))
    with pytest.raises(EstimationError, match=r"an estimate of 3 modes .* bank of 2 filters"):
        imm.step(three, NOTHING, None, 0.1)
