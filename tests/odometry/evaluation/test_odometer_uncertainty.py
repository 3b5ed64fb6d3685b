"""Where the covariance of a replay's odometer comes from."""

import numpy as np
import pytest

from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.evaluation.odometer_uncertainty import accepted_poses, odometer_uncertainty
from odometry.pipeline import ConstantTerrain, replay
from odometry.run import Run
from odometry.trajectory import Trajectory


def drive(make_run, seconds, *, pose=True, slip=1.0, outlier=None):
    """A straight drive of 1 m/s whose poses go `slip` as far, one of them far aside."""
    t = np.arange(0, seconds + 0.01, 0.2)
    odometry = "".join(f"{s:.1f},1,1\n" for s in t)
    poses = "".join(
        f"{s:.1f},{slip * s:.4f},{50 if k == outlier else 0},0\n" for k, s in enumerate(t)
    )
    folder = make_run(
        odometry="t,v_left,v_right\n" + odometry,
        **({"pose": "t,x,y,yaw\n" + poses} if pose else {}),
    )
    run = Run.read(folder)
    slip_as_given = IcrEkf(0.5, config=IcrEkfConfig(reset_sigma_alpha=0.0))
    return run, replay(run, slip_as_given, ConstantTerrain("a"))


def test_without_poses_it_is_the_filters_own(make_run):
    run, result = drive(make_run, 6, pose=False)
    found = odometer_uncertainty(run, result)
    assert found.noise is None
    assert "took in no pose" in found.source
    np.testing.assert_array_equal(found.covariances[-1], result.estimates[-1].covariance[:3, :3])
    assert found.checks == ()


def test_a_short_run_takes_usual_values_and_says_so(make_run):
    found = odometer_uncertainty(*drive(make_run, 6))
    assert "usual values" in found.source
    assert list(found.sigmas) == [5.0]
    assert found.sigmas[5.0][0] > 0.3


def test_it_is_measured_between_poses_and_grows_with_distance(make_run):
    found = odometer_uncertainty(*drive(make_run, 60, slip=0.97))
    assert "measured on" in found.source
    grown = np.sqrt(found.covariances[:, 0, 0])
    assert np.all(np.diff(grown) >= 0)
    assert found.sigmas[20.0][0] == pytest.approx(0.03 * 20, rel=0.15)
    np.testing.assert_allclose(
        found.covariances[0],
        drive(make_run, 60, slip=0.97)[1].estimates[0].covariance[:3, :3],
    )


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
