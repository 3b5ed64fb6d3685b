"""How shares of time read."""

import pytest

from odometry.modes.words import percent


@pytest.mark.parametrize(
    ("share", "words"),
    [(0.984, "98 %"), (1.0, "100 %"), (-1e-16, "0 %"), (float("nan"), "-")],
)
def test_a_share_in_words(share, words):
    assert percent(share) == words
