"""What is lost for a known cause says the cause, and what to do."""

import numpy as np
import pytest

from odometry.errors import BagError
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, Bag, course, half_turn

COURSE = np.array(list(course(8.0)))
RATES = COURSE[:, 1:3] / RADIUS_M
TICKS = 4096


def bag_of(*parts):
    """Joint states: each part is the names and places (N, k), or rates where they are floats."""
    bag = Bag("mcap")
    for row, (t_s, *_) in enumerate(COURSE):
        for number, (names, places, rates) in enumerate(parts):
            moved = np.zeros(0) if rates is None else rates[row]
            at = np.zeros(len(names)) if places is None else places[row]
            bag.joints(t_s + number / 1000, list(names), at, moved)
    return bag


def angles():
    return np.cumsum(RATES * 0.05, axis=0)


def test_ticks_ask_for_their_number_and_are_read_with_it(tmp_path):
    ticks = np.rint(angles() / 2 / np.pi * TICKS)
    bag = bag_of((["left_wheel", "right_wheel"], ticks, None)).write(tmp_path / "drive")
    with pytest.raises(BagError, match=r"as ticks of an encoder are.*--unit turns --gear TICKS"):
        imported(tmp_path / "run", bag)
    run, _ = imported(tmp_path / "again", bag, wheels__unit="turns", wheels__gear=float(TICKS))
    found = run.odometry.stack("v_left", "v_right")
    assert found == pytest.approx(COURSE[1:, 1:3], abs=0.01)


def test_places_of_a_wrong_unit_are_no_run_of_the_few_rows_that_fit(tmp_path):
    bag = bag_of((["left_wheel", "right_wheel"], angles() * 90 + 0.3, None))
    with pytest.raises(BagError, match=r"\d\d % of the wheel speeds are impossible.*unit \(rad\)"):
        imported(tmp_path / "run", bag.write(tmp_path / "drive"))


def test_an_encoder_that_is_reset_is_no_speed(tmp_path):
    turned = angles()
    turned[80:] -= turned[80] + 1000
    bag = bag_of((["left_wheel", "right_wheel"], turned, None))
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert np.abs(run.odometry.stack("v_left", "v_right")).max() < 2
    assert len(run.odometry) == len(COURSE) - 2
    (line,) = said.losses
    assert "1 rows above 50 m/s are left out: between two messages a wheel turned" in line
    assert "Its encoder was reset, or the unit (rad) is wrong: see --unit" in line


def test_wheels_in_messages_of_their_own_are_named(tmp_path):
    front, rear = ["front_left_wheel", "front_right_wheel"], ["rear_left_wheel", "rear_right_wheel"]
    bag = bag_of((front, None, RATES), (rear, None, RATES), (["pan"], None, RATES[:, :1]))
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert len(run.odometry) == len(COURSE)
    first, second = said.losses
    assert "a message of other wheels (rear_left_wheel, rear_right_wheel)" in first
    assert second.endswith("160 messages dropped: a message without wheels")


def test_a_side_in_messages_of_its_own_is_named(tmp_path):
    bag = bag_of((["left_wheel"], None, RATES[:, :1]), (["right_wheel"], None, RATES[:, 1:]))
    with pytest.raises(BagError, match="left_wheel, right_wheel come in messages of their own"):
        imported(tmp_path / "run", bag.write(tmp_path / "drive"))


def test_an_encoding_that_is_not_read_says_a_way_out(tmp_path):
    bag = bag_of((["left_wheel", "right_wheel"], None, RATES))
    bag.image(1.0, np.zeros((4, 6), np.uint16), "mono16")
    _, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert any("'mono16', which is not read. Convert the images to" in one for one in said.losses)


@pytest.mark.parametrize(
    ("inverted", "words"),
    [
        (True, "no frames from map (parent) down to base_link (child): base_link is the parent of"),
        (False, "there are no moving frames from map (parent) down to base_link (child)"),
    ],
)
def test_transforms_that_do_not_lead_from_world_to_robot_are_named(inverted, words, tmp_path):
    bag = bag_of((["left_wheel", "right_wheel"], None, RATES))
    for t_s, _, _, x, y, yaw in COURSE:
        link = ("base_link", "map") if inverted else ("map", "odom")
        links = [bag.transform(t_s, *link, (x, y, 0), half_turn(yaw))]
        links += [bag.transform(t_s, "base_link", "imu_link", (0, 0, 0), (1, 0, 0, 0))]
        bag.transforms("/tf", t_s, links)
    path = bag.write(tmp_path / "drive")
    _, said = imported(tmp_path / "run", path, reference__topic="/tf")
    assert any(words in line for line in said.losses)
