"""Odd values of run.toml, accelerations of the IMU, and columns whose names are nearly known."""

from collections.abc import Iterator
from difflib import SequenceMatcher

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import Mend, times
from odometry.checks.stamps.stamps import tables_of
from odometry.checks.turns.turn_signs import Sense, gyroscope_sense

GYRO = ("gyro_x", "gyro_y", "gyro_z")
ACCEL = ("accel_x", "accel_y", "accel_z")
KNOWN = {
    "odometry.csv": (
        *("t", "v_left", "v_right", "roll", "pitch", "gyro_z", "accel_x", "accel_y", "terrain"),
        *("current_left", "current_right"),
    ),
    "imu.csv": ("t", *GYRO, *ACCEL),
    "pose.csv": ("t", "x", "y", "yaw", "z", "roll", "pitch", "window"),
    "velocity.csv": ("t", "vx", "vy", "wz"),
    "images.csv": ("t", "file", "terrain"),
}
# What other programs call them, without marks and in small letters.
CALLED = {
    "gyro_z": (
        *("wz", "gz", "gyro", "gyroz", "gyrz", "yawrate", "rotz", "omega", "omegaz", "turnrate"),
        *("angularvelocityz", "angularz", "angularvelocity", "ratez", "imugyroz", "imuwz"),
    ),
    "gyro_x": ("wx", "gx", "gyrx", "angularvelocityx"),
    "gyro_y": ("wy", "gy", "gyry", "angularvelocityy"),
    "accel_x": ("ax", "accx", "linearaccelerationx", "imuaccelx"),
    "accel_y": ("ay", "accy", "linearaccelerationy", "imuaccely"),
    "accel_z": ("az", "accz", "linearaccelerationz", "imuaccelz"),
    "terrain": ("ground", "surface", "soil", "label", "terrainclass"),
    "window": ("windowid", "segment", "chunk"),
    "roll": ("phi", "rolldeg"),
    "pitch": ("theta", "pitchdeg"),
    "current_left": ("ileft", "currentl", "motorcurrentleft"),
    "current_right": ("iright", "currentr", "motorcurrentright"),
}
ALIKE_COLUMNS = 0.8


def columns(evidence: Evidence) -> Iterator[Finding]:
    """Columns with a name close to that of a known column which is missing."""
    for file, table in tables_of(evidence.run).items():
        known = KNOWN.get(file, ())
        for name in table.columns:
            meant = "" if name in known else _meant(name, known)
            if meant and meant not in table and not _elsewhere(evidence, meant):
                yield Finding(
                    "column_name",
                    Level.NOTE,
                    f"{file} has a column {name!r}, which is not read, and none of the name "
                    f"{meant!r}",
                    f"The column may be {meant} by another name",
                    f"Rename it to {meant}, if it is in SI units",
                )


def _meant(name: str, known: tuple[str, ...]) -> str:
    plain = _plain(name)
    for meant in known:
        if plain == _plain(meant) or plain in CALLED.get(meant, ()):
            return meant
    return next(
        (
            meant
            for meant in known
            if len(meant) > 4 and _alike(plain, _plain(meant)) >= ALIKE_COLUMNS
        ),
        "",
    )


def _plain(name: str) -> str:
    return "".join(letter for letter in name.lower() if letter.isalnum())


def _alike(first: str, second: str) -> float:
    return SequenceMatcher(None, first, second).ratio()


def _elsewhere(evidence: Evidence, name: str) -> bool:
    return name == "gyro_z" and evidence.yaw_rate is not None


FARTHEST_M = 10.0  # a sensor on a robot is nearer
ALIKE = 0.75  # of two names
RARE = 0.2
GRAVITY_M_S2 = 9.81


def settings(evidence: Evidence) -> Iterator[Finding]:
    """The place of the pose sensor, the axes of the IMU by gravity, names of terrain."""
    yield from _sensors(evidence)
    yield from _gravity(evidence)
    yield from _terrain_names(evidence)


