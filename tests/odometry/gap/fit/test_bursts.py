"""Events of an effect in bursts: exact against all ways to lay them, and found in runs."""

from itertools import product

import numpy as np
import pytest

from odometry.effects.catalogue import added_effects, effect_table
from odometry.effects.commands.tread_slip import SlipOfLeftTread
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import InBursts
from odometry.gap.config import GapConfig
from odometry.gap.fit.bursts import burst_effects, states
from odometry.gap.fit.contest import judge
from odometry.gap.fit.fitter import Fitter
from odometry.gap.fit.own_moments import with_own_moments
from odometry.gap.name.unnamed import variable_of_events
from odometry.gap.name.verdict import come_by_themselves
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.statistic import gap_of
from odometry.models.inputs import Inputs

CONFIG = GapConfig()
NOISE_M = 0.02  # of the position at the end of a window
KEPT = 0.5
EVENTS = {0: ((20.0, 23.0), (51.0, 52.5), (90.0, 92.0)), 1: ((33.0, 36.0), (70.0, 71.5))}
WIDTH = 0.87  # of the robot that the scenes are of


@pytest.fixture(scope="module")
def scenes(make_scene):
    """Runs whose left tread keeps half of its speed during events."""

    def make(number):
        def planted(columns, twist):
            t = columns["t"]
            within = np.any([(b <= t) & (t < e) for b, e in EVENTS[number]], axis=0)
            lost = np.where(within, (1 - KEPT) * columns["v_left"], 0.0)
            y_right = -0.42
            change = np.column_stack([lost * y_right / WIDTH, -0.02 * lost / WIDTH, lost / WIDTH])
            return twist + change

        run = make_scene(40 + number, planted, duration_s=120.0, name=f"run_{number}")
        return run.numbered(number)

    return make(0), make(1)


@pytest.fixture(scope="module")
def found(scenes, known):
    fitter = Fitter(known, measured_of(scenes[:1], known, CONFIG))
    before = fitter.fit([])
    return judge(fitter, before, burst_effects(fitter, before), CONFIG, lambda: None)


def test_of_all_ways_to_lay_events_the_least_cost_is_found(rng):
    without, within = rng.uniform(0.0, 8.0, (2, 9))
    turn = np.log(9)

    def cost(on):
        ends = np.count_nonzero(np.diff([0, *on, 0]))
        return np.where(on, within, without).sum() + turn * ends

    best = min(product([0, 1], repeat=9), key=cost)
    np.testing.assert_array_equal(states(without, within), np.array(best, dtype=bool))


def test_the_tread_its_events_and_its_strength_are_found(found):
    best = found[0]
    assert isinstance(best.effect.inner, SlipOfLeftTread)
    np.testing.assert_allclose(best.effect.in_time.events_s[0], EVENTS[0], atol=0.4)
    assert best.fitted.effects[0].values == pytest.approx([KEPT], abs=0.05)
    assert best.least > CONFIG.least_evidence
    assert best.fitted.freedom == 1 + 2 * len(EVENTS[0])


def test_another_run_has_events_of_its_own(found, scenes, known):
    effects, judged = with_own_moments(
        known.base, found[0].fitted.effects, scenes[1:], scenes[:1], known
    )
    np.testing.assert_allclose(effects[0].effect.in_time.events_s[1], EVENTS[1], atol=0.5)
    before = gap_of(known.base, (), judged, CONFIG.part_s).value
    after = gap_of(known.base, effects, judged, CONFIG.part_s).value
    assert before > 2 * NOISE_M
    assert before - after > 0.8 * (before - NOISE_M)
    assert judged[0] is scenes[1]


def test_where_nothing_slips_nothing_is_found(make_scene, known):
    still = make_scene(44, lambda _, twist: twist, duration_s=120.0).numbered(0)
    fitter = Fitter(known, measured_of([still], known, CONFIG))
    assert burst_effects(fitter, fitter.fit([])) == ()


def test_samples_are_shared_out_by_run():
    time_s = np.arange(0.0, 6.0, 1.0)
    inputs = Inputs(np.ones((6, 2)), time_s=time_s, run_number=np.array([0, 0, 0, 1, 1, 1]))
    course = InBursts((((0.5, 2.25),), ((4.0, 5.0),)))
    np.testing.assert_allclose(course.share(np.empty(0), inputs)[:5], [0.5, 1, 0.25, 0, 1])
    assert course.searched == 4
    assert course.with_events(((8.0, 9.0), (1.0, 2.0)), 3).events_s[2:] == (
        (),
        ((1.0, 2.0), (8.0, 9.0)),
    )


def test_a_parameter_set_holds_the_events():
    effect = in_course(SlipOfLeftTread(), InBursts((((1.0, 2.0), (4.0, 4.5)), ())))
    (again,) = added_effects([effect_table(Added(effect, np.array([0.7])))], "here")
    assert again.effect.in_time == effect.in_time
    assert again.effect.key == effect.key
    np.testing.assert_array_equal(again.values, [0.7])


@pytest.fixture(scope="module")
def limited(make_scene):
    """A run whose left tread does not reach more than part of its highest speed."""

    def planted(columns, twist):
        speed = columns["v_left"]
        lost = speed - np.clip(speed, -0.3, 0.3)
        change = np.column_stack([-lost * 0.42 / WIDTH, -0.02 * lost / WIDTH, lost / WIDTH])
        return twist + change

    return make_scene(44, planted, duration_s=120.0).numbered(0)


def test_a_limit_of_one_tread_is_predicted_by_its_speed(limited, known):
    fitter = Fitter(known, measured_of((limited,), known, CONFIG))
    found = burst_effects(fitter, fitter.fit([]))
    courses = [one.in_time for one in found if isinstance(one.inner, SlipOfLeftTread)]
    name, area = variable_of_events(courses[0], (limited,), known.base)
    assert name in {"tread_speed", "other_tread_speed"}
    assert come_by_themselves(name, area, CONFIG)


def test_nothing_recorded_tells_when_true_bursts_are(scenes, known):
    course = InBursts(tuple(EVENTS[number] for number in range(2)))
    assert not come_by_themselves(*variable_of_events(course, scenes, known.base), CONFIG)


def test_events_after_a_moment_are_predicted_by_run_time(scenes, known):
    end_s = float(scenes[0].inputs.time_s[-1])
    course = InBursts((((60.0, end_s),), ()))
    name, area = variable_of_events(course, scenes[:1], known.base)
    assert area == pytest.approx(1.0)
    assert name == "time"
