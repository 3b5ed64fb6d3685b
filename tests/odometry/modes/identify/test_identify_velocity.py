from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import IdentificationError, RunFolderError
from odometry.modes.identify.identify_velocity import CORRECTED_S, identify_velocity_modes
from tests.odometry.modes.mode_drives import run_of_tables, velocities, velocity_run, wandering

NAMES = ("ice", "mud", "tar")
STEP_S, SIGMA, SIZE = 0.02, 0.02, 3000
A = {
    "ice": np.array([[-3.0, 0.0], [0.0, -2.0]]),
    "mud": np.array([[-5.0, 0.1], [0.2, -4.0]]),
    "tar": np.array([[-8.0, 0.0], [-0.3, -6.0]]),
}
SETTLED = {
    "ice": np.array([[0.45, 0.45], [-0.6, 0.6]]),
    "mud": np.array([[0.40, 0.44], [-1.0, 0.9]]),
    "tar": np.array([[0.50, 0.50], [-1.4, 1.5]]),
}
B = {name: -A[name] @ SETTLED[name] for name in NAMES}


def drive(seed, labels, **settings):
    return velocity_run(np.random.default_rng(seed), A, B, labels, step_s=STEP_S, **settings)


@pytest.fixture(scope="module")
def grounds():
    return [drive(seed, [name] * SIZE) for seed, name in enumerate(NAMES)]


@pytest.fixture(scope="module")
def modes(grounds):
    return identify_velocity_modes(grounds)


def without(table, *names):
    columns = {name: column for name, column in table.columns.items() if name not in names}
    return replace(table, columns=columns)


def test_settled_gains_of_each_terrain_are_found(modes):
    """Of 3000 samples with noise 0.02, turns of 0.3 m/s: sigma 0.02 / 0.3 / sqrt(3000) = 0.0012.

    Both treads go mostly together, and lags smooth them: 0.01 is four times twice that.
    """
    assert modes.names == NAMES
    expected = [SETTLED[name] for name in NAMES]
    np.testing.assert_allclose(modes.steady_gains(), expected, atol=0.01)


def test_rates_and_cross_gains_are_found(modes):
    expected = np.array([A[name] for name in NAMES])
    rates, known = (np.diagonal(of, axis1=1, axis2=2) for of in (modes.A, expected))
    np.testing.assert_allclose(rates, known, rtol=0.05)
    crossed, known = (np.stack([of[:, 0, 1], of[:, 1, 0]]) for of in (modes.A, expected))
    np.testing.assert_allclose(crossed, known, atol=0.15)


def test_noise_that_is_white_is_found_and_does_not_last(modes):
    np.testing.assert_allclose(modes.measurement_variance, SIGMA**2, rtol=0.1)
    np.testing.assert_allclose(
        modes.process_variance, modes.measurement_variance * STEP_S / CORRECTED_S**2
    )
    assert modes.errors_last_s == pytest.approx(STEP_S, rel=0.5)


