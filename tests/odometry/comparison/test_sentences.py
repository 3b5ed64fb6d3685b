"""Tables, differences and sentences from errors that are written down here."""

import numpy as np
import pytest

from odometry.comparison.config import ComparisonConfig
from odometry.comparison.evaluation import Evaluation, NotEvaluated
from odometry.comparison.sentences import contradictions, sentences
from odometry.comparison.statistics import Difference, Interval, between, differences
from odometry.comparison.summary import Place, summarise
from odometry.comparison.whole_runs import RunFitness
from odometry.evaluation.fitness import Fitness
from odometry.windows.window_errors import WindowErrors

PLACE = Place("rover", "grass", 2.0)


class Counted(list):
    """Stands for windows of which only the number matters."""


def evaluation(run, **models):
    """Errors by model: translation in m per m, rotation in degrees per m ten times that."""
    errors = {
        name: WindowErrors(np.array(values), np.radians(10 * np.array(values)))
        for name, values in models.items()
    }
    count = len(next(iter(models.values())))
    return Evaluation("rover", "grass", run, "others", 2.0, Counted([0] * count), errors)


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
    """Errors vary by 1, but the second model always errs 0.01 more: the interval sees it."""
    hard = rng.uniform(0, 1, 60)
    evaluations = [evaluation("a", one=hard, two=hard + 0.01 + rng.normal(0, 0.001, 60))]
    (found, _) = differences(PLACE, evaluations, ("one", "two"), ComparisonConfig(draws=200))
    assert found.interval.low == pytest.approx(-0.01, abs=0.001)
    assert found.interval.high == pytest.approx(-0.01, abs=0.001)


def difference(first, second, mean, low, high, *, quantity="translation"):
    return Difference(PLACE, quantity, first, second, 60, Interval(mean, low, high))


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


def said(errors, found):
    """Sentences on one run with these constant errors."""
    one = evaluation("a", **{name: [value] * 4 for name, value in errors.items()})
    summaries = [summarise(PLACE, [one], [], name) for name in errors]
    both = [
        difference(*key, *numbers, quantity=q)
        for key, numbers in found.items()
        for q in ("translation", "rotation")
    ]
    return sentences(PLACE, summaries, both)


def test_models_that_cannot_be_distinguished_are_named_with_numbers():
    lines = said(
        {"icr_symmetric": 0.02, "icr": 0.0196, "ideal": 0.1},
        {
            ("icr_symmetric", "icr"): (0.0004, -0.001, 0.0017),
            ("icr_symmetric", "ideal"): (-0.08, -0.09, -0.07),
            ("icr", "ideal"): (-0.08, -0.09, -0.07),
        },
    )
    assert lines[:2] == [
        "icr errs least on grass in translation, 0.0196 m per m.",
        "icr cannot be distinguished on grass in translation from icr_symmetric "
        "(difference -0.0004 [-0.0017, 0.0010] m per m).",
    ]
    assert lines[-1] == (
        "Nothing beats a fitted effective width (icr_symmetric) on grass in translation or "
        "rotation."
    )


def test_a_model_that_beats_all_others():
    lines = said(
        {"icr_symmetric": 0.03, "icr": 0.02}, {("icr_symmetric", "icr"): (0.01, 0.005, 0.02)}
    )
    assert lines[0] == (
        "icr errs least on grass in translation, 0.0200 m per m; every other model errs more."
    )
    assert not any("Nothing beats" in line for line in lines)


def test_a_model_that_was_not_evaluated_everywhere_is_not_ranked():
    evaluations = [
        evaluation("a", icr=[0.1], width=[0.2], part=[0.0]),
        evaluation("b", icr=[0.1], width=[0.2]),
    ]
    not_evaluated = [NotEvaluated("rover", "grass", "b", "part", "too few windows")]
    summaries = [summarise(PLACE, evaluations, not_evaluated, m) for m in ("icr", "width", "part")]
    lines = sentences(PLACE, summaries, [difference("icr", "width", -0.1, -0.2, -0.05)])
    assert lines[0].startswith("icr errs least")
    assert lines[-1] == "part is not in this comparison on grass: b: too few windows."


def summaries_of(**errors):
    one = evaluation("a", **errors)
    return [summarise(PLACE, [one], [], name) for name in errors]


def test_mean_and_median_that_disagree_are_both_told():
    """A few windows with outliers: icr is better in most windows, and worse by the mean."""
    found = summaries_of(icr=[0.02, 0.02, 0.02, 0.9], width=[0.06, 0.06, 0.06, 0.5])
    (translation, rotation) = contradictions(PLACE, found, [])
    assert translation == (
        "Mean and median disagree on grass in translation: width errs less than icr by the mean "
        "(0.1700 against 0.2400 m per m) and more by the median (0.0600 against 0.0200): a few "
        "windows with large errors decide the means."
    )
    assert "rotation: width errs less" in rotation


def test_medians_that_are_all_but_equal_do_not_disagree():
    found = summaries_of(icr=[0.0199, 0.0199, 0.9], width=[0.02, 0.02, 0.5])
    assert contradictions(PLACE, found, []) == []


def fit_of(run, model, metres2):
    return RunFitness("rover", run, model, Fitness(10, 0, metres2, 0.0, 0.0, 0.0))


def test_a_model_that_wins_over_windows_and_loses_on_whole_runs():
    found = summaries_of(icr=[0.02] * 4, ideal=[0.3] * 4)
    fitness = [fit_of("a", "icr", 9.0), fit_of("a", "ideal", 1.0)]
    fitness += [fit_of("b", "icr", 1.0), fit_of("b", "ideal", 2.0)]
    assert contradictions(PLACE, found, fitness) == [
        "On whole runs on grass icr (J/N 5) errs more than ideal (1.5; on 1 of 2 runs), although "
        "its mean translation error over 2 m is less."
    ]
    assert contradictions(PLACE, found, fitness[2:]) == []
    assert contradictions(PLACE, found, fitness[:1]) == []  # nothing of the other


def test_contradictions_follow_the_best_models():
    found = summaries_of(icr=[0.02] * 4, ideal=[0.3] * 4)
    fitness = [fit_of("a", "icr", 9.0), fit_of("a", "ideal", 1.0)]
    lines = sentences(PLACE, found, [], fitness)
    assert lines[2:] == contradictions(PLACE, found, fitness)
