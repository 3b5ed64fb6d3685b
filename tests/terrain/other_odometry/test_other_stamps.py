"""Stamps of another program's poses, without files."""

import numpy as np
import pytest

from odometry.trajectory import Trajectory
from terrain.other_odometry.other_stamps import late_by_s

LATE_S = 0.4


def winding(rng, length_s, begins_s):
    """Poses whose turns never repeat, and the same with stamps that are late."""
    at_s, changes_s = np.arange(0.0, length_s, 0.05), np.arange(0.0, length_s + 2, 1.5)
    turn = np.interp(at_s, changes_s, rng.uniform(-0.8, 0.8, len(changes_s)))
    poses = np.column_stack([0 * at_s, 0 * at_s, np.cumsum(turn) * 0.05])
    return (Trajectory(begins_s + late_s + at_s, poses) for late_s in (LATE_S, 0.0))


@pytest.mark.parametrize("length_s", [25.0, 60.0], ids=["short", "long"])
def test_when_a_clock_began_does_not_matter(length_s):
    found = [
        late_by_s(*winding(np.random.default_rng(3), length_s, begins_s))
        for begins_s in (0.0, 1000.0)
    ]
    assert found == pytest.approx([LATE_S, LATE_S], abs=0.02)
    assert found[0] == pytest.approx(found[1], abs=1e-6)
