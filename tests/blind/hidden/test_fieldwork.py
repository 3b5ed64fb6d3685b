"""Snow is left behind as the robot backs up, hot drives cut back, a bent sprocket ripples."""

import numpy as np

from tests.blind.hidden.fieldwork import FIELDWORK, bent_sprocket, snow_wedge, thermal_cutback
from tests.blind.hidden.kind import Clock
from tests.blind.hidden.scene import STEP_S, draw_scene

CLOCK = Clock(STEP_S, np.arange(6001) * STEP_S)


def hidden(draw, seed=3):
    rng = np.random.default_rng(seed)
    scene = draw_scene(rng, FIELDWORK["snow_wedge"])
    return draw(rng, scene)(rng, CLOCK), scene


def test_snow_brakes_more_and_more_until_the_robot_backs_up():
    push, _ = hidden(snow_wedge)
    asked = np.ones((6001, 2))
    asked[4000:4100] = -1.0
    treads = push.treads(asked)[:, 0]
    assert (np.diff(treads[:4000]) <= 0).all()
    assert treads[3999] < 1 - 0.9 * push.truth["most"]
    assert treads[4001] == -1.0
    assert treads[4100] == 1.0


def test_hot_drives_allow_less_from_a_moment_on():
    cut, scene = hidden(thermal_cutback)
    asked = np.tile([scene.speed_m_s, -scene.speed_m_s], (6001, 1))
    treads, hot = cut.treads(asked), CLOCK.times_s >= cut.truth["moment_s"]
    np.testing.assert_array_equal(treads[~hot], asked[~hot])
    np.testing.assert_allclose(np.abs(treads[hot]), cut.truth["most_m_s"])


def test_a_bent_sprocket_ripples_with_the_travel_of_one_tread():
    bent, _ = hidden(bent_sprocket)
    treads = bent.treads(np.ones((6001, 2)))
    share, turn_m = bent.truth["share"], bent.truth["turn_m"]
    straight, rippled = sorted(treads.T, key=np.ptp)
    np.testing.assert_array_equal(straight, 1.0)
    assert abs(np.ptp(rippled) - 2 * share) < 0.01
    ups = np.count_nonzero(np.diff(np.sign(rippled - 1.0)) > 0)
    assert abs(ups - 60.0 / turn_m) <= 1
