"""Every trajectory format: round trips, frames, and what is wrong with a file."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from odometry.errors import TrajectoryError
from odometry.geometry import se3
from odometry.io.euroc import read_euroc, seconds, write_euroc
from odometry.io.trajectory_files import (
    FORMATS,
    format_of,
    from_optical,
    read_trajectory,
    to_optical,
    write_trajectory,
)
from odometry.trajectory import SpatialTrajectory

small = st.floats(-1e3, 1e3)
bodies = st.tuples(small, small, small, *[st.floats(-4, 4)] * 3)


def trajectory(rows, stamps_s):
    table = np.array(rows)
    rotations = Rotation.from_rotvec(table[:, 3:]).as_matrix()
    return SpatialTrajectory(np.asarray(stamps_s, float), se3.pose(table[:, :3], rotations))


@pytest.mark.parametrize("name", FORMATS)
@given(st.lists(bodies, min_size=1, max_size=5), st.integers(0, 2 * 10**9))
def test_what_is_written_reads_back(tmp_path_factory, name, rows, start_s):
    """Stamps to 240 ns of Unix times, matrices to 1e-9; the second time the same bytes."""
    folder = tmp_path_factory.getbasetemp()
    written = trajectory(rows, start_s + 0.1 * np.arange(len(rows)))
    files = write_trajectory(folder, "a", written, name)
    again = read_trajectory(files[0], times=files[-1])
    assert format_of(files[0]) == name
    np.testing.assert_allclose(again.stamps_s, written.stamps_s, rtol=0, atol=2.4e-7)
    np.testing.assert_allclose(again.poses, written.poses, rtol=0, atol=1e-9)
    same = write_trajectory(folder, "b", again, name)
    assert read_trajectory(same[0], times=same[-1]).stamps_s.tolist() == again.stamps_s.tolist()


@given(st.integers(0, 2**33 * 10**9))
def test_nanoseconds_of_euroc_are_kept(tmp_path_factory, nanoseconds):
    """Each one up to 97 days; above, the float64 nearest to it, and that is kept for good."""
    file = tmp_path_factory.getbasetemp() / "stamps.csv"
    file.write_text(f"#timestamp [ns],x,y,z,w,x,y,z\n{nanoseconds},0,0,0,1,0,0,0\n")
    first = read_euroc(file)
    write_euroc(file, first)
    written = int(file.read_text().splitlines()[1].split(",")[0])
    assert read_euroc(file).stamps_s.tolist() == first.stamps_s.tolist()
    assert abs(written - nanoseconds) <= (0 if nanoseconds < 2**23 * 10**9 else 480)


def test_a_stamp_is_rounded_once():
    """By way of a float of nanoseconds it would be another number."""
    nanoseconds = 1403636580838555648 + 77
    assert seconds(str(nanoseconds)) == 1403636580 + 0.838555725
    assert any(
        seconds(str(each)) != float(each) / 1e9 for each in range(nanoseconds, nanoseconds + 999)
    )


def test_further_columns_of_a_euroc_truth_are_left_out(tmp_path):
    file = tmp_path / "data.csv"
    file.write_text("#t\n1500000000, 1, 2, 3, 0.5, 0.5, -0.5, 0.5, 9, 9, 9, 8, 8, 8, 7, 7, 7\n")
    found = read_trajectory(file)
    assert found.stamps_s.tolist() == [1.5]
    assert found.positions_m.tolist() == [[1, 2, 3]]
    np.testing.assert_allclose(found.quaternions_wxyz, [[0.5, 0.5, -0.5, 0.5]], atol=1e-15)


def test_a_camera_that_drives_a_left_bend_in_kitti(tmp_path):
    """Two metres along z and one along -x are ahead and left; -90 degrees about y is a left turn.

    The third row of the rotation is where the camera's z points: -x of the start.
    """
    file, times = tmp_path / "poses.txt", tmp_path / "times.txt"
    file.write_text("1 0 0 0 0 1 0 0 0 0 1 0\n0 0 -1 -1 0 1 0 -0.5 1 0 0 2\n")
    times.write_text("0.0\n0.5\n")
    found = read_trajectory(file, times=times)
    np.testing.assert_allclose(found.positions_m[1], [2, 1, 0.5], atol=1e-15)
    np.testing.assert_allclose(found.roll_pitch_yaw[1], [0, 0, np.pi / 2], atol=1e-15)
    as_it_stands = read_trajectory(file, times=times, axes="robot")
    np.testing.assert_allclose(as_it_stands.positions_m[1], [-1, -0.5, 2], atol=1e-15)


def test_optical_axes_and_back(rng):
    moving = trajectory(rng.normal(size=(6, 6)), np.arange(6.0))
    there = to_optical(moving)
    np.testing.assert_allclose(from_optical(there).poses, moving.poses, atol=1e-14)
    np.testing.assert_allclose(there.positions_m[:, 2], moving.positions_m[:, 0])
    np.testing.assert_allclose(there.positions_m[:, 0], -moving.positions_m[:, 1])


def test_kitti_without_its_times_says_what_is_missing(tmp_path):
    file = tmp_path / "poses.txt"
    file.write_text("1 0 0 0 0 1 0 0 0 0 1 0\n")
    with pytest.raises(TrajectoryError, match=r"poses.txt: KITTI poses have no stamps.*times.txt"):
        read_trajectory(file)


@pytest.mark.parametrize(
    ("poses", "times", "words"),
    [
        ("1 0 0 0 0 1 0 0 0 0 1 0\n", "0\n1\n", ["times.txt: 2 stamps", "1 poses"]),
        ("1 0 0 0 0 1 0 0 0 0 1 0\n" * 2, "1\n1\n", ["times.txt: row 2", "1.0 after 1.0"]),
        ("1 0 0 0 0 2 0 0 0 0 1 0\n", "0\n", ["poses.txt: row 1", "no rotation"]),
        ("1 0 0 0 0 1 0 0 0 0 -1 0\n", "0\n", ["poses.txt: row 1", "no rotation"]),
        ("1 0 0 0 0 1 0 0 0 0 1 inf\n", "0\n", ["poses.txt: row 1, t3", "'inf'", "finite"]),
        ("1 0 0 0 0 1 0 0 0 0 1 0\n", "soon\n", ["times.txt: row 1, time", "'soon'"]),
    ],
)
def test_what_is_wrong_with_kitti_is_named(tmp_path, poses, times, words):
    (tmp_path / "poses.txt").write_text(poses)
    (tmp_path / "times.txt").write_text(times)
    with pytest.raises(TrajectoryError) as error:
        read_trajectory(tmp_path / "poses.txt", times=tmp_path / "times.txt")
    for word in words:
        assert word in str(error.value)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("1.5,0,0,0,1,0,0,0\n", ["row 1, timestamp", "'1.5' is not a number"]),
        ("1,0,0,0,1,0,0,1\n", ["row 1", "length 1.41421"]),
        ("2,0,0,0,1,0,0,0\n1,0,0,0,1,0,0,0\n", ["row 2", "increase"]),
        ("1 2 3\n", ["first row '1 2 3'", "no known format"]),
        ("# nothing\n", ["there is no pose in it"]),
    ],
)
def test_what_is_wrong_with_a_row_is_named(tmp_path, content, words):
    (tmp_path / "a.csv").write_text(content)
    with pytest.raises(TrajectoryError) as error:
        read_trajectory(tmp_path / "a.csv")
    for word in ["a.csv", *words]:
        assert word in str(error.value)
