"""The tables and settings of the run folder of a simulated drive, vibration of its IMU included."""

from collections.abc import Mapping
from dataclasses import asdict
from math import degrees
from typing import Any

import numpy as np
from scipy.signal import butter, sosfilt

from odometry.arrays import AnyArray, FloatArray
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.simulation.drive import Drive
from odometry.simulation.ground import GroundMap
from odometry.simulation.noise import measured_poses
from terrain.synthesis.config import SynthesisConfig

RATE_HZ = 100.0
GRAVITY_M_S2 = 9.81
# centre of the band [Hz], size at 1 m/s [m/s2]
_KNOWN = {"gravel": (14.0, 1.6), "grass": (9.0, 1.2), "brick": (20.0, 1.4)}
CENTRES_HZ, SIZE_M_S2 = (6.0, 26.0), 1.4  # of other terrains, spread in the order given
BAND = 1.6  # from centre / BAND to centre * BAND
ROTATION = 0.04  # rad/s for each m/s2
SENSOR_M_S2, SENSOR_RAD_S = 0.05, 0.003  # white noise
SPREAD_HZ, SPREAD_SIZE = 0.1, 0.25  # of the logarithms, from run to run


def vibration_bands(terrains: tuple[str, ...]) -> dict[str, tuple[float, float]]:
    """Centre [Hz] and size at 1 m/s [m/s2] by terrain."""
    centres = np.geomspace(*CENTRES_HZ, max(len(terrains), 2))
    return {
        name: _KNOWN.get(name, (float(centres[place]), SIZE_M_S2))
        for place, name in enumerate(terrains)
    }


def imu_table(
    drive: Drive, terrains: tuple[str, ...], rng: np.random.Generator
) -> dict[str, AnyArray]:
    """Columns of imu.csv at RATE_HZ.

    Each axis is white noise through a band-pass of the terrain beneath, times tread speed, plus
    white noise of the sensor, gravity, the yaw rate and the accelerations of the drive itself. It
    is a stated model, not a measured one: no wheel, no tyre, no suspension.

    Parameters
    ----------
    drive : Drive
    terrains : tuple of str
        All of them, in order.
    rng : Generator
        Draws the noise, and by how much this run's bands differ from `vibration_bands`.
    """
    begin_s, end_s = float(drive.stamps_s[0]), float(drive.stamps_s[-1])
    at_s = begin_s + np.arange(int((end_s - begin_s) * RATE_HZ) + 1) / RATE_HZ
    row = np.searchsorted(drive.stamps_s, at_s, side="right") - 1
    beneath = np.array(drive.terrains, dtype=object)[row]
    speed_m_s = np.abs(drive.tread_speeds_m_s[row]).mean(axis=1)
    columns: dict[str, FloatArray] = {}
    for axis in "xyz":
        columns[f"gyro_{axis}"] = SENSOR_RAD_S * rng.standard_normal(len(at_s))
        columns[f"accel_{axis}"] = SENSOR_M_S2 * rng.standard_normal(len(at_s))
    for name, (centre_hz, size) in vibration_bands(terrains).items():
        middle_hz = centre_hz * np.exp(SPREAD_HZ * rng.standard_normal())
        edges_hz = [middle_hz / BAND, min(middle_hz * BAND, 0.49 * RATE_HZ)]
        band = butter(2, edges_hz, "bandpass", fs=RATE_HZ, output="sos")
        grown = size * np.exp(SPREAD_SIZE * rng.standard_normal()) * speed_m_s * (beneath == name)
        for column, share in ((c, ROTATION if c.startswith("gyro") else 1.0) for c in columns):
            noise = sosfilt(band, rng.standard_normal(len(at_s)))
            columns[column] = columns[column] + share * grown * noise / noise.std()
    at_stamps = measured_twists(drive)
    twists = np.stack([np.interp(at_s, drive.stamps_s, of) for of in at_stamps.T], axis=1)
    columns["gyro_z"] = columns["gyro_z"] + twists[:, 2]
    columns["accel_x"] = columns["accel_x"] + np.gradient(twists[:, 0], 1 / RATE_HZ)
    columns["accel_y"] = columns["accel_y"] + twists[:, 0] * twists[:, 2]
    columns["accel_z"] = columns["accel_z"] + GRAVITY_M_S2
    return {"t": at_s, **columns}


def measured_twists(drive: Drive) -> FloatArray:
    """Twists (N, 3) at the stamps as a sensor has them, whose bandwidth is finite.

    Tread speeds hold until the next stamp and change there: the mean of the step before and of the
    step after a stamp. The one after it alone would be half a step early, and so would the turn
    that is integrated from it.
    """
    before = np.concatenate([drive.twists_body[:1], drive.twists_body[:-1]])
    return (before + drive.twists_body) / 2


