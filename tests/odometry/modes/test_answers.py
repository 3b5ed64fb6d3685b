"""What probabilities say: each number is counted by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.modes.answers import (
    UNDETERMINED,
    confusion,
    detections,
    disagreements,
    false_switches,
    named_modes,
)
from tests.odometry.modes.mode_examples import track

NAMES = ("a", "b", "c")
letters = st.lists(st.sampled_from(["a", "b", "c", ""]), min_size=2, max_size=30)


def test_a_mode_is_named_from_the_given_probability():
    known = track(["a", "b", ""], ["a"] * 3, probability=0.95)
    assert named_modes(known, 0.95).tolist() == ["a", "b", UNDETERMINED]
    assert named_modes(known, 0.951).tolist() == [UNDETERMINED] * 3


def test_time_to_detection_and_the_shares_after_it():
    most = ["", "b", "a", "", "a", "b", "a", "b", "b"]
    (first, second) = detections(track(most, ["a"] * 7 + ["b"] * 2), 0.9)
    assert (first.mode, first.from_s, first.to_s, first.after_s) == ("a", 0.0, 3.0, 1.0)
    assert (first.right, first.undetermined, first.wrong) == pytest.approx((0.6, 0.2, 0.2))
    assert (second.mode, second.from_s, second.after_s, second.right) == ("b", 3.5, 0.0, 1.0)


def test_what_is_never_told_has_no_numbers():
    (never,) = detections(track(["b", ""], ["a", "a"]), 0.9)
    numbers = (never.after_s, never.right, never.wrong, never.undetermined)
    assert np.isnan(numbers).all()


def test_what_is_told_at_the_last_stamp_was_right():
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
    assert seconds.tolist() == [[1.0, 0.5, 0.0, 0.0], [0.0, 0.5, 0.0, 0.5], [0.0] * 4]


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
