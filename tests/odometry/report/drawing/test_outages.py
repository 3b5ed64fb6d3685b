"""Lines break where nothing was measured."""

import numpy as np
import pytest

from odometry.report.drawing.labels import broken_at_outages


def test_a_line_breaks_in_the_middle_of_an_outage():
    stamps_s = np.array([0.0, 0.5, 1.0, 9.0, 9.5, 10.0])
    values = np.column_stack([stamps_s, -stamps_s])
    broken_s, broken = broken_at_outages(stamps_s, values)
    assert broken_s.tolist() == [0.0, 0.5, 1.0, 5.0, 9.0, 9.5, 10.0]
    assert np.flatnonzero(np.isnan(broken).all(axis=1)).tolist() == [3]
    assert np.delete(broken, 3, axis=0) == pytest.approx(values)
    assert broken_at_outages(stamps_s, stamps_s)[1][2:5] == pytest.approx(
        [1, np.nan, 9], nan_ok=True
    )


@pytest.mark.parametrize("stamps_s", [np.arange(5.0), 30.0 * np.arange(5.0), np.ones(1)])
def test_sparse_measurements_are_no_outage(stamps_s):
    broken_s, values = broken_at_outages(stamps_s, stamps_s)
    assert broken_s.tolist() == values.tolist() == stamps_s.tolist()
