"""Noise of poses: what the check advises, and what a run does by itself."""

import re
from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.recording import check_recording
from odometry.estimation.config import IcrEkfConfig
from odometry.preparation.pose_noise import with_pose_noise
from terrain.cli.verbs.compare import compare
from terrain.cli.verbs.identify import identify
from terrain.main_job import run_odometry
from tests.odometry.checks.drives import drive


def test_the_remedy_names_options_that_the_verbs_have():
    at_s = 0.05 * np.arange(4000)
    noisy = drive(np.full(4000, 0.7), 0.3 * np.sin(at_s / 4), sigma_m=0.5)
    (finding,) = [one for one in check_recording(noisy).findings if one.name == "noisy_positions"]
    of_fits = re.findall(r"--[a-z-]+", finding.remedy)
    assert of_fits == ["--position-sigma", "--horizon"]
    for verb in (identify, compare):
        assert set(of_fits) <= {name for parameter in verb.params for name in parameter.opts}
        assert verb.name in finding.remedy


def test_a_run_takes_the_noise_that_the_recording_shows():
    at_s = 0.05 * np.arange(4000)
    noisy = drive(np.full(4000, 0.7), 0.3 * np.sin(at_s / 4), sigma_m=0.5)
    result = run_odometry(noisy, vision=False)
    assert result.config.filter.position_sigma_m == pytest.approx(0.5, rel=0.1)
    (event,) = [event for event in result.replay.events if event.kind == "noisy_positions"]
    assert "in place of 0.05 m" in event.text
    assert "the sigmas of x and y hold 0.5 m of them" in event.text


@pytest.mark.parametrize(
    "settings", [{"position_sigma_m": 2.0}, {"causal": True}, {"watch_sensors": False}]
)
def test_more_noise_that_is_stated_and_a_filter_that_does_not_look_stay_as_they_are(settings):
    noisy = drive(np.full(900, 0.7), np.full(900, 0.05), sigma_m=0.5)
    config = IcrEkfConfig(**settings)
    assert with_pose_noise(noisy, config) == (config, ())


def test_smooth_positions_keep_the_usual_noise():
    smooth = drive(np.full(900, 0.7), np.full(900, 0.05), sigma_m=0.05)
    assert with_pose_noise(smooth, IcrEkfConfig()) == (IcrEkfConfig(), ())


def test_poses_interpolated_from_one_count_as_one():
    at_s = 0.05 * np.arange(4000)
    every = drive(np.full(4000, 0.7), 0.3 * np.sin(at_s / 4), sigma_m=0.01)
    t, fixes = every.pose.stamps_s, slice(None, None, 20)
    columns = {name: np.interp(t, t[fixes], every.pose[name][fixes]) for name in ("x", "y", "yaw")}
    lines = replace(every, pose=replace(every.pose, columns={"t": t, **columns}))
    taken, (event,) = with_pose_noise(lines, IcrEkfConfig())
    assert taken.position_sigma_m == pytest.approx(0.05 * np.sqrt(20), rel=0.03)
    assert taken.yaw_sigma_rad == pytest.approx(0.05 * np.sqrt(20), rel=0.03)
    assert event.kind == "interpolated_poses"
    assert "20 poses" in event.text
