"""The odometer's covariance in tables and words."""

import numpy as np
import pytest

from odometry.evaluation.odometer_noise import USUAL_NOISE
from odometry.evaluation.odometer_uncertainty import OdometerUncertainty
from odometry.evaluation.open_loop_consistency import OpenLoopConsistency
from terrain.result.result_table import covariance_columns, uncertainty_table


def test_columns_hold_deviations_and_covariances():
    matrix = np.array([[4.0, 0.1, 0.2], [0.1, 9.0, 0.3], [0.2, 0.3, 0.25]])
    found = {name: float(of[0]) for name, of in covariance_columns(matrix[None]).items()}
    assert found == {
        "sigma_x": 2.0,
        "sigma_y": 3.0,
        "sigma_yaw": 0.5,
        "covariance_x_y": 0.1,
        "covariance_x_yaw": 0.2,
        "covariance_y_yaw": 0.3,
    }


def test_the_table_names_its_sources_and_what_was_found():
    of = OdometerUncertainty(
        lambda: [np.eye(3)[None]],
        {5.0: np.array([0.1, 0.2, 0.03])},
        USUAL_NOISE,
        80,
        "usual",
        (OpenLoopConsistency(5.0, 40, 10, 3.0, np.array([1.7, 4.7])),),
    )
    table = uncertainty_table(of, "truth")
    assert table["after"] == [
        {"distance_m": 5.0, "sigma_x_m": 0.1, "sigma_y_m": 0.2, "sigma_yaw_rad": 0.03}
    ]
    assert table["sigma_by_source"]["random_x_per_m"] == pytest.approx(0.19)
    (nees,) = table["nees"]
    assert "as large as its errors over 5 m" in table["advice"]
    assert (nees["mean"], nees["expected"], nees["covariance_is"]) == (3.0, 3, "consistent")
