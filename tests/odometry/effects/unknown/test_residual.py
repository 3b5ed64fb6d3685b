from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.interface.base import Effect
from odometry.effects.unknown.residual import Residual, basis_of, variable_of, variables_of
from odometry.effects.unknown.residual_of_each_run import ResidualOfEachRun
from odometry.errors import ParameterError
from odometry.models.inputs import Inputs


def added(effect, values, inputs, base=None):
    return effect.twist(np.array(values), np.zeros((len(inputs.left), 3)), inputs, base)


def test_of_an_angle_it_is_a_fourier_series(bench, rng):
    inputs = bench.drive(rng)
    effect = Residual("heading", (("v_x", 0), ("v_y", 1), ("v_y", 2), ("omega", 3)))
    found = added(effect, [0.1, 0.2, 0.3, 0.4], inputs)
    heading = inputs.heading_rad
    expected = [
        0.1 * np.cos(heading),
        0.2 * np.sin(heading) + 0.3 * np.cos(2 * heading),
        0.4 * np.sin(2 * heading),
    ]
    np.testing.assert_allclose(found, np.transpose(expected), atol=1e-14)


def test_between_knots_it_is_linear_and_beyond_them_level():
    knots = (-1.0, 0.0, 2.0)
    basis = basis_of(np.array([-5.0, -1.0, -0.25, 0.0, 1.5, 9.0]), knots)
    expected = [[1, 0, 0], [1, 0, 0], [0.25, 0.75, 0], [0, 1, 0], [0, 0.25, 0.75], [0, 0, 1]]
    np.testing.assert_allclose(basis, expected, atol=1e-15)


def test_by_speed_it_grows_with_the_treads(bench, rng):
    inputs = bench.drive(rng)
    terms = (("omega", 0),)
    still = added(Residual("pitch", terms, "", (0.0, 1.0)), [0.5], inputs)
    grown = added(Residual("pitch", terms, "speed", (0.0, 1.0)), [0.5], inputs)
    speed = np.abs(inputs.tread_speeds_m_s).mean(axis=1)
    np.testing.assert_allclose(grown, speed[:, None] * still, atol=1e-15)


def test_what_it_may_depend_on(bench, rng):
    inputs = bench.drive(rng)
    found = variables_of(inputs)
    np.testing.assert_allclose(found["speed_difference"], inputs.right - inputs.left)
    np.testing.assert_allclose(found["speed"], (inputs.left + inputs.right) / 2)
    np.testing.assert_array_equal(found["right_wheel_angle"], inputs.wheel_angles_rad[:, 1])
    assert set(variables_of(Inputs(np.zeros((2, 2))))) == {
        *("speed", "speed_difference", "roll", "pitch", "tread_speed", "other_tread_speed")
    }


def test_treads_follow_their_own_speed(bench, rng):
    inputs = bench.drive(rng)
    shape = Residual("tread_speed", (("left", 0), ("right", 1)), "", (-2.0, 2.0))
    changed = added(shape, [0.3, 0.2], inputs, bench.base)
    y_left, y_right, _, *alphas = bench.base.values
    slips = [0.3 * (2 - inputs.left) / 4, 0.2 * (2 + inputs.right) / 4] * np.array(alphas)[:, None]
    np.testing.assert_allclose(
        changed[:, 2], (slips[1] - slips[0]) / (y_left - y_right), atol=1e-12
    )


def test_what_treads_get_by_speed_is_a_share_of_it(bench, rng):
    inputs = bench.drive(rng)
    shape = Residual("time", (("left", 0), ("right", 0)), "speed", (0.0, 1e9))
    np.testing.assert_allclose(
        added(shape, [0.1, 0.1], inputs, bench.base),
        0.1 * bench.base.model.twist(bench.base.values, inputs),
        atol=1e-7,
    )


def test_each_tread_has_its_own_acceleration():
    time_s = np.arange(0.0, 4.0, 0.02)
    speeds = np.column_stack([0.5 * time_s, -0.25 * time_s])
    found = variables_of(Inputs(speeds, time_s=time_s))["tread_acceleration"]
    inner = slice(10, -10)
    np.testing.assert_allclose(found[inner], np.tile([0.5, -0.25], (180, 1)), atol=0.06)


