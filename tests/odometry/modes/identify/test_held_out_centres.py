"""Errors of turning centres on drives that are held out."""

from dataclasses import replace

import pytest

from odometry.modes.identify.held_out_centres import LEAST_NOISE, centre_errors
from odometry.modes.identify.identify_traction import identify_traction_modes
from tests.odometry.modes.checks.centre_examples import centre_run, centre_set


def runs_of(*centres_m, **errors):
    """Two runs of 60 s of each mode, about points ahead that are given."""
    named = [
        (name, of) for name, both in zip(("none", "all"), centres_m, strict=True) for of in both
    ]
    runs = [
        centre_run(of, lasts_s=60.0, seed=20 + place, folder=f"{place}", **errors)
        for place, (_, of) in enumerate(named)
    ]
    settings = [{"run": {"terrain": name}} for name, _ in named]
    return [replace(run, settings=of) for run, of in zip(runs, settings, strict=True)]


@pytest.mark.parametrize("errors", [{}, {"late_s": 0.5}, {"lag_s": 0.3}])
def test_drives_that_turn_about_one_point_leave_little(errors):
    spread, noise = centre_errors(centre_set().modes, runs_of((0.0, 0.0), (0.0, 0.0), **errors))
    assert spread.shape == (2, 2)
    assert spread.max() < 0.015
    assert (noise >= LEAST_NOISE).all()


def test_a_mode_whose_drives_turn_about_other_points_is_off_by_them():
    spread, _ = centre_errors(centre_set().modes, runs_of((-0.05, 0.05), (0.0, 0.0)))
    # 10 cm where one drive predicts the other, 5 where both do
    assert spread[0, 1] == pytest.approx(0.084, rel=0.15)
    assert spread[0, 0] < 0.02


def test_one_drive_of_a_mode_and_poses_far_apart_determine_nothing():
    runs = runs_of((0.0, 0.0), (0.0, 0.0))
    assert centre_errors(centre_set().modes, runs[:3]) is None
    runs = runs_of((0.0, 0.0), (0.0, 0.0), pose_rows=100)
    assert centre_errors(centre_set().modes, runs) is None


@pytest.mark.slow
def test_identified_modes_state_it():
    runs = runs_of((0.0, 0.0), (0.1, 0.1))
    assert identify_traction_modes(runs).centre_spread.max() < 0.02
    assert identify_traction_modes(runs, paper=True).centre_spread is None
