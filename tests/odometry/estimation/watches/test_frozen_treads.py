"""When held speeds of a turn are contradicted, and what is then put back."""

import math

import numpy as np
import pytest

from odometry.estimation.transition import (
    ALPHA_LEFT,
    ALPHA_RIGHT,
    GYRO_BIAS,
    STATES,
    Y_LEFT,
    Y_RIGHT,
    YAW,
)
from odometry.estimation.watches.frozen_treads import FROZEN_S, FrozenTreads, restored, stepped
from odometry.geometry.angles import wrap
from odometry.recording.frames import Frame
from tests.odometry.estimation.sensor_drives import (
    STEP_S,
    drive,
    estimates_of,
    events_of,
    frames_of,
    weaving,
)

WIDTH_M, BIAS = 0.6, 0.02
ON_THE_SPOT = (-0.3, 0.3)
BEGIN = 400  # row of drives of 60 s: 40 s


def belief():
    mean = np.zeros(STATES)
    mean[[Y_LEFT, Y_RIGHT, ALPHA_LEFT, ALPHA_RIGHT]] = WIDTH_M / 2, -WIDTH_M / 2, 1.0, 1.0
    mean[GYRO_BIAS] = BIAS
    return mean, 1e-4 * np.eye(STATES)


def held(speeds=ON_THE_SPOT, *, share=0.0, lasts_s=2 * FROZEN_S, then=None, in_gap=False):
    """The watch and the last event after steps of 0.1 s, with a share of the asked turn."""
    watch, events = None, ()
    rate = BIAS + share * (speeds[1] - speeds[0]) / WIDTH_M
    for row in range(round(lasts_s / 0.1)):
        last = then is not None and row == round(lasts_s / 0.1) - 1
        next_speeds = np.array(then if last else speeds)
        frame = Frame(0.1 * (row + 1), next_speeds, row, None, None, in_gap=in_gap)
        watch, events = stepped(
            watch,
            frame,
            0.1 * row,
            speeds_m_s=np.array(speeds),
            yaw_rate=rate,
            belief=belief(),
            before=belief(),
        )
    return watch, events


@pytest.mark.parametrize("share", [0.0, 0.19, -0.19])
def test_a_turn_of_which_less_than_a_fifth_is_measured_is_none(share):
    watch, events = held(share=share)
    assert watch.is_found
    assert events == ()
    assert watch.since_s == 0.0
    turn_rad = share * 0.6 / WIDTH_M * 2 * FROZEN_S
    assert watch.belief[0][YAW] == pytest.approx(turn_rad, abs=1e-9)


@pytest.mark.parametrize(
    ("speeds", "share"),
    [
        (ON_THE_SPOT, 0.21),
        (ON_THE_SPOT, -0.21),
        ((-0.07, 0.07), 0.0),
        ((0.8, 1.2), 0.0),
        ((0.0, 0.0), 0.0),
    ],
    ids=["left", "right", "slow", "a tread scaled wrongly", "at rest"],
)
def test_these_are_no_such_turns(speeds, share):
    assert held(speeds, share=share)[0] is None


def test_it_is_found_after_two_seconds_and_ends_with_other_speeds():
    assert not held(lasts_s=FROZEN_S - 0.1)[0].is_found
    watch, (event,) = held(then=(0.4, 0.4))
    assert watch is None
    assert (event.kind, event.begin_s) == ("treads_frozen", 0.0)
    assert event.end_s == pytest.approx(2 * FROZEN_S)
    assert held(lasts_s=FROZEN_S - 0.1, then=(0.4, 0.4)) == (None, ())


def test_a_gap_is_none_and_a_silent_gyroscope_ends_none_that_was_found():
    assert held(in_gap=True)[0] is None
    watch = FrozenTreads(0.0, belief(), is_found=True)
    frame = Frame(5.0, np.array(ON_THE_SPOT), 1, None, None)
    speeds = np.array(ON_THE_SPOT)
    after, _ = stepped(
        watch, frame, 4.9, speeds_m_s=speeds, yaw_rate=math.nan, belief=belief(), before=belief()
    )
    assert after.is_found
    assert after.belief[0][YAW] == 0.0


def test_the_position_put_back_is_uncertain_by_the_time_that_passed():
    mean, covariance = restored(FrozenTreads(10.0, belief()), 12.0, 25.0)
    np.testing.assert_array_equal(mean, belief()[0])
    added = covariance - belief()[1]
    expected = np.zeros((STATES, STATES))
    expected[0, 0] = expected[1, 1] = 50.0
    expected[YAW, YAW] = 4e-4
    np.testing.assert_allclose(added, expected, atol=1e-12)


