"""Modes whose motions are equal within their own lasting errors, by gains that are put in."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.checks.track_checks import similar_modes
from odometry.modes.follow.answers import named_modes
from odometry.modes.follow.track import follow_signals
from odometry.modes.models.mode_set import DWELL_S, UNDETERMINED, ModeSet
from odometry.modes.models.response import BLOCK_S
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals

STEP_S, RATE_HZ, SIGMA_RAD_S, LASTING_S = 0.02, 10.0, 0.05, 0.5
LASTING_RAD_S = SIGMA_RAD_S * np.sqrt(LASTING_S / BLOCK_S)  # of a mean over BLOCK_S


def modes(*turns):
    """Modes that turn by so much per difference of tread speeds."""
    count = len(turns)
    A = np.tile(-RATE_HZ * np.eye(2), (count, 1, 1))
    B = RATE_HZ * np.stack([[[0.5, 0.5], [-turn, turn]] for turn in turns])
    noise = np.full((count, 2), 1e-4), np.full((count, 2), SIGMA_RAD_S**2)
    return VelocityModes(tuple("abc"[:count]), A, B, *noise, LASTING_S)


def drive(differences, omega=None):
    """Half a metre a second ahead with differences (N,) of tread speeds."""
    size = len(differences)
    treads = 0.5 + np.outer(differences, [-0.5, 0.5])
    omega = np.zeros(size) if omega is None else omega
    measured = np.column_stack([np.full(size, np.nan), omega])
    labels = np.full(size, "unknown", dtype=object)
    return Signals(STEP_S * np.arange(size), treads, measured, labels)


@pytest.mark.parametrize(("factor", "expected"), [(0.95, True), (1.05, False)])
def test_modes_are_alike_up_to_some_deviations_of_what_lasts(factor, expected):
    """Yaw rates differ by 0.5 times the difference of treads."""
    signals = drive(np.full(500, factor * ModesConfig.alike_sigmas * LASTING_RAD_S / 0.5))
    alike = similar_modes(signals, modes(1.0, 1.5), np.zeros(500, dtype=int))
    assert not alike[:, 0].any()
    assert (alike[200:, 1] == expected).all()


@pytest.mark.parametrize(("factor", "expected"), [(0.95, True), (1.05, False)])
def test_modes_are_alike_up_to_some_deviations_of_their_gain_from_turn_to_turn(factor, expected):
    """The yaw rate of the faster mode, of which its gain is off by 10 %, is so large that noise is
    none."""
    signals = drive(np.full(500, 100.0))
    apart = 1 / (1 - factor * ModesConfig.alike_sigmas * 0.1)
    known = replace(modes(1.0, apart), gain_spread=np.array([0.0, 0.1]))
    alike = similar_modes(signals, known, np.zeros(500, dtype=int))
    assert (alike[200:, 1] == expected).all()


def test_a_turn_distinguishes_modes_until_they_have_dwelt_for_long():
    turn = np.zeros(3000)
    turn[500:700] = 1.0
    signals = drive(turn)
    alike = similar_modes(signals, modes(1.0, 2.0), np.ones(3000, dtype=int))[:, 0]
    assert alike[:500].all()
    assert not alike[610:1700].any()
    assert alike[800 + round(DWELL_S / STEP_S) :].all()


def test_only_the_modes_near_the_leading_one_are_alike():
    signals = drive(np.ones(500))
    alike = similar_modes(signals, modes(1.0, 1.02, 2.0), np.repeat([0, 2], 250))
    np.testing.assert_array_equal(alike[249], [False, True, False])
    np.testing.assert_array_equal(alike[499], [False, False, False])


@pytest.mark.slow
def test_modes_within_an_error_of_each_other_are_not_named_however_long_one_fits_better():
    """The truth is the first mode; the second is off by one deviation of what lasts."""
    rng = np.random.default_rng(4)
    off = LASTING_RAD_S
    omega = 1.0 + 0.005 * rng.normal(size=3000)
    near, far = (
        follow_signals(drive(np.ones(3000), omega), ModeSet(modes(1.0, 1.0 + by), np.full(2, 20.0)))
        for by in (off, 10 * off)
    )
    assert set(named_modes(near, 0.9)) == {UNDETERMINED}
    assert named_modes(far, 0.9)[-1] == "a"


def test_turns_that_are_not_measured_determine_nothing():
    signals = drive(np.ones(500))
    signals.measured[:250] = np.nan
    alike = similar_modes(signals, modes(1.0, 2.0), np.zeros(500, dtype=int))[:, 1]
    assert alike[:250].all()
    assert not alike[400:].any()


def test_modes_of_one_model_are_distinguished_by_their_noise():
    alike = similar_modes(drive(np.ones(500)), modes(1.0, 1.0, 1.01), np.zeros(500, dtype=int))
    np.testing.assert_array_equal(alike[-1], [False, False, True])
