from dataclasses import replace

import numpy as np
import pytest

from odometry.gap.errors import GapError
from odometry.identification.errors import IdentificationError
from odometry.modes.identify_traction import identify_traction_modes
from odometry.modes.yaw_rate_noise import NOT_MEASURED
from tests.odometry.modes.mode_drives import ROBOT, run_of_tables, traction_run

GAINS = {
    "left": np.array(
        [[[0.95, 0.03], [-0.05, 0.04], [0.10, 0.60]], [[0.90, -0.02], [0.06, 0.02], [-0.15, 0.50]]]
    ),
    "none": np.array(
        [[[1.00, 0.00], [0.00, 0.05], [0.00, 0.70]], [[1.00, 0.00], [0.00, 0.05], [0.00, 0.70]]]
    ),
}
PAPER = {"left": np.array([0.90, 0.55]), "none": np.array([0.98, 0.70])}
LAGS_S = {"left": 0.2, "none": 0.08}


def drive(seed, name, **settings):
    rng = np.random.default_rng(seed)
    return traction_run(rng, GAINS[name], LAGS_S[name], terrain=name, **settings)


def drive_by_eq_3(seed, name, **settings):
    """The same gains to both sides, next to no lag."""
    k, m = PAPER[name]
    gains = np.tile([[k, 0.0], [0.0, 0.0], [0.0, m]], (2, 1, 1))
    return traction_run(np.random.default_rng(seed), gains, 0.01, terrain=name, **settings)


@pytest.fixture(scope="module")
def modes():
    return identify_traction_modes([drive(1, "none"), drive(2, "left"), drive(3, "left")])


def test_gains_of_both_turns_and_the_cross_gains_are_found(modes):
    """Poses of 1 cm over windows of 0.6 m/s x 2 s, a good dozen in each turn, err by 0.01 / 1.2
    / sqrt(12) = 0.0024 times two poses; 0.02 is six times that, as gains share the windows."""
    assert modes.names == ("left", "none")
    assert modes.track_width == ROBOT.track_width
    expected = np.stack([GAINS[name] for name in modes.names])
    np.testing.assert_allclose(modes.gains, expected, atol=0.02)
    assert np.abs(expected[0, 0] - expected[0, 1]).max() > 0.2  # so that turns are not mistaken


def test_lags_are_found(modes):
    np.testing.assert_allclose(modes.lag_s, [LAGS_S[name] for name in modes.names], atol=0.02)


@pytest.mark.parametrize(("step_s", "size"), [(0.05, 2400), (0.02, 3000)])
def test_the_lag_does_not_depend_on_how_often_wheels_are_read(step_s, size):
    found = identify_traction_modes([drive(4, "left", step_s=step_s, size=size)])
    assert found.lag_s[0] == pytest.approx(LAGS_S["left"], abs=0.0125)  # half the shift of a step


def test_noise_of_poses_and_gyroscope_is_found(modes):
    sigmas = np.sqrt(modes.measurement_variance)
    np.testing.assert_allclose(sigmas[:3], [0.01, 0.01, 0.005], rtol=0.15)
    assert 0.018 < sigmas[3] < 0.06  # 0.02, and what gains that err a little leave for long
    assert np.all(np.sqrt(modes.process_variance) < 0.01)  # nothing wanders


def test_wandering_is_found():
    """Places and yaws that walk at random, by 0.04 m and 0.03 rad a root of a metre of travel."""
    run, rng = drive(2, "left", size=6000), np.random.default_rng(9)
    step_m = np.diff(run.wheel_travel_m[::5], prepend=0.0)
    walked = np.cumsum(np.sqrt(step_m)[:, None] * rng.normal(size=(len(step_m), 3)), axis=0)
    moved = zip(("x", "y", "yaw"), (walked * [0.04, 0.04, 0.03]).T, strict=True)
    columns = {**run.pose.columns, **{name: run.pose[name] + by for name, by in moved}}
    found = identify_traction_modes([replace(run, pose=replace(run.pose, columns=columns))])
    np.testing.assert_allclose(np.sqrt(found.process_variance), [0.04, 0.03], rtol=0.25)


def test_without_a_gyroscope_its_noise_says_next_to_nothing():
    run = drive(2, "left")
    columns = {name: c for name, c in run.odometry.columns.items() if name != "gyro_z"}
    found = identify_traction_modes([replace(run, odometry=replace(run.odometry, columns=columns))])
    assert found.measurement_variance[3] == NOT_MEASURED
    np.testing.assert_allclose(found.gains[0], GAINS["left"], atol=0.03)


def test_k_and_m_of_the_paper():
    runs = [drive_by_eq_3(seed, name) for seed, name in ((5, "none"), (6, "left"))]
    found = identify_traction_modes(runs, paper=True)
    for place, name in enumerate(found.names):
        np.testing.assert_array_equal(found.gains[place, 0], found.gains[place, 1])
        np.testing.assert_array_equal(found.gains[place][:, [0, 1, 1, 2], [1, 0, 1, 0]], 0.0)
        k_and_m = found.k[place, 0], found.m[place, 0]
        np.testing.assert_allclose(k_and_m, PAPER[name], atol=0.02)
    np.testing.assert_array_equal(found.lag_s, 0.0)


def test_modes_may_change_within_a_run():
    """Windows that straddle the change belong to neither."""
    run, other = drive(1, "none"), drive(2, "left")
    shift_s = run.odometry.stamps_s[-1] + 0.02
    joined = {
        name: np.concatenate([run.odometry[name], other.odometry[name] + shift_s * (name == "t")])
        for name in run.odometry.columns
    }
    joined["terrain"] = np.repeat(np.array(["none", "left"], dtype=object), len(run.odometry))
    pose = {
        name: np.concatenate([run.pose[name], other.pose[name] + shift_s * (name == "t")])
        for name in run.pose.columns
    }
    found = identify_traction_modes([run_of_tables(joined, pose=pose)])
    expected = np.stack([GAINS[name] for name in found.names])
    np.testing.assert_allclose(found.gains, expected, atol=0.03)


def test_a_run_that_names_no_mode_is_told_by_folder():
    run = replace(drive(1, "none", size=600, folder="run_3"), settings={})
    with pytest.raises(IdentificationError, match="run_3: names no mode"):
        identify_traction_modes([run])


def test_too_few_windows():
    """8 s, less the ends: three windows of 2 s."""
    with pytest.raises(IdentificationError, match="none: 3 windows of 2 s, expected 5"):
        identify_traction_modes([drive(1, "none", size=400)])
    with pytest.raises(GapError, match="drive: no window of 2 s"):
        identify_traction_modes([drive(1, "none", size=100)])


def test_turns_to_one_side_do_not_tell_all_gains():
    """Straight ahead and always to the left; the paper's gains are told all the same."""
    run = drive_by_eq_3(1, "none", turn_m_s=0.0)
    with pytest.raises(IdentificationError, match="0 windows of 2 s in left turns and 0 in right"):
        identify_traction_modes([run])
    to_left = replace(run, odometry=replace(run.odometry, columns=_to_left(run)))
    with pytest.raises(IdentificationError, match=r"none: \d\d windows .* left turns and 0 in"):
        identify_traction_modes([to_left])
    found = identify_traction_modes([run], paper=True)
    assert found.k[0, 0] == pytest.approx(PAPER["none"][0], abs=0.01)


def _to_left(run):
    return {**run.odometry.columns, "v_right": run.odometry["v_right"] + 0.2}
