"""By how much each number of the base moved, in standard deviations of its calibration."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.gap.show.words import moved_words, moves_of, sentences


@pytest.fixture(scope="module")
def calibration(known):
    """Every number of the base free, and known together with others."""
    base = known.base
    uncertain = replace(known.uncertain, free=np.ones(len(base.values), bool), latency_is_free=True)
    root = np.random.default_rng(3).normal(size=(len(uncertain.values),) * 2)
    return replace(
        known, uncertain=uncertain, information=1e4 * (root @ root.T + np.eye(len(root)))
    )


def test_a_base_as_calibrated_moved_by_nothing(calibration):
    moves = moves_of(calibration, calibration.base)
    assert tuple(one.name for one in moves) == calibration.uncertain.names
    assert [one.sigmas for one in moves] == [0.0] * len(moves)
    assert not any(one.is_far for one in moves)


def test_a_base_known_as_given_has_none(known):
    assert moves_of(known, known.base) == ()


def test_standard_deviations_are_those_of_the_information(calibration, rng):
    """Draws with the covariance of the calibration scatter by one of them."""
    uncertain = calibration.uncertain
    covariance = np.linalg.inv(calibration.information)
    drawn = rng.multivariate_normal(uncertain.values, covariance, 4000)
    moved = [moves_of(calibration, uncertain.at(one)) for one in drawn]
    sizes = np.array([[one.sigmas for one in moves] for moves in moved])
    np.testing.assert_allclose(np.sqrt((sizes**2).mean(axis=0)), 1.0, rtol=0.05)


def with_move(result, calibration, name, by):
    values = calibration.uncertain.values.copy()
    values[calibration.uncertain.names.index(name)] += by
    return replace(result, calibration=calibration, base=calibration.uncertain.at(values))


def test_a_move_that_is_not_allowed_is_said(scaled_result, calibration):
    alpha = calibration.base.values[calibration.uncertain.names.index("alpha_left")]
    moved = with_move(scaled_result, calibration, "alpha_left", 0.05 * alpha)
    (said,) = [text for text in sentences(moved) if "of the base moved" in text]
    assert said.startswith("alpha_left of the base moved from ")
    assert "(+5.0 %)" in said
    assert said.endswith("more than chance explains.")
    assert not [text for text in sentences(scaled_result) if "of the base moved" in text]


def test_none_says_that_no_gap_shows_a_move(scaled_result, calibration):
    none = replace(scaled_result, verdict="none", effects=())
    moved = with_move(none, calibration, "latency", 0.2)
    (said,) = [text for text in sentences(moved) if "of the base moved" in text]
    assert said.endswith(", though the gap on held-out data does not show it.")


def test_words_of_a_number_with_a_unit(scaled_result, calibration):
    result = with_move(scaled_result, calibration, "latency", 0.2)
    (moved,) = [one for one in moves_of(calibration, result.base) if one.sigmas > 0]
    assert moved.after - moved.before == pytest.approx(0.2)
    assert " s, " in moved_words(moved)
