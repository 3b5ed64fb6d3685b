"""Columns that are not read, with names close to those of columns that are."""

from collections.abc import Iterator
from difflib import SequenceMatcher

from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level
from odometry.checks.stamps import tables_of

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
ALIKE = 0.8


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
        (meant for meant in known if len(meant) > 4 and _alike(plain, _plain(meant)) >= ALIKE), ""
    )


def _plain(name: str) -> str:
    return "".join(letter for letter in name.lower() if letter.isalnum())


def _alike(first: str, second: str) -> float:
    return SequenceMatcher(None, first, second).ratio()


def _elsewhere(evidence: Evidence, name: str) -> bool:
    return name == "gyro_z" and evidence.yaw_rate is not None