def _sensors(evidence: Evidence) -> Iterator[Finding]:
    pose_m = evidence.run.sensors.pose_m
    if pose_m is not None and max(map(abs, pose_m)) > FARTHEST_M:
        yield Finding(
            "sensor_place",
            Level.WARNING,
            f"run.toml: [sensors] pose = {list(pose_m)} m, expected at most {FARTHEST_M:g} m",
            "The place of the sensor is in mm or cm, not metres",
            "Write it in metres, in the robot frame",
        )


def _gravity(evidence: Evidence) -> Iterator[Finding]:
    imu = evidence.run.imu
    names = ("accel_x", "accel_y", "accel_z")
    if imu is None or not all(name in imu and np.isfinite(imu[name]).any() for name in names):
        return
    x, y, z = (float(np.nanmedian(imu[name])) for name in names)
    size = float(np.linalg.norm([x, y, z]))
    seen = f"accelerations of imu.csv are ({x:.2f}, {y:.2f}, {z:.2f}) in the median"
    stated = evidence.run.sensors.imu_rad is not None
    if 0.8 < size < 1.2:
        yield _imu("imu_unit", seen, "Accelerations are in g, not m/s2", "Multiply by 9.81")
    elif size < 0.5:
        yield _imu(
            "imu_unit",
            seen,
            "Accelerations have no gravity in them (it was removed), or another unit",
            "Record raw accelerations in m/s2",
        )
    elif not 8.0 < size < 12.0:
        yield _imu("imu_unit", seen, "Accelerations are in another unit", "Convert them to m/s2")
    elif z < -0.7 * size and not stated and _turns_as_treads(evidence):
        yield _imu(
            "imu_unit",
            f"{seen}, and gyro_z of imu.csv turns as the treads do",
            "Accelerations have the opposite sign (a driver that gives gravity, not its reaction); "
            "the gyroscope is right",
            "Negate the accelerations alone",
        )
    elif z < -0.7 * size and not stated:
        yield _imu(
            "imu_mount",
            seen,
            "The IMU is mounted upside down (z down): gyro_z has the wrong sign, too",
            "State its attitude in [sensors] imu, or negate y and z",
            times("imu", -1.0, *(name for name in imu.columns if name[-2:] in {"_y", "_z"})),
        )
    elif abs(z) < 0.7 * size and not stated:
        axis = "x" if abs(x) > abs(y) else "y"
        yield _imu(
            "imu_mount",
            seen,
            f"The IMU is mounted on its side: its axis {axis} is vertical, so gyro_z is not the "
            "yaw rate",
            "State its attitude in [sensors] imu",
        )


def _turns_as_treads(evidence: Evidence) -> bool:
    """Whether the yaw rate of imu.csv has the sign of the treads' turns."""
    of_imu = evidence.yaw_rate is not None and evidence.gyroscope_file == "imu.csv"
    return of_imu and gyroscope_sense(evidence) is Sense.AGREES


def _imu(name: str, seen: str, cause: str, remedy: str, mend: Mend | None = None) -> Finding:
    return Finding(name, Level.WARNING, seen, cause, remedy, mend=mend)


def _terrain_names(evidence: Evidence) -> Iterator[Finding]:
    names: dict[str, int] = {}
    for table in (evidence.run.odometry, evidence.run.images):
        if table is not None and "terrain" in table:
            found, counts = np.unique(np.asarray(table["terrain"], dtype=str), return_counts=True)
            for name, count in zip(found, counts, strict=True):
                names[str(name)] = names.get(str(name), 0) + int(count)
    if evidence.run.terrain:
        names.setdefault(evidence.run.terrain, 0)
    ordered = sorted((name for name in names if name), key=lambda name: -names[name])
    for place, rare in enumerate(ordered):
        for usual in ordered[:place]:
            similarity = SequenceMatcher(None, rare.lower().strip(), usual.lower().strip()).ratio()
            if (similarity >= ALIKE and names[rare] <= RARE * max(names[usual], 1)) or (
                rare.lower().strip() == usual.lower().strip()
            ):
                yield Finding(
                    "terrain_names",
                    Level.NOTE,
                    f"terrain {rare!r} ({names[rare]} rows) is written like {usual!r} "
                    f"({names[usual]} rows)",
                    "One terrain has two spellings: a name is misspelt",
                    "Write one name for one terrain",
                )
                break
