import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from odometry.geometry.angles import continuous_difference, wrap


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
