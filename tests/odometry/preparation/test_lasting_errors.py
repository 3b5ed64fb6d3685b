"""Errors of positions that last, apart from their scatter."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from odometry.preparation.lasting_errors import USUAL, lasting_sigma_m
from tests.odometry.checks.drives import PERIOD_S, drive

SCATTER_M, EVERY = 0.5, 10  # rows of odometry at 20 Hz: positions at 2 Hz


def positions(share, seed, lasts_s=30.0, minutes=15):
    """A drive of lanes and curves, and its positions with white noise and errors that last."""
    rng = np.random.default_rng(seed)
    at_s = PERIOD_S * np.arange(int(60 * minutes / PERIOD_S))
    turns = 0.3 * np.sin(at_s / 9) * (np.sin(at_s / 60) > 0)
    run = drive(np.full(len(at_s), 0.6), turns, sigma_m=0.0, seed=seed)
    rows = slice(None, None, EVERY // 2)  # of poses at 10 Hz
    places = run.pose.stack("x", "y")[rows]
    keeps = np.exp(-EVERY * PERIOD_S / lasts_s)
    pushes = np.sqrt(1 - keeps**2) * rng.normal(size=places.shape)
    pushes[0] = rng.normal(size=2)
    lasting = lfilter([1.0], [1.0, -keeps], pushes, axis=0)
    places = places + SCATTER_M * (rng.normal(size=places.shape) + share * lasting)
    return run, run.pose.stamps_s[rows], places


@pytest.mark.parametrize("seed", range(4))
def test_scatter_alone_has_little_that_lasts(seed):
    assert lasting_sigma_m(*positions(0.0, seed), SCATTER_M) < 0.3 * SCATTER_M


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("share", "lasts_s"), [(0.6, 30.0), (1.2, 30.0), (1.2, 15.0)])
def test_what_lasts_is_found(share, lasts_s, seed):
    found_m = lasting_sigma_m(*positions(share, seed, lasts_s), SCATTER_M)
    assert found_m == pytest.approx(share * SCATTER_M, rel=0.4)


def test_short_recordings_and_those_without_a_gyroscope_have_the_usual_errors():
    run, stamps_s, places = positions(0.0, 0, minutes=1.5)
    assert lasting_sigma_m(run, stamps_s, places, SCATTER_M) == USUAL * SCATTER_M
    run, stamps_s, places = positions(0.0, 0)
    columns = {name: run.odometry[name] for name in ("t", "v_left", "v_right")}
    treads = replace(run, odometry=replace(run.odometry, columns=columns))
    assert lasting_sigma_m(treads, stamps_s, places, SCATTER_M) == USUAL * SCATTER_M