def test_measured_velocities_teach_nothing_meanwhile():
    driven = drive(30.0, speeds_of=lambda t: weaving(t) if t < 20.0 else ON_THE_SPOT)
    noise = np.random.default_rng(2).normal(0, 0.003, len(driven.stamps_s))
    rates = np.where(driven.stamps_s > 20.05, noise, driven.yaw_rates_rad_s)
    still = np.tile([0.05, 0.3, 0.0], (len(rates), 1))
    still[driven.stamps_s < 23.0] = np.nan
    estimates = estimates_of(frames_of(driven, yaw_rates=rates, velocities=still))
    np.testing.assert_allclose(estimates[-1].mean[3:], estimates[225].mean[3:], atol=1e-12)


def test_what_slip_taught_while_the_turn_died_away_is_put_back_too():
    """The bias at the beginning of the held speeds decides, and the pose of the stretch goes on."""
    now, then = belief(), belief()
    now[0][[YAW, GYRO_BIAS]] = 0.7, -0.3
    frame = Frame(0.1, np.array(ON_THE_SPOT), 1, None, None)
    watch, _ = stepped(
        None, frame, 0.0, speeds_m_s=np.array(ON_THE_SPOT), yaw_rate=BIAS, belief=now, before=then
    )
    assert watch.belief[0][YAW] == pytest.approx(0.7)
    assert watch.belief[0][GYRO_BIAS] == BIAS


def turning(t):
    """Weaving, and from 40 s on a turn on the spot."""
    return weaving(t) if t < BEGIN * STEP_S else ON_THE_SPOT


@pytest.mark.parametrize("posed", [True, False])
def test_frozen_treads_of_a_robot_that_stands_teach_nothing(posed):
    """A log that repeats a turn for 15 s, while the gyroscope reads its bias and no more."""
    driven = drive(60.0, speeds_of=turning)
    speeds, rates = driven.speeds_m_s.copy(), driven.yaw_rates_rad_s + 0.01
    rates[BEGIN + 1 :] = 0.01 + np.random.default_rng(3).normal(0, 0.003, len(rates) - BEGIN - 1)
    speeds[:BEGIN] += np.random.default_rng(5).normal(0, 0.005, speeds[:BEGIN].shape)
    speeds[550:] = 0.0
    places = driven.poses.copy()
    places[BEGIN + 1 :] = places[BEGIN]
    estimates = estimates_of(
        frames_of(driven, poses=places if posed else None, yaw_rates=rates, speeds=speeds)
    )
    frozen, *bias = events_of(estimates)
    assert (frozen.kind, frozen.begin_s, frozen.end_s) == ("treads_frozen", 40.0, 55.0)
    assert {event.kind for event in bias} <= {"gyroscope_bias"}
    before, after = estimates[BEGIN], estimates[545]
    np.testing.assert_allclose(after.mean[3:6], before.mean[3:6], atol=1e-4)
    if posed:
        assert abs(wrap(after.mean[2] - before.mean[2])) < 0.01
    else:
        assert after.gyro_bias_rad_s == pytest.approx(before.gyro_bias_rad_s, abs=1e-4)
        lasted_s, off_rad_s = 14.5, 0.01 - before.gyro_bias_rad_s
        assert wrap(after.mean[2] - before.mean[2]) == pytest.approx(lasted_s * off_rad_s, abs=0.1)
        assert np.sqrt(after.covariance[0, 0]) > 5.0


@pytest.mark.parametrize("share", [0.3, 1.0])
def test_a_turn_that_slips_much_is_no_frozen_tread(share):
    """Treads that hold their speeds, as commands do, and turn the robot by a part of it."""
    driven = drive(60.0, speeds_of=turning)
    rates = np.where(driven.stamps_s > 40.0, share, 1.0) * driven.yaw_rates_rad_s
    kinds = {event.kind for event in events_of(estimates_of(frames_of(driven, yaw_rates=rates)))}
    assert "treads_frozen" not in kinds


def test_a_tread_that_is_scaled_wrongly_on_straights_is_no_frozen_one():
    """Held speeds of 0.8 and 1.2 m/s of a robot that goes straight on."""
    driven = drive(60.0, speeds_of=lambda t: weaving(t) if t < 40.0 else (0.8, 1.2))
    rates = np.where(driven.stamps_s > 40.0, 0.0, driven.yaw_rates_rad_s)
    kinds = {event.kind for event in events_of(estimates_of(frames_of(driven, yaw_rates=rates)))}
    assert "treads_frozen" not in kinds
