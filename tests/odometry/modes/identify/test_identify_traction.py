from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import IdentificationError, WindowError
from odometry.modes.identify.identify_traction import fitted, identify_traction_modes
from odometry.modes.identify.mode_windows import MOST_POSES, scenes_by_mode, yaw_rates_by_mode
from odometry.modes.models.yaw_rate_noise import LASTING_S, NOT_MEASURED, YawRateNoise
from odometry.windows.dense.dense_noise import Noise
from tests.odometry.modes.mode_drives import (
    ROBOT,
    asked_twists,
    gains_of,
    run_of_tables,
    traction_run,
)

NONE = np.zeros((3, 3))
LEFT = [[0.05, -0.1, 0.15], [0.0, 0.05, 0.05], [0.0, -0.1, 0.0]]
RIGHT = [[-0.1, 0.1, -0.1], [-0.05, -0.02, -0.05], [0.0, -0.1, 0.05]]
GAINS = {
    "left": gains_of([[0.95, -0.05, 0.10], [0.0, 0.04, 0.55]], LEFT, RIGHT),
    "none": gains_of([[1.00, 0.00, 0.00], [0.0, 0.05, 0.70]], NONE, NONE),
}
PAPER = {"left": np.array([0.90, 0.55]), "none": np.array([0.98, 0.70])}
LAGS_S = {"left": 0.2, "none": 0.08}


def drive(seed, name, **settings):
    rng = np.random.default_rng(seed)
    return traction_run(rng, GAINS[name], LAGS_S[name], terrain=name, **settings)


def drive_by_eq_3(seed, name, **settings):
    """The same gains to both sides, next to no lag."""
    k, m = PAPER[name]
    gains = gains_of([[k, 0.0, 0.0], [0.0, 0.0, m]], NONE, NONE)
    return traction_run(np.random.default_rng(seed), gains, 0.01, terrain=name, **settings)


@pytest.fixture(scope="module")
def modes():
    return identify_traction_modes([drive(1, "none"), drive(2, "left"), drive(3, "left")])


def off(gains, name, run):
    """Twists (N, 3) of found gains less the true ones, at the treads of a run."""
    treads = run.odometry.stack("v_left", "v_right")
    found = asked_twists(gains, treads, ROBOT.track_width)
    return found - asked_twists(GAINS[name], treads, ROBOT.track_width)


@pytest.mark.slow
def test_twists_of_both_turns_are_found(modes):
    """Gains alone go together where turns are of one tightness. Forty poses of 1 cm over 4 s give
    a speed to 0.01 sqrt(12 / 40) / 4 = 0.0014 m/s, ten such windows of each turn to 0.0004; four
    gains share them."""
    assert modes.names == ("left", "none")
    assert modes.track_width == ROBOT.track_width
    for name, gains in zip(modes.names, modes.gains, strict=True):
        errors = off(gains, name, drive(9, name))
        assert np.abs(errors).max() < 0.012
        assert np.sqrt((errors**2).mean(axis=0)).max() < 0.003
        np.testing.assert_array_equal(gains[0, :, :2], gains[1, :, :2])
    apart = off(GAINS["none"], "left", drive(9, "left"))
    assert np.sqrt((apart**2).mean(axis=0)).min() > 0.02  # so that modes are not mistaken


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


@pytest.mark.slow
def test_wandering_is_found():
    """Places and yaws that walk at random, by 0.04 m and 0.03 rad a root of a metre of travel.

    Taken as an error that lasts longer than a window; and gains are the less exact.
    """
    run, rng = drive(2, "left", size=10_000), np.random.default_rng(9)
    step_m = np.diff(run.wheel_travel_m[::5], prepend=0.0)
    walked = np.cumsum(np.sqrt(step_m)[:, None] * rng.normal(size=(len(step_m), 3)), axis=0)
    moved = zip(("x", "y", "yaw"), (walked * [0.04, 0.04, 0.03]).T, strict=True)
    columns = {**run.pose.columns, **{name: run.pose[name] + by for name, by in moved}}
    found = identify_traction_modes([replace(run, pose=replace(run.pose, columns=columns))])
    walked_m, walked_rad = np.sqrt(found.process_variance[:2] * 4.0 / LASTING_S)
    assert 0.036 < walked_m < 0.055
    assert 0.027 < walked_rad < 0.04


