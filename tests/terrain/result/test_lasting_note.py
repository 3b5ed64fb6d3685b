"""Runs that do not show whether the errors of their positions last."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.preparation.pose_noise import with_pose_noise
from terrain.main_job import run_odometry
from terrain.result.lasting_note import lasting_note
from terrain.result.run_notes import run_notes
from tests.odometry.checks.drives import winding
from tests.odometry.preparation.test_wander_at_rest import stopping, wandering, without_yaw


def result(run, events=(), **settings):
    config = SimpleNamespace(filter=IcrEkfConfig(**settings))
    return SimpleNamespace(run=run, config=config, replay=SimpleNamespace(events=events))


def test_a_receiver_beside_a_robot_that_never_stops_is_said():
    (note,) = lasting_note(result(without_yaw(winding())))
    assert "cannot be determined: it takes three stops" in note


@pytest.mark.parametrize(
    "run",
    [winding(), replace(winding(), pose=None), stopping()],
    ids=["yaw is measured", "no poses", "stops"],
)
def test_others_are_not(run):
    assert lasting_note(result(run)) == []


def test_errors_that_are_held_or_stated_are_not_said_again():
    run = wandering(stopping(), 0.5, 0)
    assert lasting_note(result(run, with_pose_noise(run, IcrEkfConfig())[1])) == []
    run = without_yaw(winding())
    noisy = FilterEvent("noisy_positions", 0.0, 1.0, "positions scatter", (0.5,))
    assert lasting_note(result(run, (noisy,))) == []
    assert lasting_note(result(run, lasting_sigma_m=1.0)) == []


def test_the_command_says_it():
    notes = run_notes(run_odometry(without_yaw(winding(600)), vision=False))
    assert any("three stops" in note for note in notes)
