"""A side that reads less at speed or backwards: an encoder that misses ticks, or terrain."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.treads.proportion import one_side_not_proportional
from odometry.checks.treads.side_changes import side_changes
from tests.odometry.checks.drives import PERIOD_S, drive
from tests.odometry.checks.faulty import put

COUNT = 3000
AT_S = PERIOD_S * np.arange(COUNT)


def weaving(speed_m_s, share=1.0):
    """150 s of speeds (COUNT,) and turns of all sizes."""
    turns = 0.3 * np.sin(AT_S / 2.1) + 0.1 * np.sin(AT_S / 0.9)
    return drive(speed_m_s * (1 + 0.05 * np.sin(AT_S)), share * turns)


def of_parts(values):
    """Values of equal parts of the time, one after the other."""
    return np.repeat(values, COUNT // len(values))


def on_terrains(run, left, right):
    """Both treads with slips of each part of the time."""
    slips = {"v_left": left, "v_right": right}
    slipping = {name: run.odometry[name] * of_parts(slip) for name, slip in slips.items()}
    return put(run, "odometry", **slipping)


@pytest.mark.parametrize(("share", "slip"), [(0.3, 0.06), (0.6, 0.1), (1.0, 0.1)])
def test_terrain_on_which_it_drives_fast_is_no_missed_ticks(share, slip):
    speeds = np.convolve(of_parts([0.3, 0.6, 1.0, 0.35, 0.65, 0.95]), np.ones(40) / 40, "same")
    left, right = ([1, 1, 1 + side * slip] * 2 for side in (1, -1))
    run = on_terrains(weaving(speeds, share), left, right)
    assert not one_side_not_proportional(Evidence(run))


@pytest.mark.parametrize("side", ["left", "right"])
def test_ticks_that_are_missed_at_speed_are_said(side):
    run = weaving(0.6 + 0.4 * np.sin(AT_S / 3.3))
    reads = run.odometry[f"v_{side}"]
    missing = put(run, "odometry", **{f"v_{side}": reads * (1 - 0.35 * reads / np.max(reads))})
    assert f"the {side} tread missed ticks" in one_side_not_proportional(Evidence(missing))


@pytest.mark.parametrize("slip", [0.5, 0.7])
def test_terrain_on_which_it_reverses_is_no_tread_that_differs_backwards(slip):
    back = of_parts([0, 0, 1]).astype(bool) & (np.sin(AT_S / 4) > -0.9)
    speeds = np.convolve(np.where(back, -0.6, 0.7), np.ones(20) / 20, "same")
    run = on_terrains(weaving(speeds), [1, 1, 1], [1, 1, slip])
    assert not side_changes(Evidence(run))
