"""A yaw that currents bend, an antenna that leans with its robot."""

import numpy as np

from tests.blind.hidden.carried import CARRIED, bent_by_current, leaning_antenna
from tests.blind.hidden.kind import Clock
from tests.blind.hidden.scene import STEP_S, draw_scene

CLOCK = Clock(STEP_S, np.arange(2001) * STEP_S)


def hidden(draw, name, seed=3):
    rng = np.random.default_rng(seed)
    return draw(rng, draw_scene(rng, CARRIED[name]))(rng, CLOCK)


def test_a_steady_turn_bends_the_yaw_by_a_constant_and_no_place():
    bent = hidden(bent_by_current, "bent_by_current")
    poses = np.column_stack([CLOCK.times_s, CLOCK.times_s, 0.5 * CLOCK.times_s])
    _, seen = bent.reference(CLOCK.times_s, poses)
    np.testing.assert_array_equal(seen[:, :2], poses[:, :2])
    np.testing.assert_allclose(seen[:, 2] - poses[:, 2], 0.5 * bent.truth["per_turn_s"], atol=1e-9)


def test_an_antenna_leans_to_the_side_that_is_down():
    """Right side down by 0.1 rad under a robot that looks along y: the antenna is off along x."""
    leaning = hidden(leaning_antenna, "leaning_antenna")
    for row in range(len(CLOCK.times_s)):
        leaning.at_place(row, (0.0, 0.0, np.pi / 2, 0.1, 0.0), (1.0, 0.0, 0.0))
    poses = np.tile([0.0, 0.0, np.pi / 2], (3, 1))
    _, seen = leaning.reference(CLOCK.times_s[:3], poses)
    expected = [leaning.truth["height_m"] * np.sin(0.1), 0.0, np.pi / 2]
    np.testing.assert_allclose(seen, np.tile(expected, (3, 1)), atol=1e-9)
