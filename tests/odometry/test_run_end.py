"""What is said of a filter at the end of its run."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.estimation.transition import GYRO_BIAS
from odometry.pipeline import ConstantTerrain, replay
from odometry.run_end import bias_error
from tests.odometry.test_pose_delay import run_of, table


def kinds(run, **settings):
    ekf = IcrEkf(run.robot.track_width, config=IcrEkfConfig(**settings))
    events = replay(run, ekf, ConstantTerrain("a")).events
    return {event.kind: event for event in events}


def posed(run, **columns):
    return replace(run, pose=table("pose.csv", **{**run.pose.columns, **columns}))


def test_a_clean_run_has_nothing_to_say():
    assert kinds(run_of(0.0)) == {}


def test_a_bias_is_said_and_a_drift():
    run = run_of(0.0)
    columns = dict(run.odometry.columns)
    t, rates = columns["t"], columns["gyro_z"]

    def with_rates(added):
        return replace(run, odometry=table("odometry.csv", **{**columns, "gyro_z": rates + added}))

    found = kinds(with_rates(0.016))
    assert set(found) == {"gyroscope_bias"}
    assert "bias of 0.01" in found["gyroscope_bias"].text
    lost = kinds(with_rates(0.06 * t / t[-1]))["gyroscope_drift"]
    assert "not followed" in lost.text


def test_the_error_of_a_bias_is_found_from_the_poses():
    """A drift that the filter lags behind, against the bias that was put in."""
    run = run_of(0.0)
    columns = dict(run.odometry.columns)
    t = columns["t"]
    rates = columns["gyro_z"] + 0.06 * t / t[-1]
    drifting = replace(run, odometry=table("odometry.csv", **{**columns, "gyro_z": rates}))
    ekf = IcrEkf(run.robot.track_width, config=IcrEkfConfig(watch_sensors=False))
    done = replay(drifting, ekf, ConstantTerrain("a"))
    truth = 0.06 * done.stamps_s / t[-1]
    error = truth - done.means[:, GYRO_BIAS]
    assert bias_error(done, 200) == pytest.approx(error[200:].mean(), abs=0.002)
    assert error[200:].mean() > 0.01


def test_a_drift_that_the_filter_follows_is_a_note():
    run = run_of(0.0)
    columns = dict(run.odometry.columns)
    t = columns["t"]
    rates = columns["gyro_z"] + 0.06 * t / t[-1]
    drifting = replace(run, odometry=table("odometry.csv", **{**columns, "gyro_z": rates}))
    found = kinds(drifting, bias_noise=1e-3, gyro_noise=0.005)
    assert "followed it" in found["gyroscope_drift_followed"].text
    assert "gyroscope_drift" not in found


def test_outliers_are_counted(rng):
    run = run_of(0.0)
    chosen = (rng.random(len(run.pose)) < 0.2) & (run.pose.stamps_s > 0)  # not where it starts
    x = run.pose["x"] + chosen * rng.uniform(-5, 5, len(run.pose))
    found = kinds(posed(run, x=x))
    assert set(found) == {"refused_poses"}


def test_an_outage_that_lasts_to_the_end_is_said():
    run = run_of(0.0)
    found = kinds(replace(run, pose=run.pose.rows(slice(0, 600))))
    assert set(found) == {"pose_outage"}
    assert found["pose_outage"].end_s == pytest.approx(120.0, abs=0.2)


def test_a_heading_that_was_never_found_is_said():
    run = run_of(0.0)
    standing = {**run.odometry.columns, "v_left": 0 * run.odometry["t"]}
    standing["v_right"], standing["gyro_z"] = standing["v_left"], standing["v_left"]
    rng = np.random.default_rng(3)
    x, y = rng.normal(0, 0.02, (2, len(run.pose)))
    still = posed(run, x=x, y=y, yaw=np.full(len(x), np.nan))
    found = kinds(replace(still, odometry=table("odometry.csv", **standing)))
    assert "heading_unknown" in found
    assert "cannot be determined" in found["heading_unknown"].text


def test_an_estimate_that_ends_worse_than_the_ideal_drive_says_so():
    """A filter that refuses all poses, on a wrong width that it never learns to be wrong."""
    run = run_of(0.0)
    columns = {**run.odometry.columns, "gyro_z": run.odometry["gyro_z"] + 0.1}
    biased = replace(run, odometry=table("odometry.csv", **columns))
    found = kinds(
        biased, gate_probability=1e-9, gate_patience=10**6, bias_sigma_rad_s=0.0, bias_noise=0.0
    )
    assert "off_at_end" in found
    assert "do not trust" in found["off_at_end"].text