@pytest.mark.slow
def test_what_gains_leave_open_is_as_large_as_their_errors():
    """Errors of twists over their variances: 1 on average over seeds, up to a factor."""
    ratios = []
    for seed in range(6):
        run = drive(seed, "left", size=2000)
        (scene,), measured = scenes_by_mode([run])[1]["left"], yaw_rates_by_mode([run])["left"]
        fit = fitted([scene], measured, Noise(0.01, 0.005, 1e-4, 1e-5), YawRateNoise(0.02**2))
        squares = off(fit.gains, "left", run) ** 2
        treads = replace(scene.inputs, tread_speeds_m_s=run.odometry.stack("v_left", "v_right"))
        variances = fit.twist_variances(replace(scene, inputs=treads))
        ratios.append((squares / variances).mean(axis=0))
    assert np.all(np.abs(np.log(np.mean(ratios, axis=0))) < np.log(2.5))


@pytest.mark.slow
def test_a_gyroscope_gives_turns_better_than_poses_do():
    """Poses of 0.5 m and 0.4 rad; a gyroscope of 0.02 rad/s."""
    run, rng = drive(2, "left", size=6000), np.random.default_rng(8)
    noisy = {
        name: run.pose[name] + sigma * rng.normal(size=len(run.pose))
        for name, sigma in (("x", 0.5), ("y", 0.5), ("yaw", 0.4))
    }
    run = replace(run, pose=replace(run.pose, columns=run.pose.columns | noisy))
    measured = identify_traction_modes([run]).gains[0]
    columns = {name: c for name, c in run.odometry.columns.items() if name != "gyro_z"}
    poses_alone = replace(run, odometry=replace(run.odometry, columns=columns))
    by_poses = identify_traction_modes([poses_alone]).gains[0]
    with_gyroscope, without = (
        np.sqrt((off(of, "left", run)[:, 2] ** 2).mean()) for of in (measured, by_poses)
    )
    assert with_gyroscope < 0.004
    assert without > 0.03


def test_errors_that_come_with_acceleration_are_found():
    """A second in four the treads are rough, and the yaw rate is off by 0.2 rad/s."""
    run = drive(2, "left", size=3000)
    rough = (run.odometry.stamps_s % 4) < 1
    shaken = {
        name: run.odometry[name] + 0.4 * rough * np.sin(40 * run.odometry.stamps_s)
        for name in ("v_left", "v_right")
    }
    shaken["gyro_z"] = run.odometry["gyro_z"] + 0.2 * rough
    run = replace(run, odometry=replace(run.odometry, columns=run.odometry.columns | shaken))
    calm = identify_traction_modes([drive(2, "left", size=3000)])
    assert identify_traction_modes([run]).variance_growth > 100 * (1 + calm.variance_growth)


@pytest.mark.slow
def test_what_short_runs_leave_open_is_noise():
    """With five times the driving gains are known five times better; nothing wanders."""
    short, long = (
        identify_traction_modes([drive(2, "left", size=size)]).process_variance
        for size in (2000, 10_000)
    )
    assert np.all(long[:2] < short[:2] / 2.5)


def test_turns_that_no_window_holds_do_not_count():
    """Poses are lost while it turns to the right."""
    run = drive(1, "none", size=6000)
    late = run.odometry["v_right"] - run.odometry["v_left"]
    to_right = np.interp(run.pose.stamps_s, run.odometry.stamps_s, late) < 0
    columns = {
        name: np.where(to_right & (name != "t"), np.nan, c) for name, c in run.pose.columns.items()
    }
    with pytest.raises((IdentificationError, WindowError)):
        identify_traction_modes([replace(run, pose=replace(run.pose, columns=columns))])


def test_a_robot_that_stands_determines_nothing():
    run = drive_by_eq_3(1, "none")
    still = {name: np.zeros(len(run.odometry)) for name in ("v_left", "v_right", "gyro_z")}
    run = replace(run, odometry=replace(run.odometry, columns=run.odometry.columns | still))
    with pytest.raises(IdentificationError, match=r"none: 0\.0 s of driving in windows"):
        identify_traction_modes([run], paper=True)


