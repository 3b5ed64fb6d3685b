"""Long lines are thinned to what a page shows of them; short ones stay as they are."""

import numpy as np
import pytest

from odometry.report.drawing import labels as module
from odometry.report.drawing.labels import thinned


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(module, "LONG", 100)
    monkeypatch.setattr(module, "PARTS", 20)


def test_a_short_line_stays(rng):
    x, y = rng.normal(size=(2, module.LONG))
    assert thinned(x, y)[0] is x


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize("count", [101, 399, 400, 1000])
def test_what_can_be_seen_of_a_line_stays(rng, count):
    """Every part has its extremes, in order of time; nothing is added."""
    stamps_s, values = np.arange(float(count)), rng.normal(size=count)
    x, y = thinned(stamps_s, values)
    assert len(x) <= 20 * 4 + 1
    assert np.all(np.diff(x) > 0)
    np.testing.assert_array_equal(y, values[x.astype(int)])
    assert x[0] == 0
    assert x[-1] == count - 1
    width = -(-count // 20)
    for start in range(0, count, width):
        part, left = values[start : start + width], y[(x >= start) & (x < start + width)]
        assert left.min() == part.min()
        assert left.max() == part.max()


@pytest.mark.usefixtures("small")
def test_a_break_stays_a_break(rng):
    values = rng.normal(size=400)
    values[[37, 38, 205]] = np.nan
    x, y = thinned(np.arange(400.0), values)
    np.testing.assert_array_equal(x[np.isnan(y)], [37, 205])
    assert np.nanmax(y) == np.nanmax(values)


@pytest.mark.usefixtures("small")
def test_a_line_of_breaks_alone_has_no_warning():
    assert np.isnan(thinned(np.arange(400.0), np.full(400, np.nan))[1]).all()
