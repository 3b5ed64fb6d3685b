import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from odometry.errors import TrajectoryError
from odometry.geometry import se3
from odometry.io import number_rows
from odometry.io.tum import read_spatial_tum, read_tum, write_spatial_tum, write_tum
from odometry.trajectory import SpatialTrajectory, Trajectory


def test_the_row_of_a_left_turn(tmp_path):
    """Stamp, x y z, then the quaternion x y z w: sin and cos of half the yaw about z."""
    file = tmp_path / "a.tum"
    write_tum(file, Trajectory(np.array([1.5]), np.array([[2.0, -3.0, np.pi / 3]])))
    row = [float(word) for word in file.read_text().split()]
    np.testing.assert_allclose(row, [1.5, 2, -3, 0, 0, 0, 0.5, np.sqrt(3) / 2], atol=1e-12)


poses = st.tuples(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4), st.floats(-3.1415, 3.1415))


@given(st.lists(poses, min_size=1, max_size=6), st.integers(0, 2 * 10**9))
def test_what_is_written_reads_back(tmp_path_factory, poses, start_s):
    """Stamps to a microsecond (of Unix times, too), positions and yaw to 1e-9."""
    stamps_s = start_s + 0.1 * np.arange(len(poses))
    file = tmp_path_factory.getbasetemp() / "round_trip.tum"
    write_tum(file, Trajectory(stamps_s, np.array(poses)))
    again = read_tum(file)
    np.testing.assert_allclose(again.stamps_s, stamps_s, rtol=0, atol=1e-6)
    np.testing.assert_allclose(again.poses, poses, rtol=0, atol=1e-9)


vectors = st.tuples(*[st.floats(-4, 4)] * 3)


@given(st.lists(st.tuples(poses, vectors), min_size=1, max_size=6), st.integers(0, 2 * 10**9))
def test_what_is_written_in_space_reads_back(tmp_path_factory, rows, start_s):
    """Positions and every entry of the rotation matrix to 1e-9; the second time the same bytes."""
    positions, turns = (np.array(column) for column in zip(*rows, strict=True))
    written = SpatialTrajectory(
        start_s + 0.1 * np.arange(len(rows)),
        se3.pose(positions, Rotation.from_rotvec(turns).as_matrix()),
    )
    file = tmp_path_factory.getbasetemp() / "in_space.tum"
    write_spatial_tum(file, written)
    again = read_spatial_tum(file)
    np.testing.assert_allclose(again.stamps_s, written.stamps_s, rtol=0, atol=1e-6)
    np.testing.assert_allclose(again.poses, written.poses, rtol=0, atol=1e-9)


def test_the_row_of_a_body_in_space(tmp_path):
    """scipy's quaternion has TUM's order; of its two signs the one with qw > 0 is written."""
    rotation = Rotation.from_euler("ZYX", [3.0, 0.2, -0.4])
    pose = se3.pose(np.array([1.0, -2, 3]), rotation.as_matrix())
    file = tmp_path / "a.tum"
    write_spatial_tum(file, SpatialTrajectory(np.array([0.25]), pose[None]))
    row = [float(word) for word in file.read_text().split(" ")]
    expected = [0.25, 1, -2, 3, *rotation.as_quat(canonical=True)]
    np.testing.assert_allclose(row, expected, rtol=0, atol=1e-14)


def test_both_signs_and_a_rounded_length_read_as_one_rotation(tmp_path):
    file, rotation = tmp_path / "a.tum", Rotation.from_rotvec([0.3, -0.5, 0.7])
    words = [f"{part:.3f}" for part in np.concatenate([rotation.as_quat(), -rotation.as_quat()])]
    file.write_text(f"0 0 0 0 {' '.join(words[:4])}\n1 0 0 0 {' '.join(words[4:])}\n")
    first, second = read_spatial_tum(file).poses
    np.testing.assert_array_equal(first, second)
    np.testing.assert_allclose(first[:3, :3], rotation.as_matrix(), rtol=0, atol=2e-3)
    np.testing.assert_allclose(first @ first.T, np.eye(4), rtol=0, atol=1e-15)


def test_comments_and_empty_lines_are_skipped(tmp_path):
    file = tmp_path / "a.tum"
    file.write_text("# stamp x y z q\n\n1 2 3 0 0 0 0 1\n")
    assert read_tum(file).poses.tolist() == [[2, 3, 0]]


def test_yaw_of_a_tilted_quaternion(tmp_path):
    """Rz(0.5) Rx(0.3): the product of the two half-angle quaternions."""
    (c, s), (cx, sx) = [(np.cos(a / 2), np.sin(a / 2)) for a in (0.5, 0.3)]
    file = tmp_path / "a.tum"
    file.write_text(f"0 0 0 0 {c * sx} {s * sx} {s * cx} {c * cx}\n")
    assert read_tum(file).poses[0, 2] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("0 0 0 0 0 0 0 1\n1 2 3\n", ["row 2", "3"]),
        ("0 0 0 0 0 0 0 one\n", ["row 1", "qw", "one"]),
        ("0 0 0 0 0 0 0 1\n\n1 0 nan 0 0 0 0 1\n", ["row 3", "y", "nan", "finite"]),
        ("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 0\n", ["row 2", "length 0", "expected 1"]),
        ("0 0 0 0 0.5 0.5 0.5 0\n", ["row 1", "length 0.866025", "expected 1"]),
        ("# nothing\n", ["no pose"]),
        ("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", ["row 2", "1.0 after 1.0", "increase"]),
    ],
)
def test_what_is_wrong_is_named(tmp_path, content, words):
    (tmp_path / "a.tum").write_text(content)
    with pytest.raises(TrajectoryError) as error:
        read_tum(tmp_path / "a.tum")
    for word in ["a.tum", *words]:
        assert word in str(error.value)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(TrajectoryError, match="gone"):
        read_tum(tmp_path / "gone.tum")


@pytest.mark.parametrize("rows", [1, 2, 5])
def test_blocks_make_one_trajectory(tmp_path, monkeypatch, rows):
    monkeypatch.setattr(number_rows, "BLOCK_ROWS", rows)
    file = tmp_path / "a.tum"
    file.write_text("# c\n1 2 3 0 0 0 0 1\n\n2 3 4 0 0 0 0 1\n3 4 5 0 0 0 0 1\n")
    assert read_tum(file).poses[:, 0].tolist() == [2, 3, 4]
    file.write_text("1 2 3 0 0 0 0 1\n3 3 4 0 0 0 0 1\n2 4 5 0 0 0 0 1\n")
    with pytest.raises(TrajectoryError, match=r"row 3: stamp 2\.0 after 3\.0"):
        read_tum(file)
    file.write_text("1 2 3 0 0 0 0 1\n3 1e200 4 0 0 0 0 1\n")
    with pytest.raises(TrajectoryError, match=r"row 2, x: '1e200', .* at most 1e\+11"):
        read_tum(file)