def test_what_a_tread_lost_and_gained_in_speed_has_the_sign_of_its_motion():
    """Forward it brakes from 1 to 0.4 m/s, backward it speeds up from 0.2 to 0.8 m/s."""
    time_s = np.arange(0.0, 3.0, 0.05)
    speeds = np.where(time_s[:, None] < 1.5, [1.0, -0.2], [0.4, -0.8])
    inputs = Inputs(speeds, time_s=time_s)
    lost, gained = (variable_of(f"tread_speed_{name}", inputs, None) for name in ("lost", "gained"))
    soon = (time_s >= 1.5) & (time_s < 1.5 + 0.6)
    np.testing.assert_allclose(lost, np.where(soon[:, None], [0.6, 0.0], 0.0), atol=1e-12)
    np.testing.assert_allclose(gained, np.where(soon[:, None], [0.0, -0.6], 0.0), atol=1e-12)
    assert not {"tread_speed_lost", "tread_speed_gained"} & set(variables_of(inputs))
    assert variable_of("tread_speed_lost", Inputs(speeds), None) is None


def test_a_turn_is_counted_since_it_began_and_since_it_changed_its_side():
    """It turns left, rests, turns left again and then right, 0.1 rad in each row."""
    omega = np.array([0.0, 1.0, 1.0, 0.0, 1.0, -1.0, -1.0])
    twist = np.stack([0 * omega, 0 * omega, omega], axis=-1)
    inputs = Inputs(np.zeros((7, 2)), time_s=0.1 * np.arange(7))
    of_rest, of_side = (
        variable_of(f"turn_since_{name}", inputs, twist) for name in ("rest", "reversal")
    )
    np.testing.assert_allclose(of_rest[1:-1], [0.05, 0.15, 0.0, 0.05, 0.05], atol=1e-12)
    np.testing.assert_allclose(of_side[-3:-1], [3.25, 0.05], atol=1e-12)
    assert variable_of("turn_since_rest", Inputs(np.zeros((7, 2))), twist) is None


def test_what_follows_from_the_twist():
    twist = np.array([[1.0, 0.0, 0.5], [0.01, 0.0, 0.5], [-2.0, 0.0, 0.5]])
    found = variables_of(Inputs(np.zeros((3, 2))), twist)
    np.testing.assert_allclose(found["curvature"], [0.5, 10.0, -0.25])
    np.testing.assert_allclose(found["lateral_acceleration"], [0.5, 0.005, -1.0])


def test_a_variable_that_was_not_recorded_is_an_error():
    plain, effect = Inputs(np.zeros((2, 2))), Residual("heading", (("v_x", 0),))
    assert isinstance(effect, Effect)
    assert effect.lacks(plain, None) == "heading"
    with pytest.raises(ParameterError, match="'heading', which was not recorded; there are speed"):
        added(effect, [0.1], plain)


@pytest.mark.parametrize("term", [("v_z", 0), ("v_x", 5), ("v_x",)])
def test_a_term_that_is_none_is_an_error(term):
    with pytest.raises(ParameterError, match="has a term"):
        Residual("heading", (term,))


def test_a_variable_that_is_no_name_is_refused():
    with pytest.raises(ParameterError, match="expected a name"):
        Residual({"a": 1})


def test_by_a_part_of_the_twist_it_is_a_share_of_it(bench, rng):
    inputs = bench.drive(rng)
    twist = bench.base.model.twist(bench.base.values, inputs)
    terms = (("omega", 4),)  # one, at any heading
    effect = Residual("heading", terms, "omega")
    changed = effect.twist(np.array([0.2]), twist, inputs, bench.base)
    np.testing.assert_allclose(changed, twist * [1.0, 1.0, 1.2], atol=1e-14)
    with pytest.raises(ParameterError, match="by = 'v_y', expected one of speed, v_x, omega"):
        Residual("heading", terms, "v_y")


def test_a_velocity_over_the_world_is_turned_into_the_robot(bench, rng):
    inputs = bench.drive(rng)
    terms = (("world_x", 0), ("world_y", 0), ("world_x", 1), ("world_y", 1))
    effect = Residual("time", terms, "", (0.0, 1e9))
    found = added(effect, [0.3, -0.2, 0.3, -0.2], inputs)
    along_world = (found[:, 0] + 1j * found[:, 1]) * np.exp(1j * inputs.heading_rad)
    np.testing.assert_allclose(along_world, 0.3 - 0.2j, atol=1e-14)


def test_travel_since_a_reversal():
    time_s = np.arange(0.0, 8.0, 0.5)
    forward = np.where(time_s < 3.0, 1.0, np.where(time_s < 5.0, 0.0, -0.4))
    found = variables_of(Inputs(np.column_stack([forward, forward]), time_s=time_s))
    since = found["tread_travel_since_reversal"][:, 0]
    assert (since[:10] > 9.0).all()
    np.testing.assert_allclose(since[10:-1], 0.1 + 0.2 * np.arange(5), atol=1e-9)


