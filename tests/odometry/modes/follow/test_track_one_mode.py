"""Modes of one terrain against a Kalman filter that is written out."""

import numpy as np

from odometry.modes.follow.track import follow_signals
from odometry.modes.models.mode_set import ModeSet
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.recorded.bank_inputs import BIAS_SIGMA_RAD_S, BIAS_WALK_RAD2_S3, Signals
from tests.odometry.modes.follow.test_track import A, B
from tests.odometry.modes.mode_drives import integrated


def test_one_mode_is_a_kalman_filter():
    """Uneven steps, inputs held from stamp to stamp, entries not measured, treads that stood."""
    rng = np.random.default_rng(8)
    stamps_s = np.cumsum(np.round(rng.uniform(0.01, 0.1, 60), 3))
    treads, z = rng.normal(size=(60, 2)), rng.normal(size=(60, 2))
    z[10], z[20, 0], z[30, 1] = np.nan, np.nan, np.nan
    treads[40] = 0.0
    process, noise = np.array([0.02, 0.05]), np.array([0.6, 0.5])
    one = VelocityModes(("mud",), A[:1], B[:1], process[None], noise[None])
    labels = np.full(60, "mud", dtype=object)
    track = follow_signals(Signals(stamps_s, treads, z, labels), ModeSet(one, np.array([5.0])))
    mean = np.array([treads[0].mean(), z[0, 1], 0.0])
    P = np.diag([0.25, 0.25, BIAS_SIGMA_RAD_S**2])
    seen = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 1.0]])
    for row in range(1, 60):
        lasts_s, u = stamps_s[row] - stamps_s[row - 1], treads[row - 1]
        F = np.eye(3)
        F[:2, :2] = integrated(lambda q: A[0] @ q, np.eye(2), lasts_s, 50)
        mean[:2] = integrated(lambda q, u=u: A[0] @ q + B[0] @ u, mean[:2], lasts_s, 50)
        P = F @ P @ F.T + lasts_s * np.diag([*process, BIAS_WALK_RAD2_S3])
        there = np.isfinite(z[row]) & (row != 41)
        H = seen[there]
        S = H @ P @ H.T + np.diag(noise[there])
        left = z[row][there] - H @ mean
        squared = left @ np.linalg.solve(S, left) / len(H) if len(H) else np.nan
        gain = P @ H.T @ np.linalg.inv(S)
        mean, P = mean + gain @ left, P - gain @ H @ P
        np.testing.assert_allclose(track.means[row], mean, atol=1e-7)
        np.testing.assert_allclose(track.sigmas[row], np.sqrt(np.diag(P)), atol=1e-7)
        np.testing.assert_allclose(track.normalised_squared[row], squared, rtol=1e-5)
    assert np.isnan(track.normalised_squared[[0, 10, 41]]).all()
