"""When vision counts, and how much."""

import numpy as np
import pytest

from odometry.errors import ParameterError, RunFolderError
from odometry.modes.follow.camera_prior import (
    BLIND_LENGTHS,
    PULLED_S,
    SeenTerrain,
    mode_chains,
    seen_labels,
    seen_terrains,
)
from tests.odometry.modes.mode_examples import run_of

HEADER = "t,label,confidence,distance_ahead\n"
NAMES = ("ice", "mud", "tar")


@pytest.fixture
def seen(tmp_path):
    """What a terrain.csv of these rows says of a robot at 0.5 m/s and 0.8 m long."""

    def read(rows, header=HEADER):
        file = tmp_path / "terrain.csv"
        file.write_text(header + "\n".join(rows) + "\n")
        return seen_terrains(file, run_of(1.0))

    return read


def test_a_label_counts_when_the_wheels_are_there(seen):
    """At 0.5 m/s a place 1 m ahead is reached 2 s later."""
    one, blind = seen(["1,ice,0.7,1.0"])
    assert (one.label, one.confidence, blind.label) == ("ice", 0.7, "unknown")
    assert one.stamp_s == pytest.approx(1.0 + 1.0 / 0.5, abs=0.021)
    assert blind.stamp_s - one.stamp_s == pytest.approx(BLIND_LENGTHS * 0.8 / 0.5, abs=0.021)


def test_places_that_overlap_one_of_the_same_label_are_not_news(seen):
    found = seen(["0,ice,0.7,1.0", "1.0,ice,0.9,1.0", "1.8,ice,0.8,1.0", "2,mud,0.8,1.0"])
    assert [(one.label, one.confidence) for one in found] == [
        ("ice", 0.7),
        ("ice", 0.8),
        ("mud", 0.8),
    ]


def test_without_a_sight_for_long_the_camera_is_blind(seen):
    found = seen(["0,ice,0.7,0.1", "6,ice,0.9,0.1"])
    assert [one.label for one in found] == ["ice", "unknown", "ice"]


def test_what_says_nothing_or_is_never_reached_is_left_out(seen):
    rows = ["0,,,", "0.2,unknown,0.9,1", "0.4,ice,0.9,", "0.6,ice,0.9,100"]
    assert seen(rows) == ()
    assert seen(["0,,,1", "1,,,1"]) == ()


def test_a_nearer_place_seen_later_counts_first(seen):
    found = seen(["0,ice,0.7,2.0", "0.5,mud,0.9,0.2"])
    assert [one.label for one in found][:2] == ["mud", "ice"]
    stamps_s = np.array([0.0, 1.5, 4.5])
    assert seen_labels(found, stamps_s).tolist() == ["unknown", "mud", "ice"]


def test_a_file_of_something_else_is_reported(seen):
    with pytest.raises(RunFolderError, match=r"terrain\.csv: the column 'distance_ahead'"):
        seen(["0,ice,0.9"], "t,label,confidence\n")


def test_a_certain_sight_pulls_all_modes_within_its_time():
    """A chain of two exponential clocks: a mode without a label is left at both rates together."""
    dwell_s = np.array([10.0, 20.0, 40.0])
    usual, pulled = mode_chains((SeenTerrain(3.0, "mud", 1.0),), NAMES, dwell_s)
    np.testing.assert_allclose(np.diag(usual.rates), -1 / dwell_s)
    from_ice, from_mud, from_tar = pulled.rates
    assert from_ice == pytest.approx([-0.1 - 1 / PULLED_S, 0.05 + 1 / PULLED_S, 0.05])
    assert from_tar == pytest.approx([0.0125, 0.0125 + 1 / PULLED_S, -0.025 - 1 / PULLED_S])
    np.testing.assert_allclose(from_mud, usual.rates[1], atol=1e-15)


def test_a_source_no_surer_than_chance_pulls_nothing():
    dwell_s = np.full(3, 20.0)
    seen = (SeenTerrain(0.0, "mud", 1 / 3), SeenTerrain(1.0, "unknown", 1.0))
    usual, by_chance, unknown = mode_chains(seen, NAMES, dwell_s)
    np.testing.assert_allclose(by_chance.rates, usual.rates, atol=1e-15)
    np.testing.assert_array_equal(unknown.rates, usual.rates)
    doubtful = mode_chains((SeenTerrain(0.0, "mud", 2 / 3),), NAMES, dwell_s)[1]
    assert doubtful.rates[0, 1] == pytest.approx(0.025 + 0.5 / PULLED_S)


def test_one_mode_alone_is_never_left():
    (_, one) = mode_chains((SeenTerrain(0.0, "ice", 0.9),), ("ice",), np.array([5.0]))
    assert not one.rates.any()


@pytest.mark.parametrize(
    ("one", "message"),
    [
        (SeenTerrain(3.0, "sand", 0.9), "at 3 s, which is no mode; expected one of ice, mud"),
        (SeenTerrain(3.0, "ice", 1.5), "confidence 1.5 at 3 s, expected 0 to 1"),
        (SeenTerrain(3.0, "ice", float("nan")), "confidence nan"),
    ],
)
def test_what_cannot_be_weighed_is_reported(one, message):
    with pytest.raises(ParameterError, match=message):
        mode_chains((one,), NAMES, np.full(3, 20.0))
