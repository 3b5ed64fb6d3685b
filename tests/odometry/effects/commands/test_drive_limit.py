"""Limits of a drive: closed forms, and a tread followed step by step."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from odometry.effects.commands.drive_limit import EDGE_M_S, Deadband, RateLimit, Saturation
from odometry.effects.interface.recorded import Recorded
from odometry.models.inputs import Inputs

PARTS = 4000


def test_commands_below_the_band_move_nothing_and_others_act_in_full(rng):
    speeds = rng.uniform(-0.3, 0.3, (400, 2))
    clear = np.abs(np.abs(speeds) - 0.08) > EDGE_M_S
    found = Deadband().tread_speeds(np.array([0.08]), Inputs(speeds))
    np.testing.assert_array_equal(found[clear], np.where(np.abs(speeds) < 0.08, 0, speeds)[clear])


def test_the_highest_speed_holds_forward_and_backward(bench):
    speeds = np.array([[0.5, -2.0], [3.0, 0.1]])
    found = Saturation().tread_speeds(np.array([1.0]), Inputs(speeds))
    np.testing.assert_array_equal(found, [[0.5, -1.0], [1.0, 0.1]])
    recorded = Recorded(bench.base, (Inputs(speeds),), ((0.0, 1.0),))
    (offered,) = Saturation.offered(recorded)
    assert offered.parameters[0].absent == 3.0


@given(st.integers(0, 2**32 - 1), st.floats(0.1, 20.0))
def test_speeds_go_towards_each_command_at_the_rate(seed, most):
    rng = np.random.default_rng(seed)
    steps_s = rng.uniform(0.01, 0.4, 15)
    speeds = rng.uniform(-1, 1, (16, 2))
    time_s = np.concatenate([[0.0], np.cumsum(steps_s)])
    found = RateLimit().tread_speeds(np.array([most]), Inputs(speeds, time_s=time_s))
    reached = speeds[0]
    for row, step_s in enumerate(steps_s):
        ages_s = ((np.arange(PARTS) + 0.5) / PARTS * step_s)[:, None]
        change = speeds[row] - reached
        path = reached + np.sign(change) * np.minimum(np.abs(change), most * ages_s)
        np.testing.assert_allclose(found[row], path.mean(axis=0), atol=2e-3)
        reached = reached + np.sign(change) * np.minimum(np.abs(change), most * step_s)


def test_without_stamps_no_rate_is_known():
    speeds = np.array([[0.5, -2.0], [3.0, 0.1]])
    np.testing.assert_array_equal(RateLimit().tread_speeds(np.array([0.1]), Inputs(speeds)), speeds)
