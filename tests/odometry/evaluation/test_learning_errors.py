"""What parameters that are not yet known do to an odometer, against odometers that hold others."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.estimation.icr_ekf import IcrEkf
from odometry.estimation.transition import STATES, Y_LEFT
from odometry.evaluation.learning_covariances import learning_covariances, parameter_covariances
from odometry.evaluation.odometer_uncertainty import path_of
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.run import Run
from odometry.replays.pipeline import ConstantTerrain, replay

STEP = 1e-6
CHANGED = 40  # of 101 estimates: fewer than half, so that the median variance is 0


@pytest.fixture(params=[True, False], ids=["gyroscope", "treads"])
def winding(request, make_run):
    """A replay without poses of a robot that winds about, with or without gyroscope."""
    t = np.arange(0, 5.01, 0.05)
    left, right = 0.8 + 0.3 * np.sin(t), 0.8 + 0.3 * np.cos(1.7 * t)
    rate = (right - left) / 0.9 + 0.01
    rows = (
        f"{a},{b},{c},{d}\n" if request.param else f"{a},{b},{c}\n"
        for a, b, c, d in zip(t, left, right, rate, strict=True)
    )
    header = "t,v_left,v_right,gyro_z\n" if request.param else "t,v_left,v_right\n"
    run = Run.read(make_run(odometry=header + "".join(rows)))
    table = TerrainParameters("icr", {"y_left": 0.5, "y_right": -0.4, "x_icr": 0.1})
    result = replay(run, IcrEkf(0.6, ParameterSet({"a": table})), ConstantTerrain("a"))
    assert result.has_gyroscope == request.param
    return result


def with_estimates(result, change):
    return replace(
        result, estimates=tuple(change(k, estimate) for k, estimate in enumerate(result.estimates))
    )


@pytest.mark.parametrize("state", range(Y_LEFT, STATES))
def test_a_parameter_that_is_unsure_at_first_moves_the_odometer_as_another_one_would(
    winding, state
):
    def unsure(k, estimate):
        covariance = np.zeros((STATES, STATES))
        covariance[state, state] = 1.0 if k < CHANGED else 0.0
        return replace(estimate, covariance=covariance)

    def other(k, estimate):
        mean = estimate.mean.copy()
        mean[state] += STEP * (k < CHANGED)
        return replace(estimate, mean=mean)

    (of_all,) = learning_covariances(with_estimates(winding, unsure), path_of(winding))
    found = of_all[-1]
    ends = [each.odometer().poses[-1] for each in (winding, with_estimates(winding, other))]
    slope = (ends[1] - ends[0]) / STEP
    np.testing.assert_allclose(found, np.outer(slope, slope), rtol=5e-3, atol=5e-3)


def test_what_is_as_sure_as_ever_adds_nothing(winding):
    def alike(_, estimate):
        return replace(estimate, covariance=0.01 * np.eye(STATES))

    same = with_estimates(winding, alike)
    (found,) = learning_covariances(same, path_of(same))
    assert not found.any()
    (found,) = parameter_covariances(same, path_of(same))
    assert np.diag(found[-1]).min() > 0
