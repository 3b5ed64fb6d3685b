"""The noise floor of calibration runs on other runs, beside what each kind of noise does there."""

from dataclasses import astuple, replace

import numpy as np
import pytest

from odometry.gap.config import GapConfig
from odometry.gap.prepare.statistic import Gap, floor_there
from odometry.windows.dense.dense_noise import Noise

FLOOR = Gap(0.03, 0.02, 0.05)


@pytest.fixture
def calibration(known):
    """A calibration that has one kind of noise alone."""

    def of(**noise):
        nothing = {"position_m": 0.0, "yaw_rad": 0.0, "wander_m": 0.0, "wander_rad": 0.0}
        return replace(known, noise=Noise(**{**nothing, **noise}))

    return of


def faster(known, factor):
    """The runs of the calibration with all ways so many times as long."""
    return [
        replace(s, travel_m=factor * s.travel_m, poses=s.poses * [factor, factor, 1])
        for _, s in known.held_back
    ]


@pytest.mark.parametrize(
    ("noise", "power"),
    [
        ({"position_m": 0.01}, 0.0),  # of the sensor, wherever it is
        ({"yaw_rad": 0.004}, 1.0),  # swings all that follows
        ({"wander_m": 0.02}, 0.5),  # adds up with travel
        ({"wander_rad": 0.02}, 1.5),  # adds up with travel, and swings what follows
    ],
)
@pytest.mark.parametrize("factor", [1.0, 4.0])
def test_the_floor_grows_with_the_way_as_its_noise_does(calibration, known, noise, power, factor):
    found = floor_there(FLOOR, calibration(**noise), faster(known, factor), GapConfig())
    np.testing.assert_allclose(astuple(found)[:3], np.array(astuple(FLOOR)[:3]) * factor**power)
    assert found.pieces == FLOOR.pieces


def test_the_floor_is_never_less_than_a_share_of_the_way(known):
    """Exact data are rounded, too: the root mean square of the way of each window."""
    scenes, exact = faster(known, 1.0), Gap(1e-9, 1e-10, 2e-9)
    ways_m = np.concatenate(
        [np.diff(np.interp(s.pose_s, s.time_s, s.travel_m)[s.windows[:, [0, -1]]]) for s in scenes]
    )
    least_m = GapConfig().least_floor * np.sqrt(np.mean(ways_m**2))
    found = floor_there(exact, known, scenes, GapConfig())
    np.testing.assert_allclose(astuple(found)[:3], least_m)


def test_more_windows_of_the_same_speed_change_nothing(calibration, known):
    """It is a mean over windows, of all runs."""
    scenes = 3 * faster(known, 1.0)
    assert astuple(
        floor_there(FLOOR, calibration(wander_m=0.02), scenes, GapConfig())
    ) == pytest.approx(astuple(FLOOR))


def test_kinds_of_noise_add_up_at_the_end_of_windows(known):
    """The first and the last pose are measured with noise, and all travel between adds to it."""
    ways_m = np.concatenate(
        [
            np.interp(s.pose_s[s.windows[:, -1]], s.time_s, s.travel_m)
            - np.interp(s.start_s, s.time_s, s.travel_m)
            for _, s in known.held_back
        ]
    )
    noise = Noise(0.01, 0.0, 0.02, 0.0)
    here, there = (2 * 0.01**2 + 0.02**2 * way_m for way_m in (ways_m.mean(), 4 * ways_m.mean()))
    found = floor_there(FLOOR, replace(known, noise=noise), faster(known, 4.0), GapConfig())
    np.testing.assert_allclose(found.value, FLOOR.value * np.sqrt(there / here))
