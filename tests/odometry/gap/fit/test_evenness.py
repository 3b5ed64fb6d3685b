"""The strength of an effect between pieces of the runs."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.gap.config import GapConfig
from odometry.gap.fit.evenness import Unevenness, between_pieces, unevenness
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name.form_gates import (
    is_even,
)
from odometry.gap.prepare.measured import measured_of

PIECES = np.repeat(np.arange(60), 5)
CONFIG = GapConfig()


def drawn(rng, share, noise):
    """Strengths of windows of known weights, scattered between pieces by a share."""
    weights = rng.uniform(50, 150, len(PIECES))
    own = rng.normal(0, share, 60)[PIECES]
    return own + noise * rng.normal(size=len(PIECES)) / np.sqrt(weights), weights


@pytest.mark.parametrize("noise", [1.0, 3.0])
def test_a_scatter_between_pieces_is_found_at_any_noise(rng, noise):
    found = between_pieces(*drawn(rng, 0.5, noise), PIECES)
    assert found.share == pytest.approx(0.5, rel=0.25)
    assert found.probability < 1e-6


@pytest.mark.parametrize("noise", [1.0, 3.0])
def test_one_strength_with_noise_is_one(rng, noise):
    found = between_pieces(*drawn(rng, 0.0, noise), PIECES)
    assert found.share < 0.1
    assert found.probability > 1e-3


def test_with_equal_weights_it_is_the_variance_less_that_of_noise():
    """DerSimonian and Laird's estimate is then s^2 - 1/w, here of all but the last piece."""
    strengths, weight = np.array([0.1, 0.5, 1.1, 1.9, 40.0]), 4.0
    found = between_pieces(strengths, np.full(5, weight), np.arange(5))
    assert found.share**2 == pytest.approx(np.var(strengths[:-1], ddof=1) - 1 / weight)


def test_one_piece_alone_says_nothing(rng):
    strengths, weights = drawn(rng, 0.0, 1.0)
    found = between_pieces(strengths + 3.0 * (PIECES == 7), weights, PIECES)
    assert found.share < 0.1


def test_few_pieces_say_nothing():
    assert between_pieces(np.arange(3.0), np.ones(3), np.arange(3)) == Unevenness(0.0, 1.0)


@pytest.fixture(scope="module")
def fit_of(make_scene, known):
    """Unevenness of a wheel scale fitted to what it is said to be at each moment."""

    def of(scale):
        def planted(columns, twist):
            return scale(columns["t"])[:, None] * twist

        fitter = Fitter(known, measured_of([make_scene(3, planted)], known, CONFIG))
        fit = fitter.fit([WheelScale()])
        assert fit.effects[0].values == pytest.approx(0.9, abs=0.04)
        return unevenness(fitter, fit, 0), unevenness(fitter, _half(fit), 0)

    return of


def _half(fit):
    """The same with half of the effect: the strength missing is the same everywhere."""
    (added,) = fit.effects
    return replace(fit, effects=(Added(added.effect, (1 + added.values) / 2),))


def test_wheels_of_one_scale_are_even(fit_of):
    whole, half = fit_of(lambda t: np.full(len(t), 0.9))
    assert not is_even(whole, CONFIG)
    assert not is_even(half, CONFIG)


def test_wheels_that_change_are_not(fit_of):
    whole, _ = fit_of(lambda t: np.where(t % 40 < 20, 0.82, 0.98))
    assert whole.share == pytest.approx(0.8, abs=0.25)
    assert "its strength differs" in is_even(whole, CONFIG)