def test_what_went_before():
    time_s = np.arange(0.0, 10.0, 0.1)
    turning = (time_s >= 5.0) & (time_s < 5.5)
    twist = np.column_stack([np.full(100, 2.0), np.zeros(100), np.where(turning, 0.6, 0.0)])
    found = variables_of(Inputs(np.full((100, 2), 2.0), time_s=time_s), twist)
    assert found["turn_before"][54] == pytest.approx(0.3)  # half a second is a metre
    assert found["turn_before"][70] == pytest.approx(0.0)
    assert found["lateral_acceleration_before"][58] == pytest.approx(0.6)
    assert found["lateral_acceleration_before"][70] == pytest.approx(0.0)


def test_coefficients_of_each_run_act_in_that_run_alone(bench, rng):
    inputs = replace(bench.drive(rng), run_number=np.repeat([0, 1, 2], [60, 80, 60]))
    count = len(inputs.left)
    terms = (("v_x", 0), ("omega", 4))
    effect = ResidualOfEachRun("heading", terms, runs=2)
    assert len(effect.parameters) == 4
    found = added(effect, [0.1, 0.2, 0.3, 0.4], inputs)
    plain = Residual("heading", terms)
    for number, values in ((0, [0.1, 0.2]), (1, [0.3, 0.4]), (2, [0.0, 0.0])):
        own = inputs.run_number == number
        np.testing.assert_allclose(found[own], added(plain, values, inputs)[own], atol=1e-15)
    assert count == len(found)


def test_means_over_the_time_before():
    """Over the last eight seconds, of which there were three before the first second."""
    time_s = np.arange(0.0, 30.0, 0.1)
    fast = time_s < 10.0
    speeds = np.column_stack([np.where(fast, 0.8, 0.0), np.where(fast, -0.4, 0.0)])
    twist = np.column_stack([speeds[:, 0], speeds[:, 0], np.where(fast, -0.5, 0.0)])
    found = variables_of(Inputs(speeds, time_s=time_s), twist)
    for name, while_fast in (("mean_speed_before", 0.6), ("mean_turning_before", 0.5)):
        for at_s, share in ((0.0, 0.0), (4.0, 0.5), (9.0, 1.0), (12.0, 0.75), (25.0, 0.0)):
            at = round(10 * at_s)
            assert found[name][at] == pytest.approx(share * while_fast, abs=1e-9), (name, at_s)


def test_time_since_a_stop_of_both_treads():
    time_s = np.arange(0.0, 10.0, 0.25)
    left = np.where((time_s >= 4.0) & (time_s < 5.5), 0.0, 0.5)
    right = np.where((time_s >= 3.0) & (time_s < 5.5), 0.0, 0.5)
    found = variables_of(Inputs(np.column_stack([left, right]), time_s=time_s))
    since = found["time_since_stop"]
    np.testing.assert_allclose(since[:17], time_s[:17])  # since the start
    assert since[time_s == 5.25] == 0.0
    np.testing.assert_allclose(since[time_s > 5.5], time_s[time_s > 5.5] - 5.25)


@pytest.mark.parametrize(
    "stands",
    [
        lambda t: t < 0,
        lambda t: t < 3.0,
        lambda t: t > 7.0,
        lambda t: (t > 5.0) & (t < 5.3),
        lambda t: t < 99,
    ],
    ids=["never", "at the start", "at the end", "too short", "always"],
)
def test_a_drive_without_a_stop_has_no_time_since_one(stands):
    time_s = np.arange(0.0, 10.0, 0.1)
    speed = np.where(stands(time_s), 0.0, 0.5)
    found = variables_of(Inputs(np.column_stack([speed, speed]), time_s=time_s))
    assert "time_since_stop" not in found


@pytest.mark.parametrize("name", ["time_since_stop", "tread_speed_repeated"])
def test_what_one_drive_follows_is_evaluated_on_another_that_lacks_it(name):
    """Without a stop it is the time since the start; where no speed is repeated it is nothing."""
    time_s = np.arange(0.0, 10.0, 0.1)
    found = variable_of(name, Inputs(np.full((100, 2), 0.5), time_s=time_s), None)
    expected = time_s if name == "time_since_stop" else np.zeros((100, 2))
    np.testing.assert_allclose(found, expected)
