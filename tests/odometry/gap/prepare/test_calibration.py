"""The model of the calibration: as near to the true robot as its information says."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from odometry.errors import GapError
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import calibrated
from odometry.models.icr import Icr
from odometry.models.symmetric import DifferentialDrive, IcrSymmetric
from odometry.windows.dense.dense import dense_windows_of

TRUE = np.array([0.45, -0.42, 0.02, 1.0, 1.0, 0.0])  # the robot of the scenes; no latency
SEEDS = range(600, 608)


@pytest.fixture(scope="module")
def calibrate(make_scene):
    def run(*seeds, late_s=0.0, duration_s=80.0, model=None, given=None):
        runs = [make_scene(seed, duration_s=duration_s, top_m_s=0.5).run for seed in seeds]
        late = [
            replace(r, pose=replace(r.pose, columns={**r.pose.columns, "t": r.pose["t"] + late_s}))
            for r in runs
        ]
        scenes = [dense_windows_of(one, GapConfig().horizon_s) for one in late]
        return calibrated(scenes, model or Icr(), runs[0].robot, GapConfig(), given)

    return run


@pytest.fixture(scope="module")
def each(calibrate):
    return [calibrate(seed) for seed in SEEDS]


def test_values_are_as_far_from_the_true_ones_as_the_information_says(each):
    """Their squared distances in its measure are chi-squared of six each; 99.9 % of the sum."""
    distances = [
        (known.uncertain.values - TRUE) @ known.information @ (known.uncertain.values - TRUE)
        for known in each
    ]
    low, high = chi2.ppf([5e-4, 1 - 5e-4], 6 * len(each))
    assert low < sum(distances) < high
    sigmas = np.sqrt(np.diag(np.linalg.inv(each[0].information)))
    assert (sigmas < [0.02, 0.02, 0.02, 0.02, 0.02, 0.02]).all()


def test_the_noise_is_that_of_the_poses(each):
    """1 cm and 0.004 rad, and motion that does not wander."""
    found = np.array([np.sqrt(known.noise.variances) for known in each])
    np.testing.assert_allclose(found[:, :2].mean(axis=0), [0.01, 0.004], rtol=0.05)
    half_a_metre = 0.5  # of travel in a window: wander adds less than a pose's own noise
    assert (found[:, 2:] * np.sqrt(half_a_metre) < found[:, :2]).all()


def test_a_constant_delay_of_the_record_is_the_latency(calibrate):
    known = calibrate(600, late_s=0.08)
    sigma = np.sqrt(np.linalg.inv(known.information)[-1, -1])
    assert known.base.latency_s == pytest.approx(0.08, abs=4 * sigma)
    assert sigma < 0.01


def test_another_model_is_calibrated_in_the_same_way(calibrate):
    known = calibrate(600, model=IcrSymmetric())
    assert known.base.values[1] == pytest.approx(0.87, abs=0.03)
    assert known.information.shape == (3, 3)


def test_given_values_are_believed_as_they_are(calibrate):
    given = {"y_left": 0.5, "y_right": -0.5, "x_icr": 0.0, "alpha_left": 1.0, "alpha_right": 1.0}
    known = calibrate(600, given=given)
    np.testing.assert_array_equal(known.base.values, [0.5, -0.5, 0.0, 1.0, 1.0])
    assert known.uncertain.names == ("latency",)
    assert known.information.shape == (1, 1)
    identified = calibrate(600)
    assert known.noise == identified.noise
    assert len(known.held_back) == len(identified.held_back) == GapConfig().held_back


def test_the_latency_of_the_recordings_is_none_that_a_set_lacks(calibrate):
    """A set says nothing of it, and without it a robot that follows late lacked an effect."""
    names = ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right")
    given = dict(zip(names, TRUE[:5].tolist(), strict=True))
    known = calibrate(600, late_s=0.08, given=given)
    sigma = np.sqrt(np.linalg.inv(known.information)[-1, -1])
    assert known.base.latency_s == pytest.approx(0.08, abs=4 * sigma)
    assert sigma < 0.01


def test_noise_is_that_of_what_is_given_of_the_robot_itself(calibrate):
    """An ideal drive as wide as the robot turns: its own width of run.toml is no noise."""
    noise = {
        width: calibrate(600, model=DifferentialDrive(), given={"track_width": width}).noise
        for width in (0.87, 0.55)
    }
    assert noise[0.87].wander_rad < 0.1 * noise[0.55].wander_rad


def test_every_window_is_held_back_once_with_a_base_of_the_others(each):
    known = each[0]
    starts = np.concatenate([scene.start_s for _, scene in known.held_back])
    assert len(np.unique(starts)) == len(starts) == 39
    values = np.array([base.values for base, _ in known.held_back])
    assert len(np.unique(values, axis=0)) == len(known.held_back)
    sigmas = np.sqrt(np.diag(np.linalg.inv(known.information)))[:5]
    assert (np.abs(values - known.base.values) < 4 * sigmas).all()
    for _, scene in known.held_back:
        assert len(np.unique(np.floor(scene.start_s / 10.0) % GapConfig().held_back)) == 1


def test_too_short_a_calibration_is_refused(calibrate):
    with pytest.raises(GapError, match=r"14 windows of 2 s in the calibration runs.*20 or more"):
        calibrate(600, duration_s=30.0)
    assert len(calibrate(600, 601, duration_s=30.0).held_back) >= 4
