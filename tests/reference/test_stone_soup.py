"""The ICR filter's steps against Stone Soup's extended Kalman filter.

Stone Soup differentiates the motion numerically; the motion is given to it as fine midpoint steps.
"""

import datetime as dt

import numpy as np
import pytest

from odometry.estimation.config import PAPER, IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.frames import Frame

pytest.importorskip("stonesoup", reason="Stone Soup is not installed: it is in the extra `test`")

from stonesoup.base import Property
from stonesoup.models.base import TimeVariantModel
from stonesoup.models.measurement.linear import LinearGaussian
from stonesoup.models.transition.base import TransitionModel
from stonesoup.models.transition.nonlinear import GaussianTransitionModel
from stonesoup.predictor.kalman import ExtendedKalmanPredictor
from stonesoup.types.detection import Detection
from stonesoup.types.hypothesis import SingleHypothesis
from stonesoup.types.state import GaussianState
from stonesoup.updater.kalman import ExtendedKalmanUpdater

WIDTH = 0.5
POSITION_NOISE = 0.03
R = np.diag([0.02**2, 0.02**2, 0.01**2])
START = dt.datetime(2023, 10, 11, tzinfo=dt.UTC)
SUBSTEPS = 100


class IcrMotion(GaussianTransitionModel, TransitionModel, TimeVariantModel):
    """The state (x, y, yaw, y_left, y_right, x_icr) at held tread speeds, by fine midpoints."""

    speeds: tuple = Property(doc="Left and right tread speed, m/s.")

    @property
    def ndim_state(self):
        return 6

    def function(self, state, noise=False, time_interval=None, **_):
        assert not noise
        x = np.array(state.state_vector, dtype=float)
        step_s = time_interval.total_seconds() / SUBSTEPS
        v_left, v_right = self.speeds
        for _ in range(SUBSTEPS):
            omega = (v_right - v_left) / (x[3] - x[4])
            v_x, v_y = v_left + omega * x[3], -omega * x[5]
            middle = x[2] + omega * step_s / 2
            x[0] += (v_x * np.cos(middle) - v_y * np.sin(middle)) * step_s
            x[1] += (v_x * np.sin(middle) + v_y * np.cos(middle)) * step_s
            x[2] += omega * step_s
        return x

    def covar(self, time_interval, **_):
        return np.diag([POSITION_NOISE**2] * 2 + [0.0] * 4) * time_interval.total_seconds()


def test_a_hundred_steps_agree(rng):
    """Stone Soup's forward differences of about 1e-8 limit the agreement, to 1e-4 sigma."""
    table = TerrainParameters("icr", {"y_left": 0.45, "y_right": -0.35, "x_icr": 0.08})
    config = IcrEkfConfig(
        **PAPER,
        position_sigma_m=0.02,
        yaw_sigma_rad=0.01,
        position_noise=POSITION_NOISE,
        yaw_noise=0.0,
        icr_noise_widths=0.0,
        gate_probability=1.0,
    )
    ekf = IcrEkf(WIDTH, ParameterSet({"a": table}), config)
    speeds = rng.uniform(-1, 1, 2)
    ours = ekf.start(Frame(0.0, speeds, 0, np.zeros(3), None), "a")
    theirs = GaussianState(ours.mean[:6], ours.covariance[:6, :6], timestamp=START)
    measurement = LinearGaussian(ndim_state=6, mapping=(0, 1, 2), noise_covar=R)
    updater = ExtendedKalmanUpdater(measurement, force_symmetric_covariance=True)
    for k in range(1, 101):
        stamp = START + dt.timedelta(seconds=0.1 * k)
        predictor = ExtendedKalmanPredictor(IcrMotion(speeds=tuple(speeds)))
        prediction = predictor.predict(theirs, timestamp=stamp)
        pose = np.asarray(prediction.state_vector, dtype=float).ravel()[:3]
        pose = pose + rng.normal(0, [0.02, 0.02, 0.01])
        detection = Detection(pose, timestamp=stamp, measurement_model=measurement)
        theirs = updater.update(SingleHypothesis(prediction, detection))
        speeds = rng.uniform(-1, 1, 2)
        ours = ekf.step(ours, Frame(0.1 * k, speeds, k, pose, None), "a")
        sigma = np.sqrt(np.diag(np.asarray(theirs.covar, dtype=float)))
        error = ours.mean[:6] - np.asarray(theirs.state_vector, dtype=float).ravel()
        error[2] = np.angle(np.exp(1j * error[2]))
        assert np.all(np.abs(error) < 1e-4 * sigma)
        difference = ours.covariance[:6, :6] - np.asarray(theirs.covar, dtype=float)
        assert np.all(np.abs(difference) < 1e-4 * np.outer(sigma, sigma))
