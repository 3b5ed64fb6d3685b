"""The paper's switch: the covariance of the ICRs is reset, their means go on."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.estimation.config import PAPER, IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf, MeansKept
from odometry.recording.frames import Frame

WIDTH, SIGMA_WIDTHS = 0.5, 0.2
CONFIG = IcrEkfConfig(**PAPER, reset_sigma_widths=SIGMA_WIDTHS)


def frame(stamp_s, pose=None):
    speeds = np.array([0.4, 0.6])
    return Frame(stamp_s, speeds, 0, None if pose is None else np.array(pose), None)


@pytest.fixture
def learned():
    """Three seconds on ice, with poses of a robot that turns less than an ideal one."""
    ekf = MeansKept(IcrEkf(WIDTH, config=CONFIG))
    estimate = ekf.start(frame(0.0, [0.0, 0.0, 0.0]), "ice")
    for k in range(1, 31):
        yaw = 0.25 * 0.1 * k
        pose = [2.0 * np.sin(yaw), 2.0 * (1 - np.cos(yaw)), yaw]
        estimate = ekf.step(estimate, frame(0.1 * k, pose), "ice")
    return ekf, estimate


def test_the_icrs_go_on_and_their_covariance_is_the_papers(learned):
    ekf, on_ice = learned
    after = ekf.step(on_ice, frame(3.05), "mud")
    np.testing.assert_allclose(after.mean[3:6], on_ice.mean[3:6], atol=1e-12)
    reset = (SIGMA_WIDTHS * WIDTH) ** 2 * np.eye(3)
    np.testing.assert_allclose(after.covariance[3:6, 3:6], reset, rtol=1e-3)
    np.testing.assert_allclose(after.covariance[:3, 3:6], 0.0, atol=1e-12)
    assert after.terrain == "mud"


def test_what_was_learned_on_a_terrain_before_is_not_taken_up_again(learned):
    ekf, on_ice = learned
    on_mud = ekf.step(on_ice, frame(3.05), "mud")
    moved = on_mud.mean.copy()
    moved[3:6] = [0.5, -0.4, 0.1]
    back = ekf.step(replace(on_mud, mean=moved), frame(3.1), "ice")
    np.testing.assert_allclose(back.mean[3:6], [0.5, -0.4, 0.1], atol=1e-12)


def test_on_one_terrain_it_is_the_filter_itself(learned):
    ekf, on_ice = learned
    plain = IcrEkf(WIDTH, config=CONFIG)
    for one in (frame(3.05), frame(3.1, [1.4, 0.6, 0.78])):
        kept, own = ekf.step(on_ice, one, "ice"), plain.step(on_ice, one, "ice")
        np.testing.assert_array_equal(kept.mean, own.mean)
        np.testing.assert_array_equal(kept.covariance, own.covariance)
