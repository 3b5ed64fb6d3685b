"""From where on nothing fits: how limits follow from what was held out, and from the time."""

import numpy as np
import pytest

from odometry.feel.assessment.evidence import Stretches
from odometry.feel.assessment.limits import KNOWN_SHARE, Limits
from odometry.feel.classifier.strangeness import LENGTHS, Strangeness

COUNTS = {"window": 1.0, "stretch": 5.0, "run": 15.0}
BETWEEN, WITHIN = 1.0, 3.0  # variances of runs, and of independent windows of a run


def offsets_of(rng, count, windows, shift=0.0):
    """Offsets (N, 1, 3) of means over so many windows from one terrain."""
    size = np.sqrt(BETWEEN + WITHIN / windows)
    return shift + size * rng.normal(size=(count, 1, 3))


@pytest.fixture(scope="module")
def limits():
    rng, by_length = np.random.default_rng(0), {}
    for name, windows in COUNTS.items():
        offsets = offsets_of(rng, 4000, windows)
        rest = np.full(4000, windows), np.zeros((4000, 2)), np.ones(4000), offsets
        by_length[name] = Stretches(np.full(4000, "a", dtype=object), np.arange(4000), *rest)
    return Limits.of(by_length, np.array([0.2, 0.5]), 2.0)


def test_as_many_known_ones_are_refused_as_requested(limits):
    rng = np.random.default_rng(1)
    for name, windows in COUNTS.items():
        given = offsets_of(rng, 4000, windows)
        refused = limits.refused(np.full(4000, windows), np.ones(4000), given)
        assert refused.mean() == pytest.approx(1 - KNOWN_SHARE[name], abs=0.02)


@pytest.mark.parametrize("windows", [1.5, 2.0, 3.0])
def test_shorter_stretches_are_refused_as_rarely(limits, windows):
    given = offsets_of(np.random.default_rng(2), 4000, windows)
    refused = limits.refused(np.full(4000, windows), np.ones(4000), given)
    assert refused.mean() == pytest.approx(1 - KNOWN_SHARE["stretch"], abs=0.02)


def test_time_shows_what_one_window_does_not(limits):
    """A shift that hides in the spread of windows is beyond that of their means."""
    rng, found = np.random.default_rng(3), []
    for windows in COUNTS.values():
        given = offsets_of(rng, 4000, windows, shift=1.7)
        found.append(limits.refused(np.full(4000, windows), np.ones(4000), given).mean())
    assert found[0] < 0.5 < found[2]
    assert found[0] < found[1] < found[2]


def test_a_rare_terrain_that_feels_far_does_not_decide_how_far_is_far():
    """Of forty runs two are of a terrain whose runs lie far from each other."""
    labels = np.where(np.arange(40) < 2, "b", "a").astype(object)
    offsets = np.where(np.arange(40) < 2, 10.0, np.linspace(0.1, 2.0, 40))[:, None, None]
    rest = np.ones(40), np.zeros((40, 2)), np.ones(40), offsets
    one = Stretches(labels, np.arange(40), *rest)
    found = Limits.of(dict.fromkeys(LENGTHS, one), np.array([0.2, 0.5]), 2.0)
    expected = np.quantile(offsets**2, KNOWN_SHARE["run"])
    assert found.farness["run"] == pytest.approx(expected)
    assert expected < 4.0


def test_a_distance_in_all_columns_alone_refuses(limits):
    near = np.zeros((1, 1, 3))
    assert limits.refused(np.ones(1), np.full(1, 2.0), near)[0]
    assert not limits.refused(np.ones(1), np.ones(1), near)[0]


def test_odds_grow_with_the_distance_and_not_with_the_time(limits):
    weights = {name: np.array([-1.0, 0.7]) for name in LENGTHS}
    odds = [
        limits.log_odds(Strangeness(weights, 0.1), np.ones(1), np.full((1, 1, 3), size))[0]
        for size in (0.5, 1.0, 2.0)
    ]
    assert odds[1] - odds[0] == pytest.approx(0.7 * np.log(4))
    assert odds[2] - odds[1] == pytest.approx(0.7 * np.log(4))
    at = limits.at(limits.farness, np.array([1.0, 2.0, 5.0, 8.0]))
    assert (np.diff(at) <= 0).all()
    limit = np.sqrt(at / 3)[:, None, None] * np.ones((1, 1, 3))
    among = limits.log_odds(Strangeness(weights, 0.1), np.array([1.5, 2.0, 5.0, 8.0]), limit)
    assert among[2] == pytest.approx(among[3])
