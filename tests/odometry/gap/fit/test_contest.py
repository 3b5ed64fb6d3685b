"""Evidence that is sure: pieces of the runs are a sample, and one moment is none."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import ttest_1samp

from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.sensor_mount import HeadingOffset
from odometry.effects.motion.slope_icr import SlopeByIcr
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import margin_of, penalty, ranked
from odometry.gap.fit.fitter import Fitter
from odometry.gap.prepare.measured import measured_of

CONFIG = GapConfig()


@pytest.fixture(scope="module")
def fitter(make_scene, known):
    scenes = [make_scene(70, duration_s=150.0), make_scene(71, duration_s=60.0)]
    return Fitter(known, measured_of(scenes, known, CONFIG))


@pytest.fixture(scope="module")
def gaining(fitter):
    """Score an effect by what it gains in each piece, shared evenly by the piece's windows."""
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


def test_the_least_evidence_is_that_of_a_t_test_or_without_the_best_pieces(gaining, fitter, rng):
    count = len(np.unique(fitter.measured.pieces))
    gains = rng.normal(3.0, 4.0, count)
    judged = gaining(gains, moved=5.0)
    test = ttest_1samp(gains, 0.0, alternative="greater").confidence_interval(0.95)
    least = max(count * test.low, np.sort(gains)[: -CONFIG.trimmed].sum()) + 5.0
    paid = penalty(1, judged.fitted)
    spread = spread_of(fitter, judged)
    assert judged.least == pytest.approx(least / spread - paid)
    assert judged.evidence == pytest.approx((gains.sum() + 5.0) / spread - paid)


def test_a_gain_that_all_pieces_share_is_sure(gaining, fitter):
    judged = gaining(np.full(len(np.unique(fitter.measured.pieces)), 4.0))
    assert judged.least == pytest.approx(judged.evidence)
    assert judged.least > CONFIG.least_evidence


def test_a_gain_of_one_piece_alone_is_not_believed(gaining, fitter):
    """As large as any."""
    for gain in (200.0, 1000.0):
        gains = np.zeros(len(np.unique(fitter.measured.pieces)))
        gains[3] = gain
        judged = gaining(gains)
        assert judged.evidence > CONFIG.least_evidence
        assert judged.least < 0


def test_of_a_single_piece_nothing_is_sure(gaining, fitter):
    whole = replace(fitter.measured, pieces=np.zeros_like(fitter.measured.pieces))
    one = Fitter(fitter.calibration, whole)
    judged = gaining(np.full(len(np.unique(fitter.measured.pieces)), 4.0), fitter=one)
    assert judged.least == -np.inf


def test_of_equal_evidence_the_surer_goes_first_then_the_simpler(fitter):
    """Whatever the order in which they were tried, and whatever rounding adds."""
    before = fitter.fit([])
    _, piece = np.unique(fitter.measured.pieces, return_inverse=True)
    counts = np.bincount(piece)
    even = np.full(len(counts), 40.0)
    uneven = even + np.array([30.0, -30.0, *np.zeros(len(counts) - 2)])
    surer, less_sure = (
        replace(
            before,
            effects=(Added(HeadingOffset(), np.zeros(1)),),
            held_out=before.held_out - (gains / counts)[piece],
        )
        for gains in (even, uneven * (1 + 1e-15))
    )
    for order in ([surer, less_sure], [less_sure, surer]):
        first, second = ranked(fitter, before, order, CONFIG)
        assert first.evidence == pytest.approx(second.evidence, abs=1e-7)
        assert first.fitted is surer


def test_of_equal_evidence_and_sureness_fewer_parameters_go_first(fitter, monkeypatch):
    before = fitter.fit([])
    monkeypatch.setattr("odometry.gap.fit.contest.penalty", lambda *_: 0.0)
    few, many = (
        replace(before, effects=(Added(effect, np.zeros(count)),))
        for effect, count in ((HeadingOffset(), 1), (SlopeByIcr(), 3))
    )
    for order in ([few, many], [many, few]):
        assert ranked(fitter, before, order, CONFIG)[0].fitted is few


@pytest.mark.parametrize(
    ("spread", "closed", "expected"), [(0.9, 100.0, 6.0), (2.0, 100.0, 12.0), (1.0, 80000.0, 400.0)]
)
def test_a_smooth_function_beats_names_by_evidence_and_by_a_share_of_what_they_close(
    spread, closed, expected
):
    assert margin_of(CONFIG, spread, closed) == pytest.approx(expected)
