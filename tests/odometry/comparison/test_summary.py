"""Tables and differences from errors that are written down here."""

import numpy as np
import pytest

from odometry.comparison.config import ComparisonConfig
from odometry.comparison.evaluation import NotEvaluated
from odometry.comparison.statistics import Interval, between, differences
from odometry.comparison.summary import summarise
from tests.odometry.comparison.written_errors import PLACE, difference, evaluation


def test_summaries_pool_the_windows_of_all_runs():
    evaluations = [evaluation("a", icr=[0.1, 0.2]), evaluation("b", icr=[0.3, 0.4, 0.9])]
    summary = summarise(PLACE, evaluations, [], "icr")
    assert (summary.runs, summary.windows, summary.complete) == (("a", "b"), 5, True)
    assert summary.means == pytest.approx({"translation": 0.38, "rotation": 3.8})
    assert summary.medians == pytest.approx({"translation": 0.3, "rotation": 3.0})
    np.testing.assert_allclose(summary.quartiles["translation"], [0.2, 0.3, 0.4])
    np.testing.assert_allclose(summary.quartiles["rotation"], [2, 3, 4])


def test_a_model_that_failed_on_a_run_says_why():
    evaluations = [evaluation("a", icr=[0.1, 0.2], other=[1, 1]), evaluation("b", other=[1])]
    not_evaluated = [
        NotEvaluated("rover", "grass", "b", "icr", "too few windows"),
        NotEvaluated("rover", "ice", "c", "icr", "elsewhere"),
        NotEvaluated("rover", "grass", "d", "", "no window of 2 m"),
    ]
    summary = summarise(PLACE, evaluations, not_evaluated, "icr")
    assert (summary.windows, summary.complete) == (2, False)
    assert summary.reasons == ("b: too few windows", "d: no window of 2 m")
    absent = summarise(PLACE, evaluations, not_evaluated, "nothing")
    assert (absent.windows, absent.complete, absent.means) == (0, False, {})


def test_differences_are_taken_on_the_windows_of_both():
    evaluations = [
        evaluation("a", one=[0.1] * 20, two=[0.3] * 20),
        evaluation("b", one=[9.0] * 20),
    ]
    found = differences(PLACE, evaluations, ("one", "two", "three"), ComparisonConfig(draws=100))
    assert [(each.quantity, each.first, each.second) for each in found] == [
        ("translation", "one", "two"),
        ("rotation", "one", "two"),
    ]
    assert found[0].windows == 20
    assert found[0].interval.mean == pytest.approx(-0.2)
    assert found[1].interval.mean == pytest.approx(-2.0)


def test_differences_pair_windows(rng):
    """Errors vary by 1, those of the second model are always 0.01 larger: the interval shows it."""
    hard = rng.uniform(0, 1, 60)
    evaluations = [evaluation("a", one=hard, two=hard + 0.01 + rng.normal(0, 0.001, 60))]
    (found, _) = differences(PLACE, evaluations, ("one", "two"), ComparisonConfig(draws=200))
    assert found.interval.low == pytest.approx(-0.01, abs=0.001)
    assert found.interval.high == pytest.approx(-0.01, abs=0.001)


def test_a_difference_can_be_seen_from_either_model():
    one = difference("icr", "width", 0.01, -0.02, 0.05)
    other = between([one], "width", "icr")
    assert (other.first, other.second) == ("width", "icr")
    assert other.interval == Interval(-0.01, -0.05, 0.02)
    assert between([one], "icr", "width") is one
    assert between([one], "icr", "none") is None


@pytest.mark.parametrize(
    ("quantity", "expected"),
    [
        ("translation", "-0.0012 [-0.0500, 0.0000] m per m"),
        ("rotation", "-0.001 [-0.050, 0.000] degrees per m"),
    ],
)
def test_a_difference_in_words(quantity, expected):
    assert difference("a", "b", -0.00123, -0.05, -0.000001, quantity=quantity).words() == expected
