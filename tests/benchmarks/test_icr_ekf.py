"""One step of the ICR filter, its record included, beside filterpy's own predict and update."""

import math

import numpy as np
import pytest
from filterpy.kalman import ExtendedKalmanFilter

from odometry.estimation.config import PAPER, IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.estimation.transition import STATES
from odometry.recording.frames import Frame

SETTINGS = {"as it comes": {}, "as published": PAPER}


def step(with_gyroscope, settings):
    """The third step of a filter: a pose and yaw rates came before."""
    ekf = IcrEkf(0.6, config=IcrEkfConfig(**settings))
    rates = np.array([math.nan, 0.021, 0.019, 0.02]) if with_gyroscope else [math.nan] * 4
    first, *others, last = (
        Frame(
            0.05 * k,
            np.array([0.5, 0.6]),
            k,
            np.array([0.03 * k, 0.0, 1e-3 * k]),
            None,
            yaw_rate_rad_s=float(rates[k]),
        )
        for k in range(4)
    )
    before = ekf.start(first, "a")
    for frame in others:
        before = ekf.step(before, frame, "a")
    return lambda: ekf.step(before, last, "a")


@pytest.mark.benchmark(group="one step with a pose")
@pytest.mark.parametrize("settings", SETTINGS.values(), ids=SETTINGS)
@pytest.mark.parametrize("with_gyroscope", [False, True], ids=["treads", "gyroscope"])
def test_a_step(benchmark, with_gyroscope, settings):
    after = benchmark(step(with_gyroscope, settings))
    assert after.innovation.accepted


@pytest.mark.benchmark(group="one step with a pose")
@pytest.mark.parametrize("with_gyroscope", [False, True], ids=["treads", "gyroscope"])
def test_filterpys_predict_and_update(benchmark, with_gyroscope):
    """Of as many states and a measurement of three; nothing is linearised.

    With a gyroscope a step has two updates, as its yaw rate is compared with that of the treads.
    """
    ekf = ExtendedKalmanFilter(STATES, 3)
    ekf.x, ekf.R = np.zeros(STATES), 1e-3 * np.eye(3)
    jacobian, pose = np.eye(3, STATES), np.zeros(3)
    rate, noise = np.zeros(1), 1e-3 * np.eye(1)

    def predict_and_update():
        ekf.predict()
        if with_gyroscope:
            ekf.update(rate, lambda _: jacobian[2:], lambda x: x[2:3], noise)
        ekf.update(pose, lambda _: jacobian, lambda x: x[:3])

    benchmark(predict_and_update)
    assert np.all(np.isfinite(ekf.x))
