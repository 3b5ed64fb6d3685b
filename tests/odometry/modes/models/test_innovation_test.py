"""Whether a mode fits: innovations are drawn here, white or with what a fault would leave."""

import numpy as np
import pytest

from odometry.modes.follow.answers import named_modes, refusals
from odometry.modes.follow.followed import misfits
from odometry.modes.follow.track import ModeTrack
from odometry.modes.models.innovation_test import (
    CLIP,
    LONG_CLIP,
    LONG_WINDOW_S,
    MISFIT_LASTS_S,
    WINDOW_S,
    Innovations,
    mode_fit,
)
from odometry.modes.models.mode_set import NONE_OF_THESE, UNDETERMINED

STEP_S, SIZE = 0.02, 1500
STAMPS_S = STEP_S * np.arange(SIZE)
DWELL_S = np.array([20.0, 20.0])
HALF = SIZE // 2


def drawn(off=(0.0, 3.0), entries=1, seed=5):
    """White innovations (N, M, m) of two modes, off by so many standard deviations."""
    noise = np.random.default_rng(seed).normal(size=(SIZE, 1, entries))
    return noise + np.array(off)[:, None]


def fit_of(innovations, independent=1.0, share=0.05, lead=0):
    leading = np.full(SIZE, lead)
    return mode_fit(Innovations(innovations, leading, STAMPS_S, independent), DWELL_S, share)


def track_of(fit, first=0.99):
    """A track that names the first of two modes all along."""
    rows = np.tile([first, 1 - first], (SIZE, 1))
    blank, labels = np.zeros((SIZE, 3)), np.full(SIZE, "unknown", dtype=object)
    return ModeTrack(("a", "b"), STAMPS_S, rows, blank, blank, blank[:, 0], labels, fit)


def test_a_mode_that_is_true_stays_above_none():
    """None begins with its share, and pays for being broad in every window."""
    fit = fit_of(drawn())
    assert fit.none[0] == pytest.approx(0.05, abs=0.01)
    assert fit.none[200:].max() < 0.02
    assert fit.log_probabilities[200:].argmax(axis=1).max() == 0
    np.testing.assert_allclose(np.exp(fit.log_probabilities).sum(axis=1), 1.0)
    odds = fit.none / np.exp(fit.log_probabilities[:, 0])
    np.testing.assert_allclose(fit.against_none[:, 0], 1 / (1 + odds), rtol=1e-9)


def test_sums_have_unit_variance_where_the_mode_is_true():
    sums = fit_of(drawn(entries=200)).sums[50:, 0]
    assert sums.std() == pytest.approx(1.0, abs=0.02)
    direct = drawn()[300 - round(WINDOW_S / STEP_S) + 1 : 301, 0].sum() / 5.0
    assert fit_of(drawn()).sums[300, 0, 0] == pytest.approx(direct)


@pytest.mark.parametrize("off", [1.0, 3.0, -8.0, 1e4])
def test_none_wins_within_seconds_where_all_modes_keep_a_sign(off):
    """A shift of one standard deviation is five in the sum of 25 samples."""
    innovations = np.concatenate([drawn()[:HALF], drawn((off, off))[HALF:]])
    fit = fit_of(innovations)
    assert fit.none[:HALF].max() < 0.06
    assert fit.none[HALF + 200 :].min() > 0.9


def test_none_wins_where_innovations_grow_without_a_sign():
    innovations = np.concatenate([drawn()[:HALF], 10 * drawn((0.0, 0.0))[HALF:]])
    assert fit_of(innovations).none[HALF + 200 :].min() > 0.9


def test_errors_that_last_are_expected_to():
    """Each is held for half a second: one standard deviation is one in the sum, too."""
    rows = np.arange(SIZE) // 25
    innovations = drawn()[rows]
    assert fit_of(innovations, independent=0.04).none[200:].max() < 0.05
    assert fit_of(innovations, independent=1.0).none.max() > 0.9


def test_a_single_outlier_is_no_misfit():
    innovations = drawn()
    innovations[400::50] = 1e6
    fit = fit_of(innovations)
    assert fit.none[200:].max() < 0.1
    clean = fit_of(drawn()).sums[400, 0, 0]
    assert fit.sums[400, 0, 0] == pytest.approx(clean + (CLIP - drawn()[400, 0, 0]) / 5.0)


