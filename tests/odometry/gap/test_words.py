"""Sentences of a result: honest where nothing, something unknown, or something named is missing."""

from dataclasses import replace

import pytest

from odometry.gap.closed import Share, held_out_share
from odometry.gap.statistic import Gap
from odometry.gap.words import percent, sentences, with_interval


def text(result):
    return " ".join(sentences(result))


def test_a_named_effect_with_its_numbers(scaled_result):
    said = sentences(scaled_result)
    share = held_out_share(scaled_result)
    assert said[0] == (
        f"Missing in icr: wheel_scale and lever_arm; together they close {percent(share)} of the "
        "held-out excess."
    )
    whole = text(scaled_result)
    closing = scaled_result.holdout
    for gap in (closing.before, closing.after, closing.noise_floor, scaled_result.measured.before):
        assert with_interval(gap) in whole
    assert "c_l = 0.8 (0.79 to 0.82), c_r = 0.8 (0.79 to 0.82)" in whole
    assert "x_arm = 0.001 m (-0.009 to 0.021)" in whole
    assert "acts on the commands" in whole
    assert "acts on the measurement" in whole
    assert "cannot tell wheel_scale from traction_loss; what would: a free wheel." in whole
    assert "What is left cannot be told from noise." in whole
    predicted = [one.name for one in scaled_result.location.predictors if one.discovered]
    assert "speed" in predicted
    assert "speed" in next(s for s in said if s.startswith("What predicts the disagreement"))
    assert scaled_result.location.regions[0].words in whole


def test_none_claims_nothing(none_result):
    said = sentences(none_result)
    assert said[0].startswith("Nothing that these runs could show is missing in icr")
    assert said[0].endswith("noise explains the gap.")
    assert held_out_share(none_result) is None
    whole = text(none_result)
    for word in ("Missing", "Effect", "closed", "Left", "share"):
        assert word not in whole


def test_none_admits_a_gap_above_the_floor(none_result):
    measured = replace(none_result.measured, before=Gap(0.2, 0.15, 0.3))
    said = sentences(replace(none_result, measured=measured))
    assert "the gap is above the noise floor" in said[0]
    assert "noise explains the gap" not in said[0]


def test_unknown_without_any_name_says_so(none_result):
    first, *_ = sentences(replace(none_result, verdict="unknown"))
    assert first.startswith("Something is missing in icr that neither an effect")


def test_unknown_says_what_it_follows_and_what_is_left(unknown_result):
    said = sentences(unknown_result)
    assert said[0].startswith(
        "Something is missing in icr that no effect of the catalogue explains; it follows heading; "
        "a smooth term closes "
    )
    left = unknown_result.holdout.after.value - unknown_result.holdout.noise_floor.value
    assert said[-1] == f"Left unexplained: {left:.3g} m above the noise floor."


def test_a_named_effect_beside_an_unknown_one(scaled_result, unknown_result):
    both = (scaled_result.effects[0], unknown_result.effects[0])
    said = sentences(replace(scaled_result, effects=both))
    assert said[0].startswith(
        "Missing in icr: wheel_scale, and something unknown that follows heading; together they "
    )


def test_every_sentence_ends_and_holds_no_odd_number(scaled_result, none_result, unknown_result):
    for result in (scaled_result, none_result, unknown_result):
        for sentence in sentences(result):
            assert sentence.endswith(".")
            assert "nan" not in sentence.split()
            assert "inf" not in sentence.split()


def test_the_share_is_that_of_its_definition(scaled_result):
    closing = scaled_result.holdout
    share = held_out_share(scaled_result)
    expected = (closing.before.value - closing.after.value) / (
        closing.before.value - closing.noise_floor.value
    )
    assert share.value == pytest.approx(expected)
    assert share.low < expected < share.high
    assert share.low > 0.85
    assert share.high < 1.15
    assert share == held_out_share(scaled_result)


def test_an_effect_that_explains_nothing_closes_nothing(unknown_result):
    share = held_out_share(unknown_result)
    assert abs(share.value) < 0.05
    assert share.low < 0.05


def test_an_interval_is_told_only_of_several_stretches():
    for pieces, words in (
        (1, "0.0498 m (no interval can be told from one stretch)"),
        (3, "0.0498 m (0.04 to 0.06, from 3 stretches alone)"),
        (5, "0.0498 m (0.04 to 0.06)"),
    ):
        assert with_interval(Gap(0.0498, 0.04, 0.06, pieces)) == words
    assert percent(Share(0.9, 0.9, 0.9, 1)) == "90 % (no interval can be told from one stretch)"
    assert percent(Share(0.9, 0.8, 1.0, 4)) == "90 % (80 to 100, from 4 stretches alone)"


def test_one_measured_stretch_says_neither_nothing_nor_something(none_result):
    one = Gap(0.2, 0.2, 0.2, 1)
    measured = replace(none_result.measured, before=one, after=one)
    first, second, *_ = sentences(replace(none_result, measured=measured))
    assert first.startswith("Whether something is missing in icr cannot be told")
    assert "0.2 m (no interval can be told from one stretch) on the measured runs" in second
