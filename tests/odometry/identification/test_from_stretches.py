"""Fits to positions without yaw that are refused, and the simpler model given instead."""

from dataclasses import replace

import pytest

from odometry.errors import IdentificationError
from odometry.identification.identification import contradicted, undetermined_by_positions
from odometry.identification.identify import identify, simpler_model
from odometry.identification.start import SolverConfig
from tests.odometry.positions_drives import ICR, ROBOT, drive, emptied


def found(run, model="icr"):
    return identify([run], model, solver_config=SolverConfig(starts=1))


def only(identification):
    (ground,) = identification.terrains.values()
    return ground


@pytest.fixture(scope="module")
def noisy():
    """1 m of noise over 80 m: widths to 0.1 m, and x_icr to 0.3 m."""
    return found(emptied(drive(14, noise_m=1.0, duration_s=120.0)))


def test_an_interval_wider_than_the_parameter_is_large_is_refused(noisy):
    with pytest.raises(IdentificationError, match=r"x_icr: 95 % interval -0\.0"):
        noisy.require_determined()
    assert len(noisy.left_open) == 1
    assert noisy.unexplained == ()


def test_two_factors_are_given_instead_and_hold_the_truth(noisy):
    simpler = simpler_model(noisy)
    intervals = only(simpler).fit.intervals
    assert intervals["b_hat"].low < ICR["y_left"] - ICR["y_right"] < intervals["b_hat"].high
    assert intervals["alpha"].low < (ICR["alpha_left"] + ICR["alpha_right"]) / 2
    assert intervals["alpha"].high > (ICR["alpha_left"] + ICR["alpha_right"]) / 2


def test_a_simpler_model_that_is_not_determined_either_is_not_offered():
    straight = found(emptied(drive(8, most_turn=0.0, noise_m=0.02)))
    assert straight.left_open
    assert simpler_model(straight) is None
    assert simpler_model(found(emptied(drive(8, most_turn=0.0)), "icr_symmetric")) is None


def test_few_stretches_show_no_spread():
    short = found(emptied(drive(14, noise_m=0.02, duration_s=9.0)))
    assert any("do not show the errors of the model" in words for words in short.left_open)
    longer = found(emptied(drive(14, noise_m=0.02, duration_s=25.0)))
    assert longer.left_open == ()


def test_values_that_the_ideal_drive_beats_are_refused():
    """The ideal drive is one of the motions that the fit could have chosen."""
    ground = only(found(emptied(drive(15, noise_m=0.02)), "icr_symmetric"))
    assert contradicted(ground.fit, ground.ideal) == ()
    off = replace(ground.fit, values={"alpha": 1.5, "b_hat": 0.4})
    (words,) = contradicted(off, ground.ideal)
    assert words.startswith("the ideal differential drive has smaller errors")


def test_fits_to_poses_are_judged_by_their_stated_noise():
    ground = only(found(drive(14), "icr_symmetric"))
    off = replace(ground.fit, values={"alpha": 1.5, "b_hat": 0.4})
    assert contradicted(off, ground.ideal) == ()
    assert undetermined_by_positions(ground.fit, ROBOT) == ()
