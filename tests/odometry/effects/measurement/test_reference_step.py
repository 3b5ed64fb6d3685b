"""A clock that is set at a moment of each run: stamps before it are right, those after it late."""

import numpy as np
import pytest

from odometry.effects.interface.corrected import Added
from odometry.effects.interface.recorded import Recorded
from odometry.effects.measurement.measured import robot_run
from odometry.effects.measurement.pose_stamps import breaks_s
from odometry.effects.measurement.reference_step import ClockStep
from odometry.recording.run import Run
from tests.odometry.effects.reports import at_stamps

SPANS = ((2.0, 30.0), (1.0, 60.0))
VALUES = np.array([0.25, 10.0, -0.1, 40.0])  # offset and moment of each run


@pytest.mark.parametrize(("run", "expected"), [(0, 0.25), (1, 0.0), (2, 0.0), (None, 0.0)])
def test_each_run_has_its_own(run, expected):
    """At 20 s the first run has had its step, the second not; of others nothing is known."""
    step = ClockStep(SPANS, ((), ()))
    np.testing.assert_array_equal(step.delay_s(VALUES, np.array([5.0]), run), 0.0)
    np.testing.assert_array_equal(step.delay_s(VALUES, np.array([20.0]), run), expected)


def test_poses_of_a_run_that_is_not_known_stay_as_they_are(make_run):
    run = Run.read(make_run(pose="t,x,y,yaw\n0.3,0,0,0.5\n0.7,0.4,0,0.5\n"))
    found = robot_run(run, [Added(ClockStep(SPANS[:1], ((),)), VALUES[:2])])
    np.testing.assert_array_equal(found.pose.stamps_s, run.pose.stamps_s)


def test_a_search_begins_at_every_break_and_a_moment_must_be_within_its_run():
    step = ClockStep(SPANS, ((10.0, 12.0), (40.0,)))
    never = (31.0, 61.0)
    assert {tuple(start[1::2]) for start in step.starts(None, None)} == {
        (10.0, 40.0),
        (10.0, never[1]),
        (12.0, never[1]),
        (never[0], 40.0),
    }
    assert step.is_meant(VALUES)
    assert not step.is_meant(np.array([0.25, 1.0, -0.1, 40.0]))
    assert not step.is_meant(np.array([0.25, never[0], -0.1, never[1]]))


def test_stamps_break_where_a_clock_is_set_and_nowhere_else(rng):
    regular = np.arange(0.0, 30.0, 0.1) + 0.005 * rng.standard_normal(300)
    assert breaks_s(regular) == ()
    set_on = regular + 0.3 * (regular > 12.34)
    (found,) = breaks_s(set_on)
    assert found == pytest.approx(12.5, abs=0.2)
    late_by_chance = np.sort(regular + 0.3 * rng.random(300))
    assert breaks_s(late_by_chance) == ()
    assert breaks_s(np.empty(0)) == ()


def test_without_a_break_it_is_no_candidate(bench, rng):
    inputs, even = (bench.drive(rng),), np.arange(0.0, 30.0, 0.1)
    assert (
        ClockStep.offered(Recorded(bench.base, inputs, SPANS[:1], reported=(at_stamps(even),)))
        == ()
    )
    set_on = Recorded(
        bench.base, inputs, SPANS[:1], reported=(at_stamps(even + 0.3 * (even > 12.34)),)
    )
    (step,) = ClockStep.offered(set_on)
    assert step.observed_s == SPANS[:1]
    assert step.breaks_s == ((pytest.approx(12.5, abs=0.1),),)


def test_without_a_gyroscope_treads_may_act_later_instead():
    told = ClockStep(SPANS[:1], ((),))
    assert not told.same_as(VALUES)
    assert set(ClockStep(SPANS[:1], ((),), has_gyroscope=False).same_as(VALUES)) == {
        "command_delay"
    }


def test_a_search_goes_on_to_steps_of_another_run():
    step = ClockStep(((2.0, 98.0), (2.0, 58.0)), ((40.0,), (20.0, 30.0)))
    elsewhere = step.elsewhere(np.array([0.3, 40.0, 0.0, 59.0]))
    assert len(elsewhere) == 6
    for size in (0.3, -0.3):
        assert any(np.array_equal(one, [0.3, 40.0, size, 20.0]) for one in elsewhere)
    alone = ClockStep(((2.0, 98.0),), ((40.0,),))
    assert alone.elsewhere(np.array([0.3, 40.0])).shape == (0, 2)
