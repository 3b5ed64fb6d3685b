"""Messages of bags one by one, as if live."""

import numpy as np
import pytest

from odometry import installed
from odometry.bags.files.messages import bag_messages
from odometry.errors import BagError, ExtraError
from tests.odometry.bags.made_bags import BEGIN_NS, Bag, name_of


def driven(kind, begin_s=0.0):
    bag = Bag(kind)
    for k in range(10):
        t_s = begin_s + 0.1 * k
        bag.joints(t_s, ["left", "right"], [], [1.0 + k, 2.0], stamp_s=t_s - 0.03)
        bag.imu(t_s + 0.05, [0.0, 0.0, 0.2], [0.0, 0.0, 9.8])
    bag.text("/said", begin_s + 2.0, "no header")
    return bag


@pytest.mark.parametrize("kind", ["ros1", "mcap", "sqlite3"])
def test_messages_come_in_order_with_the_stamps_of_their_headers(tmp_path, kind):
    path = driven(kind).write(tmp_path / name_of(kind))
    found = list(bag_messages(path))
    assert [m.topic for m in found] == ["/joint_states", "/imu/data"] * 10 + ["/said"]
    offsets_s = [m.stamp_s - BEGIN_NS / 10**9 for m in found]
    expected_s = [0.1 * k + off for k in range(10) for off in (-0.03, 0.05)] + [2.0]
    np.testing.assert_allclose(offsets_s, expected_s, rtol=0, atol=3e-7)
    assert [m.content.velocity[0] for m in found[:-1:2]] == [1.0 + k for k in range(10)]
    assert found[-1].content.data == "no header"


def test_files_come_in_the_order_of_their_messages_whatever_their_names(tmp_path):
    later = driven("ros1", begin_s=50.0).write(tmp_path / "drive_10.bag")
    sooner = driven("ros1").write(tmp_path / "drive_9.bag")
    stamps_s = [message.stamp_s for message in bag_messages(later, sooner)]
    assert len(stamps_s) == 42
    assert np.diff(stamps_s).max() > 40
    assert np.diff(stamps_s).min() > -0.1


def test_files_of_the_same_time_come_interleaved(tmp_path):
    whole, wheels, rest = driven("mcap"), Bag("mcap"), Bag("mcap")
    for one in whole.written:
        (wheels if one[0] == "/joint_states" else rest).written.append(one)
    parts = [wheels.write(tmp_path / "wheels"), rest.write(tmp_path / "rest")]
    expected = [(m.topic, m.stamp_s) for m in bag_messages(whole.write(tmp_path / "whole"))]
    assert [(m.topic, m.stamp_s) for m in bag_messages(*parts)] == expected


def test_what_is_no_bag_is_an_error(tmp_path):
    with pytest.raises(BagError, match="there is no such file"):
        next(bag_messages(tmp_path / "none.bag"))


def test_without_the_extra_it_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(
        installed, "find_spec", lambda name: None if name == "rosbags" else object()
    )
    with pytest.raises(ExtraError, match=r"rosbags.*terrain-odometry\[bags\]"):
        next(bag_messages(tmp_path / "any.bag"))
