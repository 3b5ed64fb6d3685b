"""Poses that are stamped when they arrive: uneven stamps say by how much each is late."""

import numpy as np
import pytest

from odometry.effects.interface.recorded import Recorded
from odometry.effects.measurement.late_by_chance import LateByChance
from odometry.effects.measurement.pose_stamps import uneven_s
from tests.odometry.effects.reports import at_stamps

EVEN_S = np.arange(0.0, 60.0, 0.1)
INSIDE = slice(30, -30)


def test_the_share_of_each_lateness_comes_back_but_for_its_mean(rng):
    """The mean of 51 around each is known to a seventh of what one is late by chance."""
    late_s = rng.uniform(0.0, 0.09, len(EVEN_S))
    found_s = LateByChance().delay_s(np.array([1.0, 0.045]), EVEN_S + late_s)
    off_s = (found_s - late_s)[INSIDE]
    assert np.std(off_s) < 0.2 * np.std(late_s)
    assert abs(off_s.mean()) < 0.002


def test_stamps_of_an_even_clock_are_not_uneven_however_fast_it_runs():
    np.testing.assert_allclose(uneven_s(7.0 + 1.003 * EVEN_S), 0.0, atol=1e-9)
    assert len(uneven_s(np.empty(0))) == 0


@pytest.mark.parametrize(("most_s", "count"), [(0.0, 0), (0.02, 0), (0.08, 1)])
def test_it_is_a_candidate_where_stamps_are_uneven(bench, rng, most_s, count):
    stamps_s = EVEN_S + rng.uniform(0, most_s, len(EVEN_S))
    inputs = (bench.drive(rng),)
    recorded = Recorded(bench.base, inputs, ((1.0, 9.0),), reported=(at_stamps(stamps_s),))
    assert len(LateByChance.offered(recorded)) == count


def test_early_stamps_are_no_late_ones():
    assert LateByChance().is_meant(np.array([1.0, 0.0]))
    assert not LateByChance().is_meant(np.array([-0.5, 0.0]))
    assert not LateByChance().is_meant(np.array([0.57, 0.05]))


@pytest.mark.parametrize(
    ("offset_s", "words"),
    [(0.05, "arrive, all late, some later"), (-0.01, "arrive, some later"), (-0.1, "early")],
)
def test_stamps_are_called_as_late_or_early_as_they_are_in_the_mean(offset_s, words):
    assert words in LateByChance().in_words_at(np.array([1.0, offset_s]))
