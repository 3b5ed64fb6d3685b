"""A base that moves beyond its calibration, and what explains that."""

from types import SimpleNamespace

import pytest

from odometry.gap.config import GapConfig
from odometry.gap.search import Search

FREE = 8  # numbers of a base: a chi-squared of 26 is beyond 99.9 %


def moved(chi_squared):
    return SimpleNamespace(base_alone=chi_squared)


@pytest.mark.parametrize(
    ("after", "before", "is_above", "closes", "explained"),
    [
        (1.0, 27.0, True, True, True),
        (10.0, 27.0, True, True, False),  # a third of the move is left
        (1.0, 25.0, True, True, False),  # as its calibration allows
        (1.0, 27.0, False, True, False),
        (1.0, 27.0, True, False, False),
    ],
)
def test_a_move_is_explained_by_what_brings_the_base_back(
    after, before, is_above, closes, explained
):
    """Where it closes a gap on held-out data that is surely there."""
    known = SimpleNamespace(uncertain=SimpleNamespace(values=[0.0] * FREE))
    fitter = SimpleNamespace(calibration=known)
    search = Search(fitter, moved(before), (), None, None, GapConfig(), lambda: None)
    search.__dict__.update(is_above=is_above, base_closes=closes)
    assert search.explains_move(moved(after), moved(before)) == explained
