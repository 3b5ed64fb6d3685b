"""What probabilities say: each number is counted by hand."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from odometry.modes.follow.answers import candidates, disagreements, named_modes, refusals
from odometry.modes.follow.detection import confusion, detections, false_switches, narrowed_s
from odometry.modes.models.innovation_test import ModeFit
from odometry.modes.models.mode_set import UNDETERMINED
from odometry.modes.modes_config import ModesConfig
from tests.odometry.modes.mode_examples import track

NAMES = ("a", "b", "c")
letters = st.lists(st.sampled_from(["a", "b", "c", ""]), min_size=2, max_size=30)


def test_a_mode_is_named_from_the_given_probability():
    known = track(["a", "b", ""], ["a"] * 3, probability=0.95)
    assert named_modes(known, 0.95).tolist() == ["a", "b", UNDETERMINED]
    assert named_modes(known, 0.951).tolist() == [UNDETERMINED] * 3


def with_probabilities(of_a):
    of_a = np.array(of_a)
    rows = np.column_stack([of_a, 1 - of_a, 0 * of_a])
    return replace(track(["a"] * len(of_a), ["a"] * len(of_a)), probabilities=rows)


def test_a_named_mode_stays_named_until_it_is_twice_as_doubtful():
    known = with_probabilities([0.85, 0.91, 0.85, 0.81, 0.79, 0.85, 0.92])
    named = ["a" if named else UNDETERMINED for named in (0, 1, 1, 1, 0, 0, 1)]
    assert named_modes(known, 0.9).tolist() == named


def test_another_mode_that_leads_must_be_sure_by_itself():
    known = with_probabilities([0.95, 0.15, 0.09, 0.15])
    assert named_modes(known, 0.9).tolist() == ["a", UNDETERMINED, "b", "b"]


def test_each_test_that_refuses_is_said_by_name():
    off = np.array([False, True])
    known = replace(track(["a", "a"], ["a"] * 2), turns_are_off=off, alike=off[:, None])
    found = refusals(known, 0.9)
    assert {name: of.tolist() for name, of in found.items()} == {
        "probability": [False, False],
        "alike": [False, True],
        "turns": [False, True],
    }


def test_feel_says_which_of_modes_that_fit_as_well_it_is():
    """Not where feel is for another one, nor against what turns say."""
    logs = np.log(np.tile([0.4, 0.4, 0.199, 0.001], (2, 1)))
    fit = ModeFit(np.zeros((2, 3, 1)), np.zeros((2, 1)), logs)
    felt = np.array([[0.7, 0.2, 0.1], [0.2, 0.7, 0.1]])
    known = replace(track(["a", "a"], ["a"] * 2), fit=fit, felt=felt)
    assert named_modes(known, 0.9).tolist() == ["a", UNDETERMINED]
    contradicted = replace(known, turns_are_off=np.array([True, True]))
    assert named_modes(contradicted, 0.9).tolist() == [UNDETERMINED] * 2


def test_time_to_detection_and_the_shares_after_it():
    most = ["", "b", "a", "", "a", "b", "a", "b", "b"]
    (first, second) = detections(track(most, ["a"] * 7 + ["b"] * 2), 0.9)
    assert (first.mode, first.from_s, first.to_s, first.after_s) == ("a", 0.0, 3.0, 1.0)
    assert (first.right, first.undetermined, first.wrong) == pytest.approx((0.6, 0.2, 0.2))
    assert (second.mode, second.from_s, second.after_s, second.right) == ("b", 3.5, 0.0, 1.0)


def test_what_is_never_recognised_has_no_numbers():
    (never,) = detections(track(["b", ""], ["a", "a"]), 0.9)
    numbers = (never.after_s, never.right, never.wrong, never.undetermined)
    assert np.isnan(numbers).all()


def test_what_is_recognised_at_the_last_stamp_was_right():
    (late,) = detections(track(["", "", "a"], ["a"] * 3), 0.9)
    assert (late.after_s, late.right, late.wrong, late.undetermined) == (1.0, 1.0, 0.0, 0.0)


def test_stretches_of_what_is_no_mode_are_not_judged():
    labels = ["unknown", "unknown", "gravel", "gravel", "a"]
    assert [one.mode for one in detections(track(["a"] * 5, labels), 0.9)] == ["a"]


def test_false_switches_are_turns_to_a_wrong_mode():
    most = ["b", "b", "", "b", "a", "c", "", "c", "a", "b"]
    assert false_switches(track(most, ["a"] * 10), 0.9) == 3
    assert false_switches(track(most, ["unknown"] * 10), 0.9) == 0


def test_seconds_by_true_mode_and_answer():
    most = ["a", "a", "b", "", "b", "c"]
    seconds = confusion(track(most, ["a"] * 3 + ["b"] * 3), 0.9, NAMES)
    assert seconds.tolist() == [[1.0, 0.5, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.0, 0.5], [0.0] * 5]


@given(letters)
def test_confusion_is_all_the_time_there_is(most):
    known = track(most, ["a"] * len(most))
    assert confusion(known, 0.9, NAMES).sum() == pytest.approx(known.stamps_s[-1])


@given(letters)
def test_shares_sum_to_one(most):
    for one in detections(track(most, ["a"] * len(most)), 0.9):
        total = one.right + one.wrong + one.undetermined
        assert np.isnan(total) or total == pytest.approx(1.0)


def test_disagreements_that_last():
    motion = track(["a"] * 5 + [""] + ["a"] * 3 + ["b"] * 2, ["unknown"] * 11)
    sight = np.array(["unknown"] + ["b"] * 10, dtype=object)
    assert disagreements(motion, sight, 0.9, 3.5) == ((0.5, 4.0, "b", "a"),)
    assert disagreements(motion, sight, 0.9, 3.6) == ()


def test_a_disagreement_ends_where_they_agree_or_name_others():
    motion = track(["a", "a", "b", "a", "a", "c", "c", "c"], ["unknown"] * 8)
    sight = np.array(["b"] * 5 + ["b", "a", "a"], dtype=object)
    assert disagreements(motion, sight, 0.9, 0.5) == (
        (0.0, 0.5, "b", "a"),
        (1.5, 2.0, "b", "a"),
        (2.5, 2.5, "b", "c"),
        (3.0, 3.5, "a", "c"),
    )
    assert disagreements(motion, np.full(8, "unknown", dtype=object), 0.9, 0.5) == ()


@pytest.mark.parametrize(
    ("probabilities", "chosen"),
    [
        ([0.95, 0.03, 0.02], [True, False, False]),
        ([0.5, 0.1, 0.4], [True, False, True]),
        ([0.05, 0.46, 0.49], [False, True, True]),
        ([0.4, 0.3, 0.3], [True, True, True]),
        ([0.02, 0.9, 0.08], [False, True, False]),
    ],
)
def test_the_fewest_modes_that_are_sure_together(probabilities, chosen):
    known = replace(track(["a"], ["a"]), probabilities=np.array([probabilities]))
    assert candidates(known, 0.9).tolist() == [chosen]


def test_modes_that_the_drive_does_not_distinguish_are_candidates_too():
    """Whatever their probability: of two equal modes the wrong one may be 0.99 probable."""
    known = track(["a", "a"], ["b", "b"], probability=0.99)
    alike = np.array([[False, True, False], [False, False, False]])
    chosen = candidates(replace(known, alike=alike), 0.9)
    assert chosen.tolist() == [[True, True, False], [True, False, False]]
    narrowed, missed = narrowed_s(replace(known, alike=alike), 0.995)
    assert (narrowed, missed) == (0.5, 0.0)


@pytest.mark.parametrize(("probability", "named"), [(0.85, "a"), (0.75, UNDETERMINED)])
def test_a_mode_stays_named_for_as_much_doubt_as_the_settings_say(probability, named):
    known = track(["a", "a"], ["a", "a"], names=("a", "b"))
    known.probabilities[1] = probability, 1 - probability
    assert named_modes(known, 0.9).tolist() == ["a", named]
    strict = replace(known, config=ModesConfig(most_doubt=1.0))
    assert named_modes(strict, 0.9).tolist() == ["a", UNDETERMINED]


@given(arrays(float, (5, 4), elements=st.floats(1e-6, 1.0)), st.floats(0.51, 0.99))
def test_candidates_are_sure_and_none_of_them_can_be_spared(weights, sure):
    probabilities = weights / weights.sum(axis=1, keepdims=True)
    known = replace(track(["a"] * 5, ["a"] * 5), probabilities=probabilities)
    chosen = candidates(known, sure)
    for row, of in zip(probabilities, chosen, strict=True):
        assert row[of].sum() >= sure - 1e-12
        assert row[of].sum() - row[of].min() < sure + 1e-12
        assert row[of].min() >= max(row[~of], default=0.0)


@pytest.mark.parametrize(("share", "answer"), [(0.55, UNDETERMINED), (0.65, "a")])
def test_a_mode_is_named_where_the_rolling_test_takes_it_for_the_one_that_fits(share, answer):
    """None of these is as improbable in both, and the other two share what is left."""
    others = (1 - share - 1e-3) / 2
    logs = np.log(np.tile([share, others, others, 1e-3], (2, 1)))
    fit = ModeFit(np.zeros((2, 3, 1)), np.zeros((2, 1)), logs)
    known = replace(track(["a", "a"], ["a"] * 2), fit=fit)
    assert named_modes(known, 0.9).tolist() == [answer] * 2