def test_labels_may_change_within_a_run(modes):
    labels = [name for name in ("tar", "ice", "mud", "tar", "ice") for _ in range(SIZE // 2)]
    found = identify_velocity_modes([drive(7, labels)])
    assert found.names == NAMES
    np.testing.assert_allclose(found.steady_gains(), modes.steady_gains(), atol=0.02)


def test_one_a_and_b_for_all_and_noise_of_each(grounds):
    """Mud lies between: what one model misses of it is least."""
    found = identify_velocity_modes(grounds, shared=True)
    for blocks in (found.A, found.B):
        np.testing.assert_array_equal(blocks, np.tile(blocks[:1], (3, 1, 1)))
    turns = found.steady_gains()[0, 1]
    assert np.all((np.abs(turns) > 0.6) & (np.abs(turns) < 1.5))
    assert found.measurement_variance[:, 1].argmin() == NAMES.index("mud")
    assert found.measurement_variance[0, 1] > 5 * found.measurement_variance[1, 1] > 5 * SIGMA**2


def test_one_noise_for_all(grounds, modes):
    rough = drive(8, ["tar"] * SIZE, sigmas=(0.1, 0.2))
    found = identify_velocity_modes([*grounds[:2], rough], common_noise=True)
    np.testing.assert_array_equal(
        found.measurement_variance, np.tile(found.measurement_variance[:1], (3, 1))
    )
    np.testing.assert_allclose(found.measurement_variance, SIGMA**2, rtol=0.1)
    np.testing.assert_array_equal(found.A[:2], modes.A[:2])


def test_a_speed_that_nobody_measured_is_that_of_the_wheels(grounds, modes):
    found = identify_velocity_modes([replace(run, velocity=None) for run in grounds])
    np.testing.assert_array_equal(found.A[:, 0], np.tile([-10.0, 0.0], (3, 1)))
    np.testing.assert_array_equal(found.B[:, 0], np.full((3, 2), 5.0))
    np.testing.assert_allclose(found.steady_gains()[:, 1], modes.steady_gains()[:, 1], atol=0.05)


def test_speeds_are_read_from_poses(modes):
    """Straight on, as fast as ice has it; what poses add is their noise."""
    rng = np.random.default_rng(4)
    treads = np.repeat(wandering(rng, SIZE, STEP_S)[:, :1], 2, axis=1)
    one = [A["ice"]] * SIZE, [B["ice"]] * SIZE
    speed, omega = velocities(*one, treads, STEP_S).T
    t = STEP_S * np.arange(SIZE)
    odometry = {"t": t, "v_left": treads[:, 0], "v_right": treads[:, 1], "gyro_z": omega}
    x = np.append(0.0, np.cumsum(speed[:-1] + speed[1:]) * STEP_S / 2)
    pose = {"t": t, "x": x + 0.002 * rng.normal(size=SIZE), "y": 0 * t, "yaw": 0 * t}
    found = identify_velocity_modes([run_of_tables(odometry, pose=pose, terrain="ice")])
    gains = found.steady_gains()[0, 0].sum()
    assert gains == pytest.approx(modes.steady_gains()[0, 0].sum(), abs=0.02)
    assert found.A[0, 0, 0] == pytest.approx(A["ice"][0, 0], rel=0.1)


def test_a_yaw_rate_may_stand_in_velocity_csv(grounds, modes):
    bare = [replace(run, odometry=without(run.odometry, "gyro_z")) for run in grounds]
    np.testing.assert_allclose(identify_velocity_modes(bare).A, modes.A)


def test_a_terrain_without_a_name_is_reported_by_folder_and_rows():
    run = drive(5, [*["ice"] * 600, *["mud"] * 200, *["ice"] * 100], folder="run_17")
    names = np.array(run.odometry["terrain"])
    names[600:800] = "unknown"
    odometry = replace(run.odometry, columns={**run.odometry.columns, "terrain": names})
    with pytest.raises(IdentificationError, match=r"run_17: rows 600 to 799 of odometry\.csv"):
        identify_velocity_modes([replace(run, odometry=odometry)])


def test_less_than_ten_seconds_of_a_terrain_are_too_few():
    labels = [*["ice"] * 600, *["mud"] * 499]
    with pytest.raises(IdentificationError, match=r"mud: 10\.0 s recorded, expected 10 s"):
        identify_velocity_modes([drive(5, labels)])
    with pytest.raises(IdentificationError, match=r"mud: 6\.0 s recorded"):
        identify_velocity_modes([drive(5, labels[:900])])


def test_no_yaw_rate_is_reported_by_folder(grounds):
    run = replace(grounds[0], odometry=without(grounds[0].odometry, "gyro_z"), velocity=None)
    with pytest.raises(RunFolderError, match="drive: no yaw rate"):
        identify_velocity_modes([run])


@pytest.mark.parametrize("ratio", [1.0, 0.6, -1.0])
def test_terrains_that_turn_alike_all_the_time_are_no_modes(grounds, ratio):
    """Straight on, one circle, one rate on the spot; by a shared model the others know."""
    mud, rng = grounds[1].odometry, np.random.default_rng(0)
    speeds = np.abs(mud["v_left"]) if ratio > 0 else np.full(SIZE, 0.3)
    treads = {
        name: of * speeds * (1 + rng.normal(0, 0.01, SIZE))
        for name, of in (("v_left", ratio), ("v_right", 1.0))
    }
    alike = replace(mud, columns={**mud.columns, **treads})
    runs = [grounds[0], replace(grounds[1], odometry=alike)]
    with pytest.raises(IdentificationError, match="mud: its runs go straight on, or turn alike"):
        identify_velocity_modes(runs)
    assert identify_velocity_modes([*runs, grounds[1]]).names == ("ice", "mud")
    assert identify_velocity_modes(runs, shared=True).names == ("ice", "mud")


def test_runs_are_of_one_robot(grounds, modes):
    assert modes.track_width == grounds[0].robot.track_width
    other = replace(grounds[1], robot=replace(grounds[1].robot, track_width=0.7))
    with pytest.raises(IdentificationError, match=r"track_width = 0\.7"):
        identify_velocity_modes([grounds[0], other])
