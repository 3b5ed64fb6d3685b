"""Drifts in one direction of the world: innovations of places are drawn here."""

from dataclasses import replace

import numpy as np

from odometry.modes.checks.place_drift import PART_S, PARTS, place_drifts
from odometry.modes.follow.track import follow_modes
from odometry.modes.models.innovation_test import Innovations
from tests.odometry.modes.mode_examples import run_of, traction_set

STEP_S, SIZE = 0.1, 400
STAMPS_S = STEP_S * np.arange(SIZE)
NEEDED_S = PART_S * PARTS
DRIFT = np.array([0.4, -0.3])  # of a deviation: 5 of them in all that is needed


def found(places):
    """Of innovations (N, 2) of the leading one of two modes."""
    left = np.column_stack([places, np.zeros((SIZE, 2))])
    both = np.stack([left, left + 50.0], axis=1)
    return place_drifts(Innovations(both, np.zeros(SIZE, dtype=int), STAMPS_S, 1.0))


def white(seed=3):
    return np.random.default_rng(seed).normal(size=(SIZE, 2))


def turned(size, period_s):
    """Innovations of a robot that goes round, of the same size ahead."""
    angle = 2 * np.pi * STAMPS_S / period_s
    return size * np.column_stack([np.cos(angle), np.sin(angle)])


def test_a_drift_shows_where_all_parts_are_known():
    places = white() + DRIFT
    off = found(places)
    assert off[STAMPS_S > NEEDED_S].mean() > 0.9
    assert not off[STAMPS_S < NEEDED_S - PART_S].any()
    places[(STAMPS_S > 20.0) & (STAMPS_S < 20.0 + 2 * PART_S)] = np.nan
    assert not found(places)[(STAMPS_S > 20.0 + 2 * PART_S) & (STAMPS_S < 20.0 + NEEDED_S)].any()


def test_noise_is_no_drift():
    assert np.mean([found(white(seed)).mean() for seed in range(40)]) < 0.02


def test_what_turns_with_the_robot_is_no_drift():
    assert not found(white() + turned(1.0, NEEDED_S)).any()


def test_innovations_that_last_for_a_part_are_no_drift_however_large():
    size = round(PART_S / STEP_S)
    held = [np.repeat(white(seed)[::size], size, axis=0) for seed in range(20)]
    assert np.mean([found(one).mean() for one in held]) < 0.15


def test_a_robot_that_slides_is_followed_so():
    run = run_of(0.5, track_width=0.5, size=1500)
    columns = dict(run.pose.columns)
    slides = {**columns, "x": columns["x"] + 0.03 * columns["t"]}
    level, slope = (
        follow_modes(replace(run, pose=replace(run.pose, columns=of)), traction_set())
        for of in (columns, slides)
    )
    late = slope.stamps_s > 1.5 * NEEDED_S
    assert slope.drifts[late].mean() > 0.5
    assert not level.drifts.any()
