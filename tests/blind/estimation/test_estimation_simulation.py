"""The simulation of the estimation studies against closed forms."""

import numpy as np
import pytest

from tests.studies.main_job.estimation_consistency import covariances_of, placed, squared
from tests.studies.main_job.estimation_reckoning import Path, icr_drive, position_errors_m
from tests.studies.main_job.estimation_simulation import (
    STEP_S,
    Noise,
    drive,
    frames_of,
    loop,
    run_of,
    weave,
)

ICRS = np.array([0.45, -0.40, -0.05])
VALUES = dict(zip(("y_left", "y_right", "x_icr"), ICRS, strict=True))
NOISE = Noise(position=0.01, yaw=0.01, pose_m=0.02, pose_rad=0.01, gyro=0.002)


def test_a_loop_closes_with_its_own_icrs_and_the_reckoning_follows_it():
    speeds = loop(300.0, ICRS)
    one = drive(speeds, ICRS, Noise(), np.random.default_rng(0))
    assert np.hypot(*one.states[-1, :2]) < 6.0  # the ramps cost a little of 300 m
    assert np.ptp(one.states[:, 0]) > 10.0
    path = icr_drive(run_of(one, gyroscope=False), VALUES, 0.0, np.zeros(3))
    reference = Path(one.stamps_s, one.states[:, :3])
    assert position_errors_m(path, reference).max() < 0.01


def test_a_turn_has_the_radius_that_its_icrs_prescribe():
    speeds = np.tile([0.4, 0.8], (400, 1))
    one = drive(speeds, ICRS, Noise(), np.random.default_rng(0))
    rate = 0.4 / 0.85
    centre = np.array([0.05 * -1.0, (0.8 * 0.45 + 0.4 * 0.40) / 0.85 / rate])
    distance = np.hypot(*(one.states[:, :2] - centre).T)
    np.testing.assert_allclose(distance, distance[0], atol=1e-9)


def test_noise_has_the_size_that_was_asked():
    rng = np.random.default_rng(1)
    start = [0.0, 0.0, 0.0, *ICRS, 0.01, 1.0, 1.0]
    one = drive(weave(400.0, rng), start, NOISE, rng, pose_every=1)
    assert np.std(one.poses[:, :2] - one.states[:, :2]) == pytest.approx(0.02, rel=0.05)
    true_rates = np.diff(one.states[:, 2]) / STEP_S
    off = one.yaw_rates[1:] - true_rates
    assert off.mean() == pytest.approx(0.01, abs=0.001)
    assert np.std(off) == pytest.approx(0.002 / np.sqrt(STEP_S), rel=0.05)


@pytest.mark.slow
def test_slip_grows_with_wheel_travel_alone():
    stand, ahead = np.zeros((2001, 2)), np.ones((2001, 2))
    ends = {}
    for name, speeds in (("stand", stand), ("ahead", ahead)):
        noise, rng = Noise(slip=0.1), np.random.default_rng(3)
        runs = [drive(speeds, ICRS, noise, rng).states for _ in range(30)]
        ends[name] = np.std([states[-1, 2] for states in runs])
    assert ends["stand"] == 0.0
    assert ends["ahead"] == pytest.approx(0.1 / 0.6 * np.sqrt(100), rel=0.3)


def test_slip_factors_scale_the_treads():
    speeds = np.ones((101, 2))
    one = drive(speeds, [0, 0, 0, *ICRS, 0, 0.9, 0.9], Noise(), np.random.default_rng(0))
    assert one.states[-1, 0] == pytest.approx(4.5)


def test_frames_and_run_give_the_same():
    rng = np.random.default_rng(2)
    one = drive(weave(10.0, rng), ICRS, NOISE, rng)
    told = list(run_of(one, gyroscope=True).frames())
    for frame, from_run in zip(frames_of(one, gyroscope=True), told, strict=False):
        assert frame.stamp_s == pytest.approx(from_run.stamp_s)
        np.testing.assert_array_equal(frame.tread_speeds_m_s, from_run.tread_speeds_m_s)
        assert (frame.pose is None) == (from_run.pose is None)


def test_covariances_are_read_by_the_names_of_their_columns():
    table = {f"sigma_{name}": np.array([size]) for name, size in (("x", 1), ("y", 2), ("yaw", 3))}
    assert covariances_of({}) is None
    covariance = covariances_of(table | {"covariance_x_y": np.array([0.5])})[0]
    np.testing.assert_array_equal(covariance, [[1, 0.5, 0], [0.5, 4, 0], [0, 0, 9]])
    assert squared(np.array([1.0, 2.0, 0.0]), np.diag([1.0, 4.0, 9.0])) == pytest.approx(2.0)
    assert np.isnan(squared(np.zeros(3), np.zeros((3, 3))))


def test_a_path_is_placed_without_changing_its_shape():
    path = Path(np.array([0.0, 1.0]), np.array([[1.0, 1.0, 0.5], [2.0, 1.0, 0.7]]))
    moved = placed(path, 0.0, np.array([0.0, 0.0, 0.5 + np.pi / 2]))
    np.testing.assert_allclose(moved.poses[1], [0.0, 1.0, 0.7 + np.pi / 2], atol=1e-12)
