"""Courses of a latency from lags of pieces that are made by formulas of their own."""

import numpy as np
import pytest

from odometry.checks.statistics.lag import Lags
from odometry.checks.statistics.latency_course import (
    CONSTANT,
    COURSE,
    LINE,
    STEP,
    latency_course,
)

AT_S = np.arange(4.0, 240.0, 8.0)


def lags(seconds, seed=0, noise_s=0.025):
    noise = np.random.default_rng(seed).normal(0, noise_s, len(AT_S))
    return Lags(AT_S, seconds + noise, np.full(len(AT_S), 0.01), np.full(len(AT_S), 0.98))


TRUE = {
    CONSTANT: np.full(len(AT_S), 0.3),
    LINE: 0.002 * AT_S,
    STEP: np.where(AT_S > 100, 0.3, -0.05),
    COURSE: 0.5 * (1 - np.exp(-np.maximum(AT_S - 60, 0) / 50)),
}


@pytest.mark.parametrize("kind", TRUE)
def test_the_kind_of_course_and_its_size_are_found(kind):
    found = latency_course(lags(TRUE[kind]))
    assert found.kind == kind
    np.testing.assert_allclose(found.seconds, TRUE[kind], atol=0.07)
    assert np.median(np.abs(found.seconds - TRUE[kind]) / found.sigmas_s) < 2.5


def test_less_than_lags_differ_by_themselves_is_no_course():
    """Smooth lags of a few milliseconds: the scatter says more than their own noise allows."""
    assert latency_course(lags(2e-5 * AT_S, noise_s=1e-4)).kind == CONSTANT


@pytest.mark.parametrize("seed", range(20))
def test_noise_makes_no_course(seed):
    assert latency_course(lags(TRUE[CONSTANT], seed, 0.05)).gain < 10


def test_the_moment_of_a_step_lies_between_its_pieces():
    found = latency_course(lags(TRUE[STEP]))
    assert found.moment_s == pytest.approx(104, abs=4)
    np.testing.assert_allclose(found.at(np.array([100.0, 108.0])), [-0.05, 0.3], atol=0.02)


def test_pieces_far_off_change_little():
    off = TRUE[LINE].copy()
    off[[3, 17]] = 2.0, -1.5
    np.testing.assert_allclose(latency_course(lags(off)).at(AT_S), TRUE[LINE], atol=0.03)


@pytest.mark.parametrize("piece", [0, 13, len(AT_S) - 1])
def test_one_piece_makes_no_course(piece):
    off = TRUE[CONSTANT].copy()
    off[piece] += 1.1
    assert latency_course(lags(off, noise_s=0.005)).gain < 10


def test_noise_is_no_less_than_lags_have_of_their_own():
    """Eight pieces that lie on a curve by chance."""
    eight = Lags(*(of[:8] for of in lags(np.interp(AT_S, [4, 20, 60], [-0.06, 0.03, 0]), 0, 0.001)))
    assert latency_course(eight).gain < 10


def test_few_pieces_have_no_course():
    few = Lags(*(of[:5] for of in lags(TRUE[LINE])))
    assert latency_course(few) is None
