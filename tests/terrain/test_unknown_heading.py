"""Positions without yaw of a robot whose heading is not known well: they teach no slip."""

from pathlib import Path

import numpy as np
import pytest

from odometry.recording.run import Run
from terrain.main_job import run_odometry
from tests.blind.any_robot import write_clean_run
from tests.studies.main_job.estimation_steps import PARAMETERS


@pytest.mark.parametrize(
    ("seed", "was_learned"),
    [
        (570, "slip factors of 0.6 and 0.4 of the width"),
        (677, "0.33 of the width, eight deviations off"),
        (792, "a turning centre 4.5 deviations ahead, and 0.9 of the time a wrong yaw"),
    ],
)
def test_pivots_beside_a_receiver_teach_no_slip(tmp_path, seed, was_learned):
    robot = write_clean_run(tmp_path / "run", seed)
    replay = run_odometry(Run.read(tmp_path / "run"), vision=False).replay
    for name, at in PARAMETERS.items():
        off = (replay.means[-1, at] - robot.truth[name]) / replay.sigmas[-1, at]
        assert abs(off) < 2.5, f"{name} is {off:.1f} deviations off; it had {was_learned}"
    assert np.all(replay.means[-1, 7:9] > 0.8)


def test_errors_that_last_are_held_by_the_covariance_alone(tmp_path):
    robot = write_clean_run(tmp_path / "run", 112)
    assert robot.source == "gnss"
    run = Run.read(Path(tmp_path) / "run")
    as_shown = run_odometry(run, vision=False)
    settings = as_shown.config.filter
    assert settings.lasting_sigma_m > 0.2 * settings.position_sigma_m
    truth = np.genfromtxt(tmp_path / "run" / "truth.csv", delimiter=",", names=True)
    replay = as_shown.replay
    true = [np.interp(replay.stamps_s, truth["t"], truth[axis]) for axis in ("x", "y")]
    apart = np.hypot(*(replay.means[:, :2] - np.stack(true, axis=-1)).T)
    claimed = np.hypot(*replay.sigmas[:, :2].T)
    assert np.mean(apart > 3 * claimed) < 0.02
    without = np.sqrt(replay.sigmas[:, :2] ** 2 - settings.lasting_sigma_m**2)
    assert np.mean(apart > 3 * np.hypot(*without.T)) > 0.2
