"""Errors of windows as variances of twists and poses, by robots that err in one known way."""

import numpy as np
import pytest

from odometry.export.drive_numbers import MotionErrors, Pace
from odometry.windows.window_errors import WindowErrors

PACE = Pace(wheel_speed_m_s=0.8, yaw_rate_rad_s=0.3)


def test_means_and_windows_of_normal_errors_give_the_same(rng):
    along, across, yaw = rng.normal(size=(3, 40_000)) * np.array([[0.03], [0.03], [0.02]])
    windows = WindowErrors(np.hypot(along, across), np.abs(yaw))
    of_windows = MotionErrors.of_windows(windows, 5.0, "")
    of_means = MotionErrors.of_means(
        float(windows.translation_per_m.mean()), float(windows.rotation_per_m.mean()), 5.0, ""
    )
    for found in (of_windows, of_means):
        assert found.along_m_per_m == pytest.approx(0.03, rel=0.02)
        assert found.yaw_rad_per_m == pytest.approx(0.02, rel=0.02)


def test_a_constant_error_is_the_deviation_of_the_twist():
    """Wheels of unknown scale: 2 % of deviation, at 0.8 m/s 16 mm/s; and what is left out."""
    errors = MotionErrors(0.02, 0.01, 5.0, "")
    found = errors.twist_variances(PACE, (0.1, -0.2))
    expected = [0.016**2 + 0.03**2, 0.016**2 + 0.06**2, 0.008**2]
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_independent_errors_grow_the_pose_as_stated(rng):
    """A random walk of 1 cm per root of a metre: its spread after 100 s at 0.8 m/s is known."""
    steps = 0.01 * np.sqrt(0.04) * rng.normal(size=(4000, 2000))  # of 4 cm each
    of_window = steps[:, :125].sum(axis=1) / 5.0  # per metre, over 5 m
    errors = MotionErrors(float(of_window.std()), 0.0, 5.0, "")
    grown = 100.0 * errors.pose_variances_per_s(PACE)[0]
    assert grown == pytest.approx(steps.sum(axis=1).var(), rel=0.1)
