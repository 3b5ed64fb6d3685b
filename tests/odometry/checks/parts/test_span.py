"""Where in a recording something is otherwise."""

import numpy as np
import pytest

from odometry.checks.parts.edges import Columns
from odometry.checks.parts.span import Span, best_rows


def test_the_rows_with_the_most_to_gain():
    assert best_rows(np.array([-1.0, 2.0, -0.5, 3.0, -4.0, 1.0])) == (1, 4)
    assert best_rows(np.array([1.0, 1.0])) == (0, 2)


@pytest.mark.parametrize(
    ("span", "words", "elsewhere"),
    [
        (Span(12.0, np.inf), "from about 2 s on", "until about 2 s"),
        (Span(-np.inf, 15.0), "until about 5 s", "from about 5 s on"),
        (Span(12.0, 15.0), "from about 2 s to 5 s", "until about 2 s and from about 5 s on"),
    ],
)
def test_a_span_and_the_rest_in_words(span, words, elsewhere):
    assert span.words(10.0) == words
    assert span.elsewhere.words(10.0) == elsewhere
    stamps_s = np.arange(10.0, 20.0)
    assert (span.holds(stamps_s) != span.elsewhere.holds(stamps_s)).all()


@pytest.mark.parametrize("factor", [0.2, 3.6, 1000.0])
def test_a_unit_begins_and_ends_at_its_rows(factor, rng):
    stamps_s = 0.1 * np.arange(600)
    true = 1 + 0.3 * np.sin(stamps_s) + 0.02 * rng.standard_normal((2, 600))
    inside = (stamps_s >= 21.3) & (stamps_s < 44.7)
    recorded = np.where(inside, factor * true, true)
    columns = Columns(stamps_s, recorded, recorded / factor, factor, np.inf)
    begins, ends = columns.edges(Span(20.0, 46.0))
    assert begins.stamp(18.0, 24.0) == pytest.approx(21.3)
    assert ends.stamp(41.0, 48.0) == pytest.approx(44.7)
