"""Evidence that is sure: pieces of the runs are a sample, and one moment is none."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import ttest_1samp

from odometry.effects.base import Base
from odometry.effects.corrected import Added
from odometry.effects.heading_offset import HeadingOffset
from odometry.effects.slope_icr import SlopeByIcr
from odometry.gap.config import GapConfig
from odometry.gap.contest import is_there, penalty, ranked
from odometry.gap.fit import Fitted, Fitter
from odometry.gap.measured import measured_of
from odometry.models.catalogue import MODELS
from odometry.run import Robot

CONFIG = GapConfig()


@pytest.fixture(scope="module")
def fitter(make_scene, known):
    scenes = [make_scene(70, duration_s=150.0), make_scene(71, duration_s=60.0)]
    return Fitter(known, measured_of(scenes, known, CONFIG))


@pytest.fixture(scope="module")
def gaining(fitter):
    """Judge an effect by what it gains in each piece, shared evenly by the piece's windows."""
    before = fitter.fit([])
    _, piece = np.unique(fitter.measured.pieces, return_inverse=True)

    def judged(of_pieces, *, fitter=fitter, moved=0.0):
        gains = (np.asarray(of_pieces) / np.bincount(piece))[piece]
        with_effect = replace(
            before,
            effects=(Added(HeadingOffset(), np.zeros(1)),),
            held_out=before.held_out - gains,
            base_moved=before.base_moved - moved,
        )
        return ranked(fitter, before, [with_effect], CONFIG)[0]

    return judged


def spread_of(fitter, judged):
    return max(1.0, judged.fitted.held_out.sum() / len(fitter.measured.window_of_row))


def test_the_least_evidence_is_the_bound_of_a_t_test_over_pieces(gaining, fitter, rng):
    count = len(np.unique(fitter.measured.pieces))
    gains = rng.normal(3.0, 4.0, count)
    judged = gaining(gains, moved=5.0)
    test = ttest_1samp(gains, 0.0, alternative="greater").confidence_interval(0.95)
    least = count * test.low + 5.0
    paid = penalty(1, judged.fitted)
    spread = spread_of(fitter, judged)
    assert judged.least == pytest.approx(least / spread - paid)
    assert judged.evidence == pytest.approx((gains.sum() + 5.0) / spread - paid)


def test_a_gain_that_all_pieces_share_is_sure(gaining, fitter):
    judged = gaining(np.full(len(np.unique(fitter.measured.pieces)), 4.0))
    assert judged.least == pytest.approx(judged.evidence)
    assert judged.least > CONFIG.least_evidence


def test_a_gain_of_one_piece_alone_is_not_believed(gaining, fitter):
    """As large as any: 1 - t times the gain is below zero."""
    for gain in (200.0, 1000.0):
        gains = np.zeros(len(np.unique(fitter.measured.pieces)))
        gains[3] = gain
        judged = gaining(gains)
        assert judged.evidence > CONFIG.least_evidence
        assert judged.least < -0.5 * gain


def test_of_a_single_piece_nothing_is_sure(gaining, fitter):
    whole = replace(fitter.measured, pieces=np.zeros_like(fitter.measured.pieces))
    one = Fitter(fitter.calibration, whole)
    judged = gaining(np.full(len(np.unique(fitter.measured.pieces)), 4.0), fitter=one)
    assert judged.least == -np.inf


def fitted(effect, values, covariance):
    base = Base(MODELS["icr"], np.array([0.4, -0.4, 0.0, 1.0, 1.0]), Robot(0.6))
    return Fitted(base, (Added(effect, np.array(values)),), covariance, np.ones(3), np.ones(3), 0.0)


def test_an_effect_known_only_as_a_product_is_there():
    """lambda v_max is known to 1 %, lambda and v_max are not."""
    along = np.array([0.1, 0.05, -10.0])
    covariance = 2.0 * np.outer(along, along) + np.diag([1e-6, 1e-6, 1e-2])
    assert is_there(fitted(SlopeByIcr(), [0.1, 0.05, 10.0], covariance))
    assert not is_there(fitted(SlopeByIcr(), [1e-4, 1e-4, 10.0], covariance))


def test_an_effect_within_its_uncertainty_of_none_is_not_there():
    assert not is_there(fitted(HeadingOffset(), [-0.0014], np.array([[1e-6]])))
    assert is_there(fitted(HeadingOffset(), [-0.0014], np.array([[1e-8]])))
