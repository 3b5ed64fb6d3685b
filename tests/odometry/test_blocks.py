"""Long runs block by block give what they give at once, to the last bit."""

import numpy as np
import pytest

from odometry import blocks
from odometry.blocks import TOGETHER, blocks_of, running_sums
from odometry.dead_reckoning import dead_reckon


@pytest.mark.parametrize("count", [1, 2, TOGETHER, TOGETHER + 1, 2 * TOGETHER + 5])
def test_running_sums_are_those_of_one_sum(count, rng):
    steps = rng.normal(size=(count - 1, 2))
    found = list(running_sums(lambda some: steps[some].copy(), count))
    expected = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
    np.testing.assert_array_equal(np.concatenate([sums for _, sums in found]), expected)
    assert [rows for rows, _ in found] == list(blocks_of(count))
    assert found[-1][0].stop == count


def test_a_path_does_not_depend_on_the_length_of_the_blocks(rng, monkeypatch):
    stamps_s, twists = np.cumsum(rng.uniform(0.01, 0.03, 1000)), rng.normal(size=(1000, 3))
    whole = dead_reckon(stamps_s, twists, np.ones(3)).poses
    monkeypatch.setattr(blocks, "TOGETHER", 7)
    np.testing.assert_array_equal(dead_reckon(stamps_s, twists, np.ones(3)).poses, whole)
