import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import TrajectoryError
from odometry.io.tum import read_tum, write_tum
from odometry.trajectory import Trajectory


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
        ("0 0 0 0 0 0 0 one\n", ["row 1", "one"]),
        ("# nothing\n", ["no pose"]),
        ("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", ["increase"]),
    ],
)
def test_what_is_wrong_is_named(tmp_path, content, words):
    (tmp_path / "a.tum").write_text(content)
    with pytest.raises(TrajectoryError) as error:
        read_tum(tmp_path / "a.tum")
    for word in words:
        assert word in str(error.value)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(TrajectoryError, match="gone"):
        read_tum(tmp_path / "gone.tum")
