"""Terrains with days of their own are noted: the day may be what distinguishes them."""

from odometry.feel.assessment.day_notes import notes_of_days
from odometry.feel.identify_feel import identify_feel
from tests.odometry.feel.feel_drives import drive
from tests.odometry.feel.recorded.test_whole_drives import later

DAY_S = 86_400.0
BEGAN_S = 20_000 * DAY_S


def test_terrains_that_share_a_day_are_not_noted():
    assert list(notes_of_days(["grass", "sand", "sand"], ["1", "1", "2"])) == []
    assert list(notes_of_days(["grass", "sand"], None)) == []
    assert list(notes_of_days(["grass", "sand", ""], ["1", "1", "2"])) == []


def test_a_terrain_with_days_of_its_own_is_noted():
    labels, days = ["grass", "grass", "sand", "snow", "snow"], ["1", "2", "3", "3", "4"]
    (note,) = notes_of_days(labels, days)
    assert note.startswith("No other terrain was recorded on the days of grass: ")


def test_every_terrain_has_a_day_of_its_own():
    (note,) = notes_of_days(["grass", "sand", "sand"], ["1", "2", "2"])
    assert "the days of grass, sand: " in note


def test_days_are_those_of_the_stamps():
    runs = [
        later(drive(name, 10 * i + j, seconds=10.0), BEGAN_S + i * DAY_S + 3600.0 * j)
        for i, name in enumerate(("tiles", "gravel"))
        for j in range(2)
    ]
    notes = identify_feel(runs).report["notes"]
    assert any("on the days of gravel, tiles" in note for note in notes)
