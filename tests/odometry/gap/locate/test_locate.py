"""Planted excess in known regions is found, with its bounds; none is found where none is."""

import numpy as np
import pytest

from odometry.gap.config import GapConfig
from odometry.gap.locate.locate import locate
from odometry.gap.locate.region_words import noun_of, shown_unit, words_of

FLOOR_M = 0.0205  # of poses with 1 cm and 0.004 rad of noise over 2 s


def located(scenes, known):
    return locate(known.base, (), scenes, FLOOR_M, GapConfig(), calibration=known)


def slides(columns, twist):
    """Slides aside while it turns left with its nose up."""
    there = (columns["omega"] > 0.1) & (columns["pitch"] < -0.03)
    return twist + np.column_stack([0 * there, 0.15 * there, 0 * there])


@pytest.fixture(scope="module")
def sliding(make_scene, known):
    return located(tuple(make_scene(seed, slides) for seed in (20, 21, 22, 23)), known)


def test_a_planted_region_is_found(sliding):
    region = sliding.regions[0]
    assert set(region.bounds) == {"omega", "pitch"}
    low, high = region.bounds["omega"]
    assert high is None
    assert low == pytest.approx(0.1, abs=0.1)
    low, high = region.bounds["pitch"]
    assert low is None
    assert high == pytest.approx(-0.03, abs=0.03)
    assert region.words in {
        f"{a}, {b}"
        for a, b in [(x, y) for x in _turning() for y in _nose()]
        + [(y, x) for x in _turning() for y in _nose()]
    }
    assert region.share > 0.6
    # 0.15 m/s for most of 2 s, less where the window only grazes the region
    assert 0.1 < region.excess_m < 0.3


def _turning():
    return ["turning left", *(f"turning left faster than {n} degrees/s" for n in range(6, 12))]


def _nose():
    numbers = [f"{n / 100:g}" for n in range(57, 100)] + [f"{n / 10:g}" for n in range(10, 36)]
    return ["nose up", *(f"nose up more than {n} degrees" for n in numbers)]


def test_what_predicts_it_is_discovered(sliding):
    discovered = {one.name for one in sliding.predictors if one.discovered}
    assert {"omega", "pitch", "turn"} <= discovered
    assert set(sliding.strongest) == {"omega", "pitch"}
    order = [(not one.discovered, -one.strength) for one in sliding.predictors]
    assert order == sorted(order)


def test_shares_are_of_one_whole(sliding):
    shares = [region.share for region in sliding.regions]
    assert shares == sorted(shares, reverse=True)
    assert all(0 < share <= 1 for share in shares)
    assert sum(shares) <= 1 + 1e-12


def test_a_ground_is_a_region(make_scene, known):
    def terrain(t):
        return np.where((t // 25) % 2 == 1, "wet grass", "stone")

    def slips(columns, twist):
        return twist * np.where(columns["terrain"] == "wet grass", 0.6, 1.0)[:, None]

    found = located((make_scene(30, slips, terrain=terrain),), known)
    assert "terrain" in found.strongest
    on_grass = {"terrain=wet grass": (0.5, None)}.items()
    not_on_stone = {"terrain=stone": (None, 0.5)}.items()
    shares = {
        bool(on_grass & r.bounds.items() or not_on_stone & r.bounds.items()): r.share
        for r in found.regions
    }
    assert set(shares) == {True}
    assert any(word in found.regions[0].words for word in ("on wet grass", "not on stone"))


def test_a_gap_that_nothing_predicts_is_everywhere(make_scene, known):
    """The same slide at any time, in a direction drawn anew every half second."""

    def wanders(columns, twist):
        angle = np.random.default_rng(0).uniform(-np.pi, np.pi, 40)[
            (columns["t"] // 2).astype(int) % 40
        ]
        return twist + 0.1 * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])

    found = located((make_scene(40, wanders),), known)
    assert [(r.words, dict(r.bounds), r.share) for r in found.regions] == [("everywhere", {}, 1.0)]
    assert 0.05 < found.regions[0].excess_m < 0.2


@pytest.mark.slow
def test_no_region_without_a_gap(make_scene, known):
    found = [located((make_scene(seed),), known) for seed in range(50, 62)]
    assert sum(bool(one.regions) for one in found) <= 1
    assert all(len(one.strongest) == 2 for one in found)


def test_the_same_twice(make_scene, known):
    scenes = (make_scene(20, slides),)
    assert located(scenes, known) == located(scenes, known)


@pytest.mark.parametrize(
    ("bounds", "words"),
    [
        ({}, "everywhere"),
        (
            {"omega": (0.05, None), "pitch": (None, -0.052)},
            "turning left, nose up more than 3 degrees",
        ),
        ({"omega": (None, -0.5)}, "turning right faster than 29 degrees/s"),
        ({"omega": (-0.5, None)}, "not turning right faster than 29 degrees/s"),
        ({"omega": (None, 0.5)}, "not turning left faster than 29 degrees/s"),
        ({"omega": (None, 0.05)}, "turning right"),
        ({"omega": (0.5, 1.0)}, "turning left 29 to 57 degrees/s"),
        ({"omega": (-1.0, -0.5)}, "turning right 29 to 57 degrees/s"),
        ({"pitch": (-0.1, 0.2)}, "pitch between -5.7 and 11 degrees"),
        ({"roll": (0.1, None)}, "right side down more than 5.7 degrees"),
        ({"roll": (None, -0.1)}, "left side down more than 5.7 degrees"),
        ({"speed": (0.8, None)}, "speed above 0.8 m/s"),
        ({"speed": (None, 0.8)}, "speed below 0.8 m/s"),
        ({"time": (83.44, None)}, "run time after 83.4 s"),
        ({"heading": (0.5, 1.0)}, "heading between 28.6 and 57.3 degrees"),
        ({"terrain=wet grass": (0.5, None)}, "on wet grass"),
        ({"terrain=wet grass": (None, 0.5)}, "not on wet grass"),
        ({"speed_change": (0.3, None)}, "speeding up by more than 0.3 m/s"),
    ],
)
def test_words_of_bounds(bounds, words):
    assert words_of(bounds) == words


def test_every_variable_has_a_name(sliding):
    for one in sliding.predictors:
        assert "_" not in noun_of(one.name)
        assert (shown_unit(one.name)[0] == "") == (one.unit == "")
