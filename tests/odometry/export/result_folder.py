"""A folder as `run` writes it: a bend to the left over gravel, then grass, from images ahead."""

import json

import numpy as np

from odometry.io.csv_table import write_csv_table
from odometry.parameters import ParameterSet, TerrainParameters, write_parameters

STAMPS_S = 0.1 * np.arange(101)
SPEED_M_S, YAW_RATE_RAD_S = 1.0, 0.2
SIGMAS = ("sigma_x", "sigma_y", "sigma_yaw")
COVARIANCES = ("covariance_x_y", "covariance_x_yaw", "covariance_y_yaw")
SEEN = {
    "t": np.array([0.0, 2.0, 6.0]),
    "label": np.array(["", "grass", "grass"]),
    "terrain_in_force": np.array(["gravel", "gravel", "grass"]),
    "place_x": np.array([np.nan, 2.0, 2.0]),
    "place_y": np.array([np.nan, 0.5, 0.5]),
}
TABLE = TerrainParameters(
    "icr",
    {"y_left": 0.5, "y_right": -0.4, "x_icr": 0.1, "alpha_left": 0.9, "alpha_right": 0.95},
    ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right"),
    np.diag(np.square([0.02, 0.03, 0.01, 0.005, 0.006])),
)


def circle():
    """Poses (101, 3) of the bend."""
    yaw = YAW_RATE_RAD_S * STAMPS_S
    radius_m = SPEED_M_S / YAW_RATE_RAD_S
    return np.column_stack([radius_m * np.sin(yaw), radius_m * (1 - np.cos(yaw)), yaw])


def content(origin):
    """What result.json holds of it."""
    mean = {"translation_m_per_m": {"mean": 0.05}, "rotation_deg_per_m": {"mean": 2.0}}
    return {
        "format": 1,
        "run": "bend",
        "robot": {"track_width": 0.6, "wheel_radius": 0.1},
        "origin": origin,
        "vision": True,
        "initial_terrain": "gravel",
        "switches": [{"terrain": "grass", "stamp_s": 5.0}],
        "wheel_travel_m": 10.0,
        "reference": "truth",
        "horizon_m": 5.0,
        "errors": {"odometer_without_gyroscope": mean, "odometer": {"not": "this one"}},
    }


def write_results(folder, origin=None):
    """Write the folder, with an origin or without, and give it back."""
    x, y, yaw = circle().T
    poses = {"t": STAMPS_S, "x": x, "y": y, "yaw": yaw}
    sigmas = {name: np.full(101, float(k)) for k, name in enumerate(SIGMAS, 1)}
    across = {name: np.full(101, k / 10) for k, name in enumerate(COVARIANCES, 1)}
    write_csv_table(folder / "odometer.csv", poses | sigmas | across)
    write_csv_table(folder / "estimate.csv", poses | sigmas)
    write_csv_table(folder / "terrain.csv", SEEN)
    write_parameters(folder / "learned.toml", ParameterSet({"gravel": TABLE}))
    (folder / "result.json").write_text(json.dumps(content(origin)))
    return folder
