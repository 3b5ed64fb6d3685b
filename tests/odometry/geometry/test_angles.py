import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.geometry.angles import continuous_difference, sine_and_cosine, wrap, wrap_one


def test_the_half_turn_is_positive():
    np.testing.assert_array_equal(wrap(np.array([np.pi, -np.pi])), [np.pi, np.pi])


@given(st.floats(-1e4, 1e4))
def test_the_same_direction_in_the_half_open_interval(angle):
    wrapped = float(wrap(angle))
    assert -np.pi < wrapped <= np.pi
    assert abs(np.exp(1j * wrapped) - np.exp(1j * angle)) < 1e-11


@given(st.floats(-3.14, 3.14))
def test_what_is_inside_stays(angle):
    assert abs(float(wrap(angle)) - angle) < 1e-15


def test_it_never_leaves_the_interval_beside_its_ends():
    """Remainders round: the neighbours of odd multiples of pi are the hard cases."""
    odd = np.pi * np.arange(-9.0, 10.0, 2.0)
    near = np.concatenate([odd, np.nextafter(odd, -np.inf), np.nextafter(odd, np.inf)])
    assert np.all((wrap(near) > -np.pi) & (wrap(near) <= np.pi))


@given(st.floats(-3, 3), st.floats(-4, 4), st.integers(-3, 3))
def test_differences_count_whole_turns(first, step, turns):
    """A reference that spins by 5 rad a sample, and a yaw that moves away by `step` a sample."""
    n = np.arange(9.0)
    step = step % 3.0
    reference, yaw = 5.0 * n, first + (5.0 + step) * n
    found = continuous_difference(wrap(yaw) + 2 * np.pi * turns, wrap(reference))
    np.testing.assert_allclose(found, first + step * n, rtol=0, atol=1e-10)


@given(st.floats(-1e3, 1e3))
def test_sine_and_cosine_by_the_tangent_of_the_half(angle):
    sine, cosine = sine_and_cosine(np.array(angle))
    assert sine == pytest.approx(np.sin(angle), rel=0, abs=6e-16)
    assert cosine == pytest.approx(np.cos(angle), rel=0, abs=6e-16)


def test_sine_and_cosine_of_quarter_turns_and_of_next_to_nothing():
    """Half a turn is a pole of the tangent; a small angle keeps all its digits."""
    quarters = np.pi / 2 * np.arange(-8.0, 9.0)
    found = sine_and_cosine(quarters)
    np.testing.assert_allclose(found, [np.sin(quarters), np.cos(quarters)], rtol=0, atol=4e-16)
    small = np.array([0.0, 1e-300, -1e-160, 1e-20, 1e-9])
    np.testing.assert_allclose(sine_and_cosine(small)[0], small, rtol=1e-15)
    assert np.all(sine_and_cosine(small)[1] == 1.0)


@given(st.floats(-1e3, 1e3) | st.integers(-9, 9).map(lambda k: k * np.pi))
def test_one_angle_wraps_as_an_array_does(angle):
    assert -np.pi < wrap_one(angle) <= np.pi
    assert np.exp(1j * wrap_one(angle)) == pytest.approx(np.exp(1j * float(wrap(angle))), abs=1e-9)
