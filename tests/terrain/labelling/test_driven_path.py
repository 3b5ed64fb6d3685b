"""When the footprint was over a piece of ground, on ways whose answer is known."""

import numpy as np
import pytest

from odometry.recording.run import Run
from odometry.trajectory import Trajectory
from terrain.labelling.driven_path import STEP_M, DrivenWay

SPEED_M_S, LENGTH_M, WIDTH_M = 0.5, 0.4, 0.34


def way(folder, world, speeds_m_s, stamps_s):
    """Along x with given tread speeds; the trajectory is exact."""
    folder.mkdir()
    world.write_toml(folder / "run.toml", robot=world.robot)
    rows = np.column_stack([stamps_s, speeds_m_s, speeds_m_s])
    world.write_csv(folder / "odometry.csv", "t,v_left,v_right", rows)
    x = np.append(0.0, np.cumsum(speeds_m_s[:-1] * np.diff(stamps_s)))
    poses = np.column_stack([x, 0 * x, 0 * x])
    return DrivenWay.of(Run.read(folder), Trajectory(np.asarray(stamps_s), poses))


@pytest.fixture
def ahead(tmp_path, world):
    stamps_s = np.arange(0.0, 10.0, 0.1)
    return way(tmp_path / "ahead", world, np.full(100, SPEED_M_S), stamps_s)


def square(x, y, side_m=0.2):
    grid = np.linspace(-side_m / 2, side_m / 2, 5)
    return np.stack(np.meshgrid(x + grid, y + grid), axis=-1).reshape(1, -1, 2)


@pytest.mark.parametrize("y", [0.0, 0.07, -0.07])
def test_from_the_first_touch_of_the_front_to_the_last_of_the_rear(ahead, y):
    (passing,) = ahead.passings(square(2.0, y), slice(None))
    step_s = STEP_M / SPEED_M_S
    begin_s, end_s = (2.0 - 0.1 - LENGTH_M / 2) / SPEED_M_S, (2.1 + LENGTH_M / 2) / SPEED_M_S
    assert begin_s - 2 * step_s <= passing.begin_s <= begin_s
    assert end_s <= passing.end_s <= end_s + 2 * step_s


@pytest.mark.parametrize(
    ("x", "y"), [(2.0, 0.08), (2.0, -0.08), (2.0, 0.5), (-1.0, 0.0), (5.3, 0.0)]
)
def test_ground_beside_behind_and_beyond_the_end_is_not_passed_whole(ahead, x, y):
    assert ahead.passings(square(x, y), slice(None)) == [None]


def test_ground_is_passed_first_and_again(tmp_path, world):
    """Ahead, back and ahead again: the first passing counts, up to where it is left."""
    stamps_s = np.arange(0.0, 18.0, 0.1)
    speeds = np.where((stamps_s > 5.95) & (stamps_s < 11.95), -SPEED_M_S, SPEED_M_S)
    there = way(tmp_path / "back", world, speeds, stamps_s)
    (passing,) = there.passings(square(1.0, 0.0), slice(None))
    assert passing.end_s == pytest.approx((1.1 + LENGTH_M / 2) / SPEED_M_S, abs=0.13)
    (again,) = there.passings(square(1.0, 0.0), there.ahead(6.0, 9.0))
    assert again.begin_s == pytest.approx(6.0 + (3.0 - 1.1 - LENGTH_M / 2) / SPEED_M_S, abs=0.13)


def test_ground_before_which_the_robot_went_back_is_not_passed(tmp_path, world):
    """The front of the footprint is over it; the middle, whose terrain is given, never."""
    stamps_s = np.arange(0.0, 12.0, 0.1)
    speeds = np.where(stamps_s > 5.95, -SPEED_M_S, SPEED_M_S)
    there = way(tmp_path / "back", world, speeds, stamps_s)
    front_m = 3.0 + LENGTH_M / 2
    assert there.passings(square(front_m - 0.12, 0.0), slice(None)) == [None]
    assert there.passings(square(2.0, 0.0), slice(None)) != [None]


def test_ground_on_which_the_robot_turned_round_is_not_passed(tmp_path, world):
    """To x = 2, a quarter turn on the spot, and on along y."""
    folder = tmp_path / "round"
    folder.mkdir()
    world.write_toml(folder / "run.toml", robot=world.robot)
    stamps_s = np.arange(0.0, 12.0, 0.1)
    turning = (stamps_s > 3.95) & (stamps_s < 5.95)
    right = np.full(len(stamps_s), SPEED_M_S)
    left = np.where(turning, -SPEED_M_S, SPEED_M_S)
    world.write_csv(
        folder / "odometry.csv", "t,v_left,v_right", zip(stamps_s, left, right, strict=True)
    )
    x = SPEED_M_S * np.minimum(stamps_s, 4.0)
    y = SPEED_M_S * np.maximum(stamps_s - 6.0, 0.0)
    yaw = np.clip((stamps_s - 4.0) / 2.0, 0.0, 1.0) * np.pi / 2
    poses = np.column_stack([x, y, yaw])
    there = DrivenWay.of(Run.read(folder), Trajectory(stamps_s, poses))
    pieces = np.concatenate([square(x, y) for x, y in ((2.06, 0.0), (1.0, 0.0), (2.0, 1.0))])
    passed = [passing is not None for passing in there.passings(pieces, slice(None))]
    assert passed == [False, True, True]


def test_rows_ahead_reach_so_much_wheel_travel(ahead):
    rows = ahead.ahead(2.0, 1.0)
    x = ahead.trajectory.poses[rows, 0]
    assert 1.0 <= x[0] <= 1.0 + STEP_M
    assert 2.0 - STEP_M <= x[-1] <= 2.0 + 1e-9
    assert np.diff(ahead.trajectory.poses[:, 0]).max() <= STEP_M + 1e-9
