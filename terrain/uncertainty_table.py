"""The covariance of the odometer as columns, and as a table of result.json."""

from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.evaluation.odometer_uncertainty import OdometerUncertainty
from odometry.evaluation.open_loop_consistency import DEGREES, OpenLoopConsistency
from odometry.evaluation.open_loop_errors import SOURCES
from terrain.odometer_advice import advice, verdict

NAMES = ("x", "y", "yaw")
PAIRS = ((0, 1), (0, 2), (1, 2))


def covariance_columns(uncertainty: OdometerUncertainty) -> dict[str, FloatArray]:
    """Columns of odometer.csv: sigma_x, sigma_y, sigma_yaw and the three covariances."""
    of = uncertainty.covariances
    sigmas = np.sqrt(np.maximum(np.diagonal(of, axis1=1, axis2=2), 0.0))
    return {f"sigma_{name}": sigmas[:, k] for k, name in enumerate(NAMES)} | {
        f"covariance_{NAMES[i]}_{NAMES[j]}": of[:, i, j] for i, j in PAIRS
    }


def uncertainty_table(uncertainty: OdometerUncertainty, reference_name: str) -> dict[str, Any]:
    """What result.json holds of it: plain values, metres and radians."""
    noise = uncertainty.noise
    return {
        "source": uncertainty.source,
        "sigma_by_source": None
        if noise is None
        else dict(zip(SOURCES, np.sqrt(noise.variances).tolist(), strict=True)),
        "after": [
            {
                "distance_m": distance_m,
                "sigma_x_m": float(sigmas[0]),
                "sigma_y_m": float(sigmas[1]),
                "sigma_yaw_rad": float(sigmas[2]),
            }
            for distance_m, sigmas in uncertainty.sigmas.items()
        ],
        "nees": [_nees(check) for check in uncertainty.checks],
        "nees_by_own_poses": [_nees(check) for check in uncertainty.own_checks],
        "advice": advice(uncertainty, reference_name),
    }


def _nees(check: OpenLoopConsistency) -> dict[str, Any]:
    return {
        "distance_m": check.distance_m,
        "windows": check.windows,
        "independent": check.independent,
        "mean": check.mean,
        "expected": DEGREES,
        "bounds": check.bounds.tolist(),
        "covariance_is": verdict(check),
    }
