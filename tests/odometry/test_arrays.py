import numpy as np
import pytest

from odometry.arrays import median


@pytest.mark.parametrize("count", [1, 2, 3, 4, 51, 100])
def test_the_median_is_that_of_numpy(rng, count):
    values = rng.standard_normal(count)
    kept = values.copy()
    assert median(values) == pytest.approx(np.median(values), rel=1e-15)
    np.testing.assert_array_equal(values, kept)