def test_what_is_not_measured_says_nothing():
    """The share of none returns to what it is before anything is measured."""
    innovations = drawn()
    innovations[HALF:] = np.nan
    fit = fit_of(innovations)
    window = round(WINDOW_S / STEP_S)
    assert np.isnan(fit.sums[HALF + window :]).all()
    assert fit.none[HALF - 1] < 0.02
    expected = 0.05 - 0.05 * np.exp(-(SIZE - HALF) * STEP_S / MISFIT_LASTS_S / 0.95)
    assert fit.none[-1] == pytest.approx(expected, abs=0.01)


def test_a_mode_that_does_not_fit_is_not_named():
    innovations = np.concatenate([drawn()[:HALF], drawn((3.0, 3.0))[HALF:]])
    track = track_of(fit_of(innovations))
    answers = named_modes(track, 0.9)
    assert set(answers[100:HALF]) == {"a"}
    assert set(answers[HALF + 200 :]) == {NONE_OF_THESE}
    (one,) = misfits(track, 0.9)
    assert HALF * STEP_S - 0.1 < one.from_s < HALF * STEP_S + 0.5
    assert (one.to_s, one.signal) == (STAMPS_S[-1], 0)
    assert one.sigmas == pytest.approx(3.0 * 5.0, rel=0.15)


def test_a_mode_is_not_named_where_the_test_rules_it_out_for_another():
    track = track_of(fit_of(drawn((5.0, 0.0)), lead=1))
    assert set(named_modes(track, 0.9)[200:]) == {UNDETERMINED}


def test_long_sums_are_of_the_mode_in_the_lead():
    """Of 300 samples in six seconds; modes that change in between are joined."""
    innovations = np.clip(drawn(), -LONG_CLIP, LONG_CLIP)
    leading = (np.arange(SIZE) > HALF).astype(int)
    lasting = mode_fit(Innovations(drawn(), leading, STAMPS_S, 1.0), DWELL_S, 0.05).lasting
    rows = np.arange(HALF - 99, HALF + 201)
    direct = innovations[rows, leading[rows], 0].sum() / np.sqrt(300)
    assert lasting[HALF + 200, 0] == pytest.approx(direct)


def beyond(fit):
    return refusals(track_of(fit), 0.9)["six seconds"]


def test_a_small_misfit_that_lasts_is_none():
    """A third of a standard deviation is hidden in half a second, and six of a sum in six."""
    off = (0.35, 0.35)
    innovations = np.concatenate([drawn()[:HALF], drawn(off)[HALF:]])
    window = round(LONG_WINDOW_S / STEP_S)
    fit = fit_of(innovations)
    lasts = beyond(fit)
    assert not lasts[100:HALF].any()
    assert lasts[HALF + window :].all()
    answers = named_modes(track_of(fit), 0.9)
    assert set(answers[100:HALF]) == {"a"}
    assert set(answers[lasts & (fit.none < 0.9)]) == {UNDETERMINED}
    assert answers[-1] == NONE_OF_THESE


def test_a_misfit_that_changes_its_sign_within_the_long_window_is_no_lasting_one():
    sign = np.where(np.arange(SIZE) // 50 % 2, 1.0, -1.0)
    fit = fit_of(drawn((0.0, 0.0)) + 0.5 * sign[:, None, None])
    assert not beyond(fit)[round(LONG_WINDOW_S / STEP_S) :].any()


def test_the_signal_that_fits_least_is_said():
    innovations = drawn((0.0, 0.0), entries=3)
    innovations[HALF:, :, 1] += 4.0
    innovations[:, :, 2] = np.nan
    (one,) = misfits(track_of(fit_of(innovations)), 0.9)
    assert one.signal == 1


def test_a_filter_that_expects_more_faults_is_sure_of_them_sooner():
    innovations = np.concatenate([drawn()[:HALF], drawn((3.0, 3.0))[HALF:]])
    sooner, later = (
        np.flatnonzero(fit_of(innovations, share=share).none > 0.9)[0] for share in (0.2, 0.001)
    )
    assert sooner < later
