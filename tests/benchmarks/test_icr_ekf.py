"""One step of the ICR filter, its record included, beside filterpy's own predict and update."""

import math

import numpy as np
import pytest
from filterpy.kalman import ExtendedKalmanFilter

from odometry.estimation.config import PAPER, IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.estimation.transition import STATES
from odometry.frames import Frame

SETTINGS = {"as it comes": {}, "as published": PAPER}


def step(with_gyroscope, settings):
    ekf = IcrEkf(0.6, config=IcrEkfConfig(**settings))
    rate = 0.02 if with_gyroscope else math.nan
    first, second = (
        Frame(0.05 * k, np.array([0.5, 0.6]), k, np.array([0.03 * k, 0.0, 1e-3 * k]), None)
        for k in range(2)
    )
    second = Frame(**{**vars(second), "yaw_rate_rad_s": rate})
    start = ekf.start(first, "a")
    return lambda: ekf.step(start, second, "a")


@pytest.mark.benchmark(group="one step with a pose")
@pytest.mark.parametrize("settings", SETTINGS.values(), ids=SETTINGS)
@pytest.mark.parametrize("with_gyroscope", [False, True], ids=["treads", "gyroscope"])
def test_a_step(benchmark, with_gyroscope, settings):
    after = benchmark(step(with_gyroscope, settings))
    assert after.innovation.accepted


@pytest.mark.benchmark(group="one step with a pose")
def test_filterpys_predict_and_update(benchmark):
    """Of as many states and a measurement of three; nothing is linearised."""
    ekf = ExtendedKalmanFilter(STATES, 3)
    ekf.x, ekf.R = np.zeros(STATES), 1e-3 * np.eye(3)
    jacobian, pose = np.eye(3, STATES), np.zeros(3)

    def predict_and_update():
        ekf.predict()
        ekf.update(pose, lambda _: jacobian, lambda x: x[:3])

    benchmark(predict_and_update)
    assert np.all(np.isfinite(ekf.x))