def test_many_poses_a_window_are_thinned():
    run = drive(2, "left", size=2000)
    dense_s = np.arange(0.0, 39.9, 0.01)
    columns = {
        name: np.interp(dense_s, run.pose.stamps_s, run.pose[name]) for name in ("x", "y", "yaw")
    }
    dense = replace(run.pose, columns={"t": dense_s, **columns}, lines=np.arange(len(dense_s)) + 2)
    _, scenes = scenes_by_mode([replace(run, pose=dense)])
    (scene,) = scenes["left"]
    assert scene.windows.shape[1] == MOST_POSES + 1
    spans_s = np.ptp(scene.pose_s[scene.windows], axis=1)
    np.testing.assert_allclose(spans_s, 4.0, atol=0.05)


def test_without_a_gyroscope_its_noise_says_next_to_nothing():
    run = drive(2, "left")
    columns = {name: c for name, c in run.odometry.columns.items() if name != "gyro_z"}
    found = identify_traction_modes([replace(run, odometry=replace(run.odometry, columns=columns))])
    assert found.measurement_variance[3] == NOT_MEASURED
    assert np.sqrt((off(found.gains[0], "left", run) ** 2).mean(axis=0)).max() < 0.006


def test_k_and_m_of_the_paper():
    runs = [drive_by_eq_3(seed, name) for seed, name in ((5, "none"), (6, "left"))]
    found = identify_traction_modes(runs, paper=True)
    for place, name in enumerate(found.names):
        np.testing.assert_array_equal(found.gains[place, 0], found.gains[place, 1])
        assert np.count_nonzero(found.gains[place, 0]) == 2
        k_and_m = found.k[place, 0], found.m[place, 0]
        np.testing.assert_allclose(k_and_m, PAPER[name], atol=0.02)
    np.testing.assert_array_equal(found.lag_s, 0.0)


@pytest.mark.slow
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
    for name, gains in zip(found.names, found.gains, strict=True):
        assert np.sqrt((off(gains, name, run) ** 2).mean(axis=0)).max() < 0.006


def test_a_run_that_names_no_mode_is_reported_by_folder():
    run = replace(drive(1, "none", size=600, folder="run_3"), settings={})
    with pytest.raises(IdentificationError, match="run_3: names no mode"):
        identify_traction_modes([run])


def test_too_short_a_run():
    """10 s, less the ends: two windows of 4 s. 5 s: two of 2 s. 2 s: none."""
    for size, lasts in ((500, r"8\.\d"), (250, r"3\.\d")):
        with pytest.raises(IdentificationError, match=f"none: {lasts} s of driving .* 10 s"):
            identify_traction_modes([drive(1, "none", size=size)])
    with pytest.raises(WindowError, match="drive: no window of 2 s"):
        identify_traction_modes([drive(1, "none", size=100)])


def test_poses_that_are_chained_for_two_seconds_alone():
    """As a lidar's that are matched from window to window: each starts anew."""
    run = drive(2, "left", size=6000)
    window = np.floor(run.pose.stamps_s / 2.0)
    columns = run.pose.columns | {"window": window, "x": run.pose["x"] + 0.5 * (window % 2)}
    chained = replace(run, pose=replace(run.pose, columns=columns))
    horizon_s, scenes = scenes_by_mode([chained])
    assert (horizon_s, list(scenes)) == (2.0, ["left"])
    found = identify_traction_modes([chained])
    assert np.sqrt((off(found.gains[0], "left", run) ** 2).mean(axis=0)).max() < 0.006


def test_turns_to_one_side_do_not_determine_all_gains():
    """Straight ahead and always to the left; the paper's gains are identified all the same."""
    run = drive_by_eq_3(1, "none", turn_m_s=0.0)
    with pytest.raises(IdentificationError, match=r"none: 0.0 s of left turns and 0.0 s of r"):
        identify_traction_modes([run])
    to_left = replace(run, odometry=replace(run.odometry, columns=_to_left(run)))
    with pytest.raises(IdentificationError, match=r"none: \d\d\.\d s of left turns and 0.0 s"):
        identify_traction_modes([to_left])
    found = identify_traction_modes([run], paper=True)
    assert found.k[0, 0] == pytest.approx(PAPER["none"][0], abs=0.01)


def _to_left(run):
    return {**run.odometry.columns, "v_right": run.odometry["v_right"] + 0.2}


def test_positions_without_yaw_are_said_to_lack_it():
    run = drive_by_eq_3(1, "none")
    columns = run.pose.columns | {"yaw": np.full(len(run.pose), np.nan)}
    with pytest.raises(IdentificationError, match="no pose with yaw"):
        identify_traction_modes([replace(run, pose=replace(run.pose, columns=columns))])
