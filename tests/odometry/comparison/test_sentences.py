"""Sentences from errors that are written down here."""

import pytest

from odometry.comparison.evaluation import NotEvaluated, RunFitness
from odometry.comparison.sentences import contradictions, sentences
from odometry.comparison.summary import summarise
from odometry.evaluation.open_loop import Fitness
from tests.odometry.comparison.written_errors import PLACE, difference, evaluation


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
        "icr has the smallest error over 2 m on grass in translation, 0.0196 m per m.",
        "icr cannot be distinguished over 2 m on grass in translation from icr_symmetric "
        "(difference -0.0004 [-0.0017, 0.0010] m per m).",
    ]
    assert lines[-1] == (
        "Over 2 m no model is shown to beat a fitted effective width (icr_symmetric) on grass in "
        "translation or rotation."
    )


def test_a_model_that_beats_all_others():
    lines = said(
        {"icr_symmetric": 0.03, "icr": 0.02}, {("icr_symmetric", "icr"): (0.01, 0.005, 0.02)}
    )
    assert lines[0] == (
        "icr has the smallest error over 2 m on grass in translation, 0.0200 m per m; every "
        "other model has a larger one."
    )
    assert not any("effective width" in line for line in lines)


def test_a_model_that_was_not_evaluated_everywhere_is_not_ranked():
    evaluations = [
        evaluation("a", icr=[0.1], width=[0.2], part=[0.0]),
        evaluation("b", icr=[0.1], width=[0.2]),
    ]
    not_evaluated = [NotEvaluated("rover", "grass", "b", "part", "too few windows")]
    summaries = [summarise(PLACE, evaluations, not_evaluated, m) for m in ("icr", "width", "part")]
    lines = sentences(PLACE, summaries, [difference("icr", "width", -0.1, -0.2, -0.05)])
    assert lines[0].startswith("icr has the smallest error")
    assert lines[0].endswith("; every other ranked model has a larger one.")
    assert lines[-1] == "part is not in this comparison on grass: b: too few windows."


def summaries_of(**errors):
    one = evaluation("a", **errors)
    return [summarise(PLACE, [one], [], name) for name in errors]


def test_mean_and_median_that_disagree_are_both_reported():
    """A few windows with outliers: icr is better in most windows, and worse by the mean."""
    found = summaries_of(icr=[0.02, 0.02, 0.02, 0.9], width=[0.06, 0.06, 0.06, 0.5])
    (translation, rotation) = contradictions(PLACE, found, [])
    assert translation == (
        "Mean and median disagree on grass in translation: width has a smaller error than "
        "icr by the mean (0.1700 against 0.2400 m per m) and a larger one by the median (0.0600 "
        "against 0.0200): windows with large errors count for more in the means."
    )
    assert "rotation: width has a smaller error" in rotation


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
        "On whole runs on grass icr (J/N 5) has a larger error than ideal (1.5; on 1 of 2 runs), "
        "although its mean translation error over 2 m is less."
    ]
    assert contradictions(PLACE, found, fitness[2:]) == []
    assert contradictions(PLACE, found, fitness[:1]) == []  # nothing of the other


def test_contradictions_follow_the_best_models():
    found = summaries_of(icr=[0.02] * 4, ideal=[0.3] * 4)
    fitness = [fit_of("a", "icr", 9.0), fit_of("a", "ideal", 1.0)]
    lines = sentences(PLACE, found, [], fitness)
    assert lines[2:] == contradictions(PLACE, found, fitness)


@pytest.mark.parametrize(
    ("of_icr", "said"),
    [
        (9.6, "translation."),
        (
            4.0,
            "translation; on whole runs these have smaller errors: icr (J/N 4 against 10; on 1 "
            "of 1 runs).",
        ),
    ],
)
def test_an_effective_width_that_loses_on_whole_runs_is_not_said_to_win(of_icr, said):
    """Neither model is shown to have the smaller error over windows."""
    found = summaries_of(icr_symmetric=[0.02] * 4, icr=[0.03] * 4)
    fitness = [fit_of("a", "icr", of_icr), fit_of("a", "icr_symmetric", 10.0)]
    tied = [
        difference("icr_symmetric", "icr", -0.01, -0.03, 0.01),
        difference("icr_symmetric", "icr", 0.1, 0.05, 0.2, quantity="rotation"),
    ]
    lines = sentences(PLACE, found, tied, fitness)
    assert lines[-1] == (
        "Over 2 m no model is shown to beat a fitted effective width (icr_symmetric) on grass in "
        + said
    )
    contrary = [line for line in lines if line.startswith("On whole runs")]
    assert len(contrary) == (of_icr < 9.5)
