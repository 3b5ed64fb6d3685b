"""A simulated drive as a run folder: what its sensors would have recorded, and the truth."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import SimulationError
from odometry.io.run_folder import write_run_folder
from odometry.recording.run import Robot, Run
from odometry.simulation.contact.drive import ContactDrive
from odometry.simulation.contact.traction import Traction
from odometry.simulation.contact.vehicle import ContactVehicle
from odometry.simulation.noise import measured_poses
from odometry.tables.table import Table


@dataclass(frozen=True)
class ContactSensors:
    """White noise of each sensor, one standard deviation, and how often a pose is measured."""

    pose_rate_hz: float = 10.0
    sigma_position_m: float = 0.01
    sigma_height_m: float = 0.01
    sigma_yaw_rad: float = 0.004
    sigma_tread_m_s: float = 0.002
    sigma_attitude_rad: float = 0.002
    sigma_gyro_rad_s: float = 0.003
    sigma_acceleration_m_s2: float = 0.05


def write_contact_run(
    folder: Path,
    drive: ContactDrive,
    sensors: ContactSensors,
    rng: np.random.Generator,
    *,
    terrain: str | None,
    settings: Mapping[str, Any] | None = None,
) -> Path:
    """Write one drive as a run folder with odometry, pose and truth.

    Where the traction was given, its name at each stamp is the column `terrain` of the truth.

    Parameters
    ----------
    folder : Path
        Made if it is missing.
    drive : ContactDrive
        One drive, not a stack.
    sensors : ContactSensors
    rng : numpy.random.Generator
        Source of the noise.
    terrain : str, optional
        Name of the terrain of the whole run, for those who may know it.
    settings : Mapping, optional
        What else made the run, kept in [simulation] of run.toml.

    Returns
    -------
    Path
        `folder`.

    Raises
    ------
    SimulationError
        If `drive` is a stack, or its stamps are not at the poses' rate.
    """
    content, tables = recording(drive, sensors, rng, terrain=terrain, settings=settings)
    write_run_folder(Path(folder), content, tables)
    return Path(folder)


def contact_run(
    name: str,
    drive: ContactDrive,
    sensors: ContactSensors,
    rng: np.random.Generator,
    *,
    terrain: str | None,
    settings: Mapping[str, Any] | None = None,
) -> Run:
    """The run of `write_contact_run` without a folder, its numbers not rounded."""
    content, columns = recording(drive, sensors, rng, terrain=terrain, settings=settings)
    known = {field.name for field in fields(Robot)}
    robot = Robot(**{key: value for key, value in content["robot"].items() if key in known})
    tables: dict[str, Any] = {
        kind: Table(Path(name) / f"{kind}.csv", table, np.arange(len(table["t"])) + 2)
        for kind, table in columns.items()
    }
    return Run(Path(name), robot, content, **tables)


def recording(
    drive: ContactDrive,
    sensors: ContactSensors,
    rng: np.random.Generator,
    *,
    terrain: str | None,
    settings: Mapping[str, Any] | None,
) -> tuple[dict[str, Any], dict[str, dict[str, AnyArray]]]:
    """The content of run.toml and the tables of a run folder; see `write_contact_run`."""
    if drive.poses_world.ndim != 2:
        raise SimulationError(
            f"one drive is a run: poses of shape {drive.poses_world.shape}, expected (N, 6)"
        )
    tables = {
        "odometry": _odometry(drive, sensors, rng),
        "pose": _pose(drive, sensors, rng),
        "truth": _truth(drive),
    }
    made = {
        **(settings or {}),
        "vehicle": vehicle_settings(drive.vehicle),
        "ground": named_settings(drive.ground),
        "sensors": asdict(sensors),
    }
    if drive.traction:
        made["traction"] = [traction_settings(piece) for piece in drive.traction]
    run = {} if terrain is None else {"terrain": terrain}
    return {"robot": dict(drive.vehicle.robot), "run": run, "simulation": made}, tables


def _truth(drive: ContactDrive) -> dict[str, AnyArray]:
    """x, y, yaw, and the traction in force, at every stamp."""
    columns = {"t": drive.stamps_s, **_columns("x y yaw", drive.poses_world[:, [0, 1, 5]])}
    return {**columns, "terrain": np.array(drive.terrains)} if drive.traction else columns


def _odometry(
    drive: ContactDrive, sensors: ContactSensors, rng: np.random.Generator
) -> dict[str, AnyArray]:
    """Tread speeds, attitude, yaw rate and accelerations at every stamp."""
    truth = np.column_stack(
        [
            drive.tread_speeds_m_s,
            drive.poses_world[:, 3:5],
            drive.twists_body[:, 2],
            drive.accelerations_m_s2,
        ]
    )
    sigma = np.repeat(
        [
            sensors.sigma_tread_m_s,
            sensors.sigma_attitude_rad,
            sensors.sigma_gyro_rad_s,
            sensors.sigma_acceleration_m_s2,
        ],
        [2, 2, 1, 2],
    )
    measured = truth + sigma * rng.standard_normal(truth.shape)
    names = "v_left v_right roll pitch gyro_z accel_x accel_y"
    return {"t": drive.stamps_s, **_columns(names, measured)}


def _pose(
    drive: ContactDrive, sensors: ContactSensors, rng: np.random.Generator
) -> dict[str, AnyArray]:
    """x, y, yaw and z at the rate of the poses."""
    step_s = drive.stamps_s[1] - drive.stamps_s[0]
    stride = round(1 / (sensors.pose_rate_hz * step_s))
    if stride < 1 or abs(stride * step_s * sensors.pose_rate_hz - 1) > 1e-6:
        raise SimulationError(
            f"poses at {sensors.pose_rate_hz:g} Hz do not fall on stamps {step_s:g} s apart"
        )
    rows = drive.poses_world[::stride]
    poses = measured_poses(rows[:, [0, 1, 5]], sensors.sigma_position_m, sensors.sigma_yaw_rad, rng)
    heights = rows[:, 2] + sensors.sigma_height_m * rng.standard_normal(len(rows))
    return {"t": drive.stamps_s[::stride], **_columns("x y yaw", poses), "z": heights}


def _columns(names: str, values: FloatArray) -> dict[str, AnyArray]:
    return dict(zip(names.split(), values.T, strict=True))


def vehicle_settings(vehicle: ContactVehicle) -> dict[str, Any]:
    """Everything of a vehicle that [robot] does not say."""
    x, y, height = vehicle.centre_of_mass_m
    return {
        "yaw_inertia_kg_m2": vehicle.yaw_inertia_kg_m2,
        "x_cm": x,
        "y_cm": y,
        "height": height,
        "contact_x_m": vehicle.contact_x_m.tolist(),
        "friction": vehicle.friction.tolist(),
        "entry_m": vehicle.entry_m.tolist(),
        "settling_s": vehicle.settling_s,
        "law": named_settings(vehicle.law),
    }


def traction_settings(piece: Traction) -> dict[str, Any]:
    """All of a piece; its friction as rows left and right."""
    return {
        "name": piece.name,
        "from_s": piece.from_s,
        "friction": piece.friction.tolist(),
        "lateral_share": piece.lateral_share,
        "law": named_settings(piece.law),
    }


def named_settings(block: Any) -> dict[str, Any]:
    """A frozen block with the name of its kind."""
    content = {k: list(v) if isinstance(v, tuple) else v for k, v in asdict(block).items()}
    return {"kind": type(block).__name__, **content}
