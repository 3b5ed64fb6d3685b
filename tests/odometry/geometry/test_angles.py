import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from odometry.geometry.angles import wrap


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