Tables = dict[str, dict[str, AnyArray]]
NAMES = ("y_left", "y_right", "x_icr")


def motion_tables(config: SynthesisConfig, drive: Drive, rng: np.random.Generator) -> Tables:
    """Tables odometry, pose (both with sensor noise) and truth."""
    terrains = np.array(drive.terrains)
    count = len(drive.stamps_s)
    treads = drive.tread_speeds_m_s + config.sigma_tread_m_s * rng.standard_normal((count, 2))
    gyro = measured_twists(drive)[:, 2] + config.sigma_gyro_rad_s * rng.standard_normal(count)
    measured = slice(None, None, config.samples_between("pose_rate_hz"))
    poses = measured_poses(
        drive.poses_world[measured], config.sigma_position_m, config.sigma_yaw_rad, rng
    )
    return {
        "odometry": {
            "t": drive.stamps_s,
            "v_left": treads[:, 0],
            "v_right": treads[:, 1],
            "gyro_z": gyro,
        },
        "pose": {"t": drive.stamps_s[measured], **_columns("x y yaw", poses)},
        "truth": {
            "t": drive.stamps_s,
            **_columns("x y yaw", drive.poses_world),
            "terrain": terrains,
            **_columns("y_left y_right x_icr", drive.icrs_m),
        },
    }


def run_settings(
    config: SynthesisConfig,
    ground: GroundMap,
    true_icrs_m: Mapping[str, FloatArray],
    photos_origin: str,
) -> dict[str, Any]:
    """Content of `run.toml`; `[source]` holds what is needed to make the run again.

    A run over one terrain names it, as `identify` and `label` need it.
    """
    icrs = {name: [round(float(v), 6) for v in icr] for name, icr in true_icrs_m.items()}
    source = {
        "made_by": "terrain-odometry synthesise",
        "seed": config.seed,
        "photographs": photos_origin,
        "metres_per_pixel": config.metres_per_pixel,
        "zones": list(config.zones),
        "zone_length_m": config.zone_length_m,
        "strips": list(ground.terrains),
        "edges_m": ground.edges_m.tolist(),
        "edge_wave_m": config.edge_wave_m,
        "edge_wave_phases_rad": list(ground.wave_phases_rad),
        "icrs_y_left_y_right_x_icr_m": icrs,
        "icr_wander_m": list(config.icr_wander_m),
        "icr_wander_time_s": config.icr_wander_time_s,
        "sigma_position_m": config.sigma_position_m,
        "sigma_yaw_deg": degrees(config.sigma_yaw_rad),
        "sigma_tread_m_s": config.sigma_tread_m_s,
        "sigma_gyro_rad_s": config.sigma_gyro_rad_s,
        "sigma_parameters_m": list(config.sigma_parameters_m),
        "jpeg_quality": config.jpeg_quality,
        **({"imu": "vibration made by terrain and speed"} if config.has_imu else {}),
        "driver": {k: v for k, v in asdict(config.driver).items() if k != "phases_rad"},
        "image_terrain": "the terrain of images.csv is that of the ground at the image's centre",
    }
    one_terrain = {"run": {"terrain": config.zones[0]}} if len(set(config.zones)) == 1 else {}
    return one_terrain | {
        "robot": dict(config.robot),
        "camera": config.camera.to_table(),
        "source": source,
    }


def _columns(names: str, values: FloatArray) -> dict[str, AnyArray]:
    return dict(zip(names.split(), values.T, strict=True))


def identified_parameters(
    config: SynthesisConfig, true_icrs_m: Mapping[str, FloatArray], rng: np.random.Generator
) -> ParameterSet:
    """Truth plus noise of the stated sigma, in the order of `true_icrs_m`.

    Parameters
    ----------
    config : SynthesisConfig
        For its `sigma_parameters_m` and robot.
    true_icrs_m : mapping of terrain to (3,) array
        y_left, y_right, x_icr [m].
    rng : numpy.random.Generator
        Source of the noise.
    """
    sigma = np.array(config.sigma_parameters_m)
    stated = ", ".join(f"{s:g}" for s in sigma)
    source = f"synthetic truth plus noise of sigma {stated} m, as from an identification run"
    terrains = {
        name: TerrainParameters(
            model="icr",
            values={
                key: round(float(value), 4)
                for key, value in zip(NAMES, icr + sigma * rng.standard_normal(3), strict=True)
            },
            covariance_order=NAMES,
            covariance=np.diag(sigma**2),
            source=source,
        )
        for name, icr in true_icrs_m.items()
    }
    vehicle = {
        "name": str(config.robot.get("name", "robot")),
        "source": "terrain-odometry synthesise",
    }
    return ParameterSet(terrains, vehicle)
