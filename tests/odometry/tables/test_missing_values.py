import numpy as np
import pytest

from odometry.errors import TrajectoryError
from odometry.tables.table import fill_gaps, level_where_missing

STAMPS_S = np.array([0.0, 1, 3, 4, 6])
GAPPED = np.array([np.nan, 2, np.nan, 8, np.nan])


def test_gaps_are_linear_in_time_and_ends_are_held():
    np.testing.assert_allclose(fill_gaps(STAMPS_S, GAPPED), [2, 2, 6, 8, 8], rtol=0, atol=1e-15)
    assert np.isnan(GAPPED).sum() == 3


def test_without_gaps_nothing_changes():
    np.testing.assert_array_equal(fill_gaps(STAMPS_S, STAMPS_S**2), STAMPS_S**2)


@pytest.mark.parametrize("angle", [None, np.full(5, np.nan)])
def test_an_angle_that_was_never_measured_is_level(angle):
    assert level_where_missing(STAMPS_S, angle).tolist() == [0] * 5


def test_an_angle_that_was_measured_is_filled():
    np.testing.assert_array_equal(
        level_where_missing(STAMPS_S, GAPPED), fill_gaps(STAMPS_S, GAPPED)
    )


@pytest.mark.parametrize("values", [np.zeros(4), np.full(5, np.nan), np.zeros((5, 1))])
def test_what_cannot_be_filled_is_an_error(values):
    with pytest.raises(TrajectoryError, match="5 stamps"):
        fill_gaps(STAMPS_S, values)
