"""The three lines that open the page of modes."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.follow.followed import Followed
from odometry.modes.follow.track import ModesConfig
from odometry.modes.models.innovation_test import ModeFit
from odometry.modes.show.words import in_short
from tests.odometry.modes.mode_examples import run_of, track, velocity_set


def by_hand(most, names=("a", "b"), fit=None):
    """Answers that are given, each half a second; the run names none."""
    known = replace(track(most, ["unknown"] * len(most), names=names), fit=fit)
    mode_set = velocity_set(np.linspace(1.0, 2.0, len(names)), names=names)
    run = run_of(1.0, size=len(most))
    return Followed(run, mode_set, ModesConfig(), mode_set.modes.signals(run), known)


def small_misfit(lasts):
    """Modes that fit by all but what lasts, which is given at each stamp."""
    size = len(lasts)
    logs = np.log(np.tile([0.98, 0.01, 0.01], (size, 1)))
    return ModeFit(np.zeros((size, 2, 1)), np.array(lasts, dtype=float)[:, None], logs)


@pytest.mark.parametrize(
    ("most", "words"),
    [
        (["b", "a", "a"], "a at the end, since 0.5 s. "),
        (["b", "a", "", ""], "a at last, until 0.5 s; undetermined after that. "),
        (["", ""], "nothing that the motion distinguishes"),
        (["", "", "a"], "nothing that the motion distinguishes"),  # it lasts for no time
    ],
)
def test_an_answer_is_in_force_at_the_end_where_it_is_given_there(most, words):
    assert in_short(by_hand(most))[0].startswith(words)


@pytest.mark.parametrize(("sure", "said"), [(0.9, "90 %"), (0.9999999, "99.99999 %")])
def test_the_probability_that_is_asked_is_said_as_it_is(sure, said):
    answers = replace(by_hand(["a", "a"]), config=ModesConfig(sure=sure))
    assert f"where its probability is {said} or more" in in_short(answers)[1]


def test_few_answers_are_said_and_the_others_are_counted():
    short = in_short(by_hand([*"aaaabbbccd", "e", "e"], names=tuple("abcde")))
    assert short[0].endswith("Shares of the run: a 36 %, b 27 %, c 18 %, d 9 %, 1 other.")


def test_a_share_that_rounds_to_nothing_is_not_said():
    short = in_short(by_hand(["b", *"a" * 400]))
    assert short[0].endswith("Shares of the run: a 100 %.")


def test_where_a_probable_mode_does_not_fit_well_it_is_said_why_it_is_not_named():
    """Half of the time a sum of 4 standard deviations lasts, more than the bound."""
    answers = by_hand(["a"] * 9, fit=small_misfit([0.0] * 4 + [4.0] * 5))
    assert answers.doubtful(answers.motion) == pytest.approx(0.5)
    _, how_sure, to_do = in_short(answers)
    assert "50 % of the time one is as probable and is not named" in how_sure
    assert to_do.startswith("look at the innovations of each signal")


def test_where_modes_are_alike_none_is_doubtful():
    answers = by_hand(["a", "", "", ""])
    assert answers.doubtful(answers.motion) == 0.0
    assert (
        "at every moment. Not checked: terrains that the set does not hold" in in_short(answers)[1]
    )


@pytest.mark.parametrize(("sigmas", "begins"), [(2.5, "look at the innovations"), (3.5, "check ")])
def test_a_slight_misfit_asks_for_longer_runs_and_a_clear_one_for_checks(sigmas, begins):
    """None of these for 2 s, and what is left of the nearest mode by so many deviations."""
    size = 5
    logs = np.log(np.tile([0.04, 0.01, 0.95], (size, 1)))
    fit = ModeFit(np.full((size, 2, 2), sigmas), np.zeros((size, 2)), logs)
    assert in_short(by_hand(["a"] * size, fit=fit))[2].startswith(begins)
