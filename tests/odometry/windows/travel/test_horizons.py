import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.windows.travel.horizons import spatial_horizons


def test_windows_by_hand():
    """Starts at 0, 1, 2 and 3 m; the one from 3 m ends at the sample after 5 m."""
    travel_m = np.array([0, 0.5, 1, 2, 3, 4, 5.25])
    windows = spatial_horizons(travel_m, horizon_m=2, stride_m=1)
    assert windows.tolist() == [[0, 3], [2, 4], [3, 5], [4, 6]]


def test_a_start_between_samples_is_the_next_sample():
    windows = spatial_horizons(np.array([0, 0.7, 1.4, 2.1, 2.8]), horizon_m=1, stride_m=1)
    assert windows.tolist() == [[0, 2], [2, 4]]


def test_stride_equal_to_the_horizon_tiles_the_run():
    windows = spatial_horizons(np.arange(0, 10.5, 0.5), horizon_m=2, stride_m=2)
    assert windows.tolist() == [[0, 4], [4, 8], [8, 12], [12, 16], [16, 20]]


def test_decimal_steps_do_not_lose_a_window():
    """0.1 added a hundred times is not quite 10."""
    travel_m = np.cumsum(np.r_[0, np.full(100, 0.1)])
    assert len(spatial_horizons(travel_m, horizon_m=5, stride_m=0.5)) == 11


def test_too_short_a_run_has_no_window():
    for travel_m in ([0, 1], [0, 1.9], [0], [0, 0, 0]):
        assert spatial_horizons(np.array(travel_m, float), 2, 1).shape == (0, 2)


def test_while_the_robot_stands_one_window_starts():
    travel_m = np.array([0, 1, 1, 1, 1, 2, 3])
    windows = spatial_horizons(travel_m, horizon_m=1, stride_m=0.25)
    assert windows.tolist() == [[0, 1], [1, 5], [5, 6]]


def test_the_origin_of_the_travel_does_not_matter():
    travel_m = np.array([0, 0.5, 1, 2, 3, 4, 5.25])
    np.testing.assert_array_equal(
        spatial_horizons(travel_m + 100, 2, 1), spatial_horizons(travel_m, 2, 1)
    )


@given(st.lists(st.floats(0, 3), min_size=1, max_size=40), st.floats(0.2, 6), st.floats(0.1, 3))
def test_each_window_is_the_shortest_that_reaches_the_horizon(steps_m, horizon_m, stride_m):
    travel_m = np.cumsum([0, *steps_m])
    windows = spatial_horizons(travel_m, horizon_m, stride_m)
    for first, last in windows:
        assert travel_m[last] - travel_m[first] >= horizon_m - 1e-8
        assert travel_m[last - 1] - travel_m[first] < horizon_m
    assert np.all(np.diff(windows[:, 0]) > 0)


@pytest.mark.parametrize("stride_m", [1e-9, 1e-300])
def test_strides_shorter_than_the_samples_start_a_window_at_each(stride_m):
    """Neither memory nor time may grow with the number of strides: here 1e13 and more."""
    travel_m = np.arange(6.0) * 2e3
    windows = spatial_horizons(travel_m, 4e3, stride_m)
    assert windows.tolist() == [[0, 2], [1, 3], [2, 4], [3, 5]]
