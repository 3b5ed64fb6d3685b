"""Where the covariance of a replay's odometer comes from."""

import numpy as np
import pytest

from odometry.estimation.icr_ekf import IcrEkf
from odometry.evaluation.odometer_uncertainty import accepted_poses, odometer_uncertainty
from odometry.recording.run import Run
from odometry.replays.pipeline import ConstantTerrain, replay
from odometry.trajectory import Trajectory


def drive(make_run, seconds, *, pose=True, slip=None, outlier=None):
    """A straight drive of 1 m/s whose steps of 0.2 m slip by some metres, a pose far aside."""
    t = np.arange(0, seconds + 0.01, 0.2)
    x = t + (0.0 if slip is None else np.cumsum(slip[: len(t)]))
    odometry = "".join(f"{s:.1f},1,1\n" for s in t)
    poses = "".join(f"{s:.1f},{x[k]:.4f},{50 if k == outlier else 0},0\n" for k, s in enumerate(t))
    folder = make_run(
        odometry="t,v_left,v_right\n" + odometry,
        **({"pose": "t,x,y,yaw\n" + poses} if pose else {}),
    )
    run = Run.read(folder)
    return run, replay(run, IcrEkf(0.5), ConstantTerrain("a"))


def test_without_poses_it_is_that_of_other_recordings_and_of_unknown_parameters(make_run):
    """Straight ahead: sources per radian add nothing, and only alpha_left + alpha_right count.

    x: random .19^2 a metre and constant .06^2 a square metre, both twice, and the slip factors.
    """
    run, result = drive(make_run, 6, pose=False)
    found = odometer_uncertainty(run, result)
    assert found.poses == 0
    assert "took in no pose" in found.source
    slip = sum(np.mean(result.sigmas_of(slice(7 + side, 8 + side))) ** 2 for side in (0, 1)) / 4
    expected = 2 * (0.19**2 * 6 + 0.06**2 * 36) + slip * 36
    start = result.estimates[0].covariance[0, 0]
    assert found.covariances[-1][0, 0] - start == pytest.approx(expected, rel=0.02)
    assert found.checks == ()


def test_a_short_run_takes_usual_values_and_says_so(make_run):
    found = odometer_uncertainty(*drive(make_run, 6))
    assert "usual values" in found.source
    assert list(found.sigmas) == [5.0]
    assert found.sigmas[5.0][0] > 0.3


def test_it_is_measured_between_poses_and_grows_with_distance(make_run, rng):
    """5 cm a step of 0.2 m: 0.5 m after 20 m, as far as 60 m determine it."""
    run, result = drive(make_run, 60, slip=rng.normal(0, 0.05, 301))
    found = odometer_uncertainty(run, result)
    assert "measured on" in found.source
    grown = np.sqrt(found.covariances[:, 0, 0])
    assert np.all(np.diff(grown) >= 0)
    assert found.sigmas[20.0][0] == pytest.approx(0.5, rel=0.4)
    np.testing.assert_allclose(found.covariances[0], result.estimates[0].covariance[:3, :3])


def test_a_refused_pose_measures_nothing(make_run):
    run, result = drive(make_run, 20, outlier=40)
    rows, poses = accepted_poses(run, result)
    assert 40 not in rows
    assert np.abs(poses[:, 1]).max() < 1


def test_the_truth_checks_and_measures_nothing(make_run):
    run, result = drive(make_run, 60)
    stamps_s = np.arange(0, 60.1, 0.5)
    aside = Trajectory(stamps_s, np.column_stack([0.9 * stamps_s, 0 * stamps_s, 0 * stamps_s]))
    with_truth, without = (
        odometer_uncertainty(run, result, aside),
        odometer_uncertainty(run, result),
    )
    np.testing.assert_array_equal(with_truth.covariances, without.covariances)
    assert not with_truth.checks[0].is_consistent
