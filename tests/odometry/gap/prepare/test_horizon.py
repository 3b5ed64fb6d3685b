"""Windows are as long as usual unless poses are chained in stretches into which they do not fit."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.gap.config import GapConfig
from odometry.gap.prepare.scenes import for_chains, scene_of


@pytest.mark.parametrize(
    ("chain_s", "horizon_s"), [(None, 2.0), (2.4, 2.0), (1.6, 1.5), (1.2, 1.0)]
)
def test_the_duration_of_windows(make_scene, chain_s, horizon_s):
    run = make_scene(3, duration_s=60.0).run
    if chain_s is not None:
        numbers = np.floor(run.pose.stamps_s / chain_s + 1e-6)
        run = replace(run, pose=replace(run.pose, columns={**run.pose.columns, "window": numbers}))
    assert for_chains(GapConfig(), [run]).horizon_s == horizon_s


def test_of_many_poses_some_are_used_and_windows_stay(make_scene):
    def same(_, twist):
        return twist

    run = make_scene(3, same, duration_s=60.0).run
    config = GapConfig()
    usual = scene_of(run, config)
    few = scene_of(run, replace(config, most_poses=5))
    assert usual.windows.shape[1] == 11  # poses at 5 Hz: all of them
    assert few.windows.shape[1] == 6
    np.testing.assert_array_equal(few.windows[:, [0, -1]], usual.windows[:, [0, -1]])
    assert len(few.time_s) <= len(usual.time_s)
