"""results.mcap, read again by rosbags: poses, covariances, twists, labels, stamps."""

import sys

import numpy as np
import pytest

from odometry.errors import ExportError, ExtraError
from odometry.export import mcap
from odometry.export.source import read_export_source
from odometry.geometry import se2
from odometry.io.csv_table import write_csv_table
from odometry.io.euroc import nanoseconds
from tests.odometry.export.result_folder import SEEN, SPEED_M_S, STAMPS_S, circle, write_results

highlevel = pytest.importorskip("rosbags.highlevel")


@pytest.fixture
def written(tmp_path):
    """The folder that is written to, and what the reader finds in its file, by topic."""
    source = read_export_source(write_results(tmp_path / "results"))
    mcap.write(source, tmp_path / "out")
    found = {}
    with highlevel.AnyReader([tmp_path / "out" / "results.mcap"]) as reader:
        order = []
        for connection, stamp_ns, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            found.setdefault(connection.topic, []).append((stamp_ns, message))
            order.append(stamp_ns)
    assert order == sorted(order)
    return tmp_path / "out", found


def poses_of(messages):
    positions = [message.pose.pose.position for _, message in messages]
    turns = [message.pose.pose.orientation for _, message in messages]
    yaw = [2 * np.arctan2(turn.z, turn.w) for turn in turns]
    return np.column_stack([[p.x for p in positions], [p.y for p in positions], yaw])


def test_it_is_one_file_with_every_pose(written):
    folder, found = written
    assert [file.name for file in folder.iterdir()] == ["results.mcap"]
    for name in ("odometer", "estimate"):
        messages = found[f"/terrain_odometry/{name}"]
        np.testing.assert_allclose(poses_of(messages), circle(), atol=2e-9)
        stamps_ns = [nanoseconds(stamp_s) for stamp_s in STAMPS_S]
        assert [stamp for stamp, _ in messages] == pytest.approx(stamps_ns, abs=1)
        of_header = [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for _, m in messages]
        assert of_header == [stamp for stamp, _ in messages]
        assert {message.header.frame_id for _, message in messages} == {"map"}
        assert {message.child_frame_id for _, message in messages} == {"base_link"}


def test_the_covariance_is_that_of_the_table(written):
    _, found = written
    (_, message), *_ = found["/terrain_odometry/odometer"]
    covariance = message.pose.covariance.reshape(6, 6)
    np.testing.assert_array_equal(covariance, covariance.T)
    plane = covariance[np.ix_([0, 1, 5], [0, 1, 5])]
    np.testing.assert_allclose(plane, [[1, 0.1, 0.2], [0.1, 4, 0.3], [0.2, 0.3, 9]])
    assert np.diag(covariance)[2:5].tolist() == [1e6] * 3
    (_, estimate), *_ = found["/terrain_odometry/estimate"]
    assert estimate.pose.covariance.reshape(6, 6)[0, 1] == 0


def test_twists_integrate_to_the_poses(written):
    _, found = written
    twists = [m.twist.twist for _, m in found["/terrain_odometry/odometer"]]
    moving = np.array([[t.linear.x, t.linear.y, t.angular.z] for t in twists])
    pose = circle()[0]
    for step in moving[:-1]:
        pose = se2.compose(pose, se2.exp(0.1 * step))
    np.testing.assert_allclose(pose, circle()[-1], atol=1e-6)
    assert moving[0, 0] == pytest.approx(SPEED_M_S, rel=1e-6)
    assert moving[0, 1] == pytest.approx(0, abs=1e-6)


def test_labels_are_there_where_there_was_one(written):
    _, found = written
    driven = [(stamp, message.data) for stamp, message in found["/terrain_odometry/terrain"]]
    assert driven == [(0, "gravel"), (2 * 10**9, "gravel"), (6 * 10**9, "grass")]
    seen = [(stamp, message.data) for stamp, message in found["/terrain_odometry/seen"]]
    assert seen == [(2 * 10**9, "grass"), (6 * 10**9, "grass")]


def test_the_same_result_gives_the_same_bytes(tmp_path):
    source = read_export_source(write_results(tmp_path / "results"))
    for name in ("once", "again"):
        mcap.write(source, tmp_path / name)
    first, second = (tmp_path / name / "results.mcap" for name in ("once", "again"))
    assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize("shift_s", [-1.0, 2.0**31])
def test_stamps_that_ros_has_not_are_refused(tmp_path, shift_s):
    folder = write_results(tmp_path / "results")
    write_csv_table(folder / "terrain.csv", SEEN | {"t": SEEN["t"] + shift_s})
    poses = dict(zip(("x", "y", "yaw"), circle().T, strict=True))
    sigmas = dict.fromkeys(("sigma_x", "sigma_y", "sigma_yaw"), np.ones(101))
    for name in ("odometer", "estimate"):
        write_csv_table(folder / f"{name}.csv", {"t": STAMPS_S + shift_s} | poses | sigmas)
    with pytest.raises(ExportError, match="ROS 2 has stamps from 0"):
        mcap.write(read_export_source(folder), tmp_path / "out")


def test_without_rosbags_the_extra_is_named(tmp_path, monkeypatch):
    source = read_export_source(write_results(tmp_path / "results"))
    monkeypatch.setitem(sys.modules, "rosbags", None)
    with pytest.raises(ExtraError, match=r"rosbags.*terrain-odometry\[bags\]"):
        mcap.write(source, tmp_path / "out")
