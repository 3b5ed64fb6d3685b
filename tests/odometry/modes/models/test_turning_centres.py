"""Turning centres by poses: what moves them, and what does not."""

import numpy as np
import pytest

from odometry.modes.models.traction import twists_of
from odometry.modes.models.turning_centres import centres, mean_centre_m, predicted_steps
from odometry.modes.recorded.measured_steps import step_windows
from odometry.modes.recorded.pose_steps import pose_steps
from tests.odometry.modes.checks.centre_examples import WIDTH, centre_run, centre_set


def found_of(run, ahead_m=0.0, until_s=np.inf):
    """Centres of windows of 16 s, and variances, against a mode that turns so far ahead."""
    modes = centre_set(ahead_m).modes
    signals = modes.signals(run)
    steps = pose_steps(signals.stamps_s, signals.measured[:, :3], signals.gaps_s)
    twists = twists_of(modes.gains[0], signals.tread_speeds_m_s, WIDTH)
    predicted = predicted_steps(steps, signals.stamps_s, twists, 0.0)
    windows = step_windows(steps.begin_s, steps.end_s, 16.0)
    centre_m = mean_centre_m(modes.gains[0], WIDTH)
    return centres(steps, predicted, centre_m, windows, steps.end_s < until_s)


@pytest.mark.parametrize(("left_m", "ahead_m"), [(0.0, 0.0), (0.08, 0.0), (0.0, -0.06)])
def test_a_centre_is_off_by_what_it_is(left_m, ahead_m):
    off_m, _ = found_of(centre_run(0.1 + ahead_m, left_m), ahead_m=0.1)
    np.testing.assert_allclose(off_m, np.tile([left_m, ahead_m], (len(off_m), 1)), atol=0.02)


@pytest.mark.parametrize(
    "errors",
    [{"lag_s": 0.3}, {"late_s": 0.6}, {"drift_m_s": 0.06}, {"slide_m": 0.15, "turn_s": 2.0}],
)
def test_what_is_late_or_drifts_moves_no_centre(errors):
    off_m, _ = found_of(centre_run(0.1, **errors), ahead_m=0.1)
    assert np.abs(off_m).max() < 0.02


def test_windows_in_which_poses_become_late_err_by_more():
    _, usual = found_of(centre_run())
    late_s = np.where(np.arange(2000) < 1000, 0.0, 0.6)
    off_m, variances = found_of(centre_run(late_s=late_s))
    assert variances.max() > 20 * usual.max()
    assert (off_m**2 < 9 * variances + 0.02**2).all()


def test_too_little_turn_determines_nothing():
    assert np.isnan(found_of(centre_run(), until_s=2.0)).all()


def test_steps_are_half_a_second_and_leave_gaps_out():
    stamps_s, poses = 0.1 * np.arange(100), np.zeros((100, 3))
    poses[30] = np.nan
    steps = pose_steps(stamps_s, poses, np.array([[5.0, 6.0]]))
    assert steps.lasts_s.min() == pytest.approx(0.5)
    assert steps.lasts_s.max() == pytest.approx(0.6)
    assert not ((steps.begin_s < 6.0 - 1e-9) & (steps.end_s > 5.0 + 1e-9)).any()
    assert not len(pose_steps(2 * stamps_s[::10], poses[::10], np.empty((0, 2))))
