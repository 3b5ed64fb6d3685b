"""Metres of latitude and longitude, against the definition of the ellipsoid."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.fixes.local_metres import LocalMetres, on_earth, zeros_within_deg
from tests.odometry.fixes.ellipsoid import local_m, place_of

pytest.importorskip("pymap3d")
LATITUDES, LONGITUDES = st.floats(-85, 85), st.floats(-180, 180)
HEIGHTS_M = st.floats(-400, 5000)


def metres(rows):
    local = LocalMetres()
    return local, local.columns(np.asarray(rows, dtype=float))


@given(LATITUDES, LONGITUDES, HEIGHTS_M, st.floats(-0.05, 0.05), st.floats(-0.05, 0.05))
def test_metres_are_those_of_the_definition(latitude, longitude, height_m, north_deg, east_deg):
    places = [(latitude, longitude, height_m)]
    places.append((latitude + north_deg, longitude + east_deg, height_m + 30.0))
    local, found = metres(places)
    assert local.origin == places[0]
    np.testing.assert_allclose(found[:, [0, 1, 3]], local_m(places, places[0]), atol=2e-6)
    assert np.isnan(found[:, 2]).all()


@given(st.floats(-2000, 2000), st.floats(-2000, 2000), LATITUDES, LONGITUDES)
def test_there_and_back(east_m, north_m, latitude, longitude):
    origin = latitude, longitude, 250.0
    _, found = metres([origin, place_of(east_m, north_m, 3.0, origin)])
    np.testing.assert_allclose(found[1, [0, 1, 3]], [east_m, north_m, 3.0], atol=1e-4)


def test_altitudes_that_are_missing_leave_the_height_open():
    rows = [(48.0, 11.0, np.nan), (48.0001, 11.0, 500.0), (48.0002, 11.0, np.nan)]
    local, found = metres(rows)
    assert local.origin == (48.0, 11.0, 500.0)
    np.testing.assert_array_equal(np.isnan(found[:, 3]), [True, False, True])
    assert abs(found[1, 3]) < 1e-3
    assert found[2, 1] == pytest.approx(2 * found[1, 1], rel=1e-6)


def test_zeros_are_a_place_where_all_is_near():
    assert zeros_within_deg(48.0) > 0
    assert zeros_within_deg(0.0) > 0
    assert zeros_within_deg(0.01) < 0
    assert on_earth(np.array([[90.0, 180.0], [90.1, 0.0], [0.0, 361.0]])).tolist() == [1, 0, 0]
