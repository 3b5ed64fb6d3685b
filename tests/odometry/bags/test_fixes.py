"""Satellite fixes that are none, or of two receivers."""

import numpy as np
import pytest

from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, Bag, course

NORTH_DEG = 1 / 111_200  # of a metre, about 48 N


def drive():
    """A bag with wheels alone."""
    bag = Bag("mcap")
    for t_s, left, right, *_ in course(10.0):
        rates = [left / RADIUS_M, right / RADIUS_M]
        bag.joints(t_s, ["left_wheel", "right_wheel"], np.zeros(2), rates)
    return bag


@pytest.mark.parametrize("zeros", [range(5), range(40, 60)])
def test_zeros_of_a_receiver_without_a_fix_are_no_place(zeros, tmp_path):
    bag = drive()
    for number in range(100):
        place = (0.0, 0.0, 0.0) if number in zeros else (48 + number * NORTH_DEG, 11.0, 500.0)
        bag.fix(number / 10, *place)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert run.settings["source"]["origin"]["longitude"] == 11.0
    assert np.abs(run.pose["y"]).max() < 101
    assert len(run.pose) == 100 - len(zeros)
    words = f"{len(zeros)} messages dropped: no fix (latitude and longitude are zero)"
    assert any(words in line for line in said.losses)


def test_a_robot_on_the_equator_keeps_its_fixes(tmp_path):
    bag = drive()
    for number in range(100):
        bag.fix(number / 10, 0.0, 11 + number * NORTH_DEG, 0.0)
    run, _ = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert len(run.pose) == 100


def test_a_simulated_robot_at_zero_keeps_its_fixes(tmp_path):
    bag = drive()
    for number in range(100):
        bag.fix(number / 10, number * NORTH_DEG, 0.0, 0.0)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert len(run.pose) == 100
    assert not said.losses


def test_zeros_alone_are_no_reference(tmp_path):
    bag = drive()
    for number in range(100):
        bag.fix(number / 10, 0.0, 0.0, 0.0)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert not (run.folder / "pose.csv").exists()
    assert any("100 messages dropped: no fix" in line for line in said.losses)


def two_receivers():
    """The antenna on the right is a metre north of the left one; the first fix is none."""
    bag = drive()
    bag.fix(0.01, 0.5, 0.5, 0.0, status=-1, frame="gps_left")
    for number in range(100):
        frame, ahead = ("gps_left", 0) if number % 2 == 0 else ("gps_right", 1)
        bag.fix(0.02 + number / 10, 48 + (number + ahead) * NORTH_DEG, 11.0, 500.0, frame=frame)
    return bag


@pytest.mark.parametrize(("said", "other"), [("gps_left", "gps_right"), ("gps_right", "gps_left")])
def test_of_two_receivers_on_a_topic_one_is_taken(said, other, tmp_path):
    options = {} if said == "gps_left" else {"reference__frame": said}
    run, told = imported(tmp_path / "run", two_receivers().write(tmp_path / "drive"), **options)
    assert len(run.pose) == 50
    assert np.diff(run.pose["y"]) == pytest.approx(2, abs=0.01)
    words = f"50 messages dropped: of {other}, another receiver on this topic; {said} is taken"
    assert any(words in line for line in told.losses)


def test_a_frame_that_no_fix_names_is_the_antenna_of_all(tmp_path):
    bag = drive()
    for number in range(100):
        bag.fix(number / 10, 48 + number * NORTH_DEG, 11.0, 500.0)
    path = bag.write(tmp_path / "drive")
    run, told = imported(tmp_path / "run", path, reference__frame="mast")
    assert len(run.pose) == 100
    assert not told.losses


def test_places_beyond_the_poles_are_dropped(tmp_path):
    bag = drive()
    for number in range(100):
        latitude = 148.0 if number == 50 else 48 + number * NORTH_DEG
        bag.fix(number / 10, latitude, 11.0, 500.0)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert len(run.pose) == 99
    assert any("dropped: no place on Earth" in line for line in said.losses)


def test_a_height_that_is_not_measured_stays_empty(tmp_path):
    bag = drive()
    for number in range(100):
        bag.fix(number / 10, 48 + number * NORTH_DEG, 11.0, np.nan if number % 2 else 500.0)
    run, _ = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert np.isnan(run.pose["z"][1::2]).all()
    assert run.pose["z"][::2] == pytest.approx(0, abs=1e-3)
