"""Maps of topics: the shipped example is one."""

from pathlib import Path

from odometry.bags.topics.topic_roles import KEYS, read_topic_map
from odometry.bags.topics.wheel_names import UNITS
from odometry.errors import BagError
from odometry.io.structured import read_toml

EXAMPLE = Path(__file__).parents[4] / "data/bags/map.toml"


def test_the_shipped_map_can_be_read():
    topic_map = read_topic_map(EXAMPLE)
    assert topic_map.wheels["left"] == ["front_left_wheel", "rear_left_wheel"]
    assert topic_map.robot["frame_height"] == 0.132
    assert topic_map.other_odometry == ("/odometry/filtered",)
    assert topic_map.wheels["unit"] in UNITS


def test_the_shipped_map_shows_every_key():
    content = read_toml(EXAMPLE, BagError)
    for table, keys in KEYS.items():
        assert keys.keys() - (content[table] if table else content).keys() == set()


def test_options_override_the_map_key_by_key():
    changed = read_topic_map(EXAMPLE).overridden({"robot.track_width": 1.0, "time": None})
    assert changed.robot["track_width"] == 1.0
    assert changed.robot["wheel_radius"] == 0.165
    assert changed.time == "auto"


def test_every_key_of_a_table_is_a_field_of_the_wishes():
    assert set(KEYS) - {""} == {"robot", "wheels", "imu", "reference", "images"}
