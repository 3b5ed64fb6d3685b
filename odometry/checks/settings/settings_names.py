"""Keys of run.toml that are not read because they are misspelt, and sizes in another unit."""

from collections.abc import Iterator, Mapping
from dataclasses import fields
from difflib import SequenceMatcher
from typing import Any

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.recording.run import Robot

ALIKE = 0.8
TABLES = ("robot", "run", "camera", "sensors")
KEYS = {
    "robot": tuple(field.name for field in fields(Robot)),
    "run": ("terrain",),
    "sensors": ("pose", "imu"),
}
# What other programs call them, without marks and in small letters.
CALLED = {
    "pose": ("gps", "gnss", "antenna", "lidar", "position", "reference", "mocap", "posesensor"),
    "imu": ("gyro", "gyroscope", "inertial", "imurpy", "imumount", "imurotation", "imuorientation"),
    "wheel_radius": ("wheelradius", "radius", "wheelr"),
    "track_width": ("wheelseparation", "wheelbase", "trackwidth", "track"),
    "terrain": ("ground", "surface"),
}
SIZES = {  # of robots on wheels or tracks, in metres and kilograms
    "track_width": (0.05, 6.0),
    "length": (0.05, 15.0),
    "width": (0.05, 8.0),
    "wheel_radius": (0.01, 2.0),
    "mass": (0.1, 1e5),
}


def settings_names(evidence: Evidence) -> Iterator[Finding]:
    """Tables and keys of run.toml with a name like a known one that is missing."""
    settings = evidence.run.settings
    yield from _misspelt("run.toml", settings, TABLES, "a table [{}]", "no [{}]")
    for name, known in KEYS.items():
        table = settings.get(name)
        if isinstance(table, Mapping):
            yield from _misspelt(f"run.toml: [{name}]", table, known, "a key {}", "no {}")


def robot_sizes(evidence: Evidence) -> Iterator[Finding]:
    """Sizes of [robot] that no robot has."""
    for name, (least, most) in SIZES.items():
        value = getattr(evidence.run.robot, name)
        if value is None or least <= value <= most:
            continue
        unit = "kg" if name == "mass" else "m"
        yield Finding(
            "robot_size",
            Level.WARNING,
            f"run.toml: [robot] {name} = {value:g} {unit}, expected {least:g} to {most:g} {unit}",
            "It is in another unit (mm, cm, inches)" if unit == "m" else "It is in another unit",
            "Write it in metres" if unit == "m" else "Write it in kilograms",
        )


def _misspelt(
    where: str, table: Mapping[str, Any], known: tuple[str, ...], there: str, missing: str
) -> Iterator[Finding]:
    for name in table:
        meant = "" if name in known else _meant(str(name), known)
        if meant and meant not in table:
            yield Finding(
                "setting_name",
                Level.NOTE,
                f"{where} has {there.format(name)}, which is not read, and {missing.format(meant)}",
                f"It may be {meant} by another name",
                f"Rename it to {meant}, if it is in SI units",
            )


def _meant(name: str, known: tuple[str, ...]) -> str:
    plain = "".join(letter for letter in name.lower() if letter.isalnum())
    for meant in known:
        spelt = meant.replace("_", "")
        alike = SequenceMatcher(None, plain, spelt).ratio() >= ALIKE
        if alike or plain in CALLED.get(meant, ()):
            return meant
    return ""
