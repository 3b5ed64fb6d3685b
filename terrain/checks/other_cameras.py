"""Other readings of a `[camera]` table: mistakes that people make, the likeliest first."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.recording.run import Robot

# No skid-steer robot carries its camera as far from its centre [m].
FARTHEST_M = 5.0
WHOLE_TURN_RAD = 2 * np.pi  # larger angles in radians are not expected
UP_RAD = 0.09  # 5 degrees, a camera for the terrain does not point higher
LARGE_RAD = 3.2  # above half a turn, which is not needed in radians; 2 and 3 degrees are seldom
TILTED_RAD = 0.35  # 20 degrees, a camera is not rolled by more
# Columns: the camera's x, y, z axes in its optical frame (x right, y down, z viewing direction)
_CAMERA_IN_OPTICAL = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])


@dataclass(frozen=True)
class Reading:
    """What a table may mean.

    Attributes
    ----------
    cause, remedy : str
    table : Mapping
        As it should be.
    robot : Robot
    """

    cause: str
    remedy: str
    table: Mapping[str, Any]
    robot: Robot


def other_readings(table: Mapping[str, Any], robot: Robot) -> Iterator[Reading]:
    """Readings that may bring the region ahead into the image, the likeliest first."""
    key = "mount" if "mount" in table else "ground_to_image"
    values = np.array(table[key], dtype=np.float64)
    readings = _mounts(values) if key == "mount" else _homographies(values, table)
    for cause, remedy, other in readings:
        yield Reading(cause, remedy, dict(table) | {key: other.tolist()}, robot)
    width, height = table["image_size"]
    yield Reading(
        "image_size is swapped: it holds height and width",
        f"Write image_size = [{height}, {width}]",
        dict(table) | {"image_size": [height, width]},
        robot,
    )
    yield from _robots(table, robot)


def angles_in_degrees(mount: FloatArray) -> bool:
    """Whether an angle of a mount (6,) cannot be in radians."""
    return bool(np.abs(mount[3:]).max() > WHOLE_TURN_RAD)


def tilted(mount: FloatArray) -> bool:
    """Whether a mount (6,) holds the camera neither upright, nor on its side, nor overhead."""
    off = (mount[3] + np.pi / 4) % (np.pi / 2) - np.pi / 4
    return bool(abs(off) > TILTED_RAD)


def looks_up(mount: FloatArray) -> bool:
    """Whether a mount (6,) points above the horizon."""
    return bool(-np.sin(mount[4]) > np.sin(UP_RAD))


def too_far(mount: FloatArray) -> bool:
    """Whether the place of a mount (6,) cannot be in metres."""
    return bool(np.abs(mount[:3]).max() > FARTHEST_M)


def _mounts(mount: FloatArray) -> Iterator[tuple[str, str, FloatArray]]:
    angles = list(_angles(mount))
    places = list(_places(mount))
    for cause, remedy, other in angles:
        yield f"mount: {cause}", remedy, np.concatenate([mount[:3], other])
    for cause, remedy, place in places:
        yield f"mount: {cause}", remedy, np.concatenate([place, mount[3:]])
    for cause, remedy, other in angles:
        for cause_too, remedy_too, place in places:
            both = np.concatenate([place, other])
            yield (
                f"mount: {cause}, and {cause_too}",
                f"{remedy}; {remedy_too[0].lower()}{remedy_too[1:]}",
                both,
            )


def _angles(mount: FloatArray) -> Iterator[tuple[str, str, FloatArray]]:
    roll, pitch, yaw = mount[3:]
    if np.abs(mount[3:]).max() > LARGE_RAD:
        yield (
            "roll, pitch and yaw are in degrees",
            f"Convert them to radians (pitch {pitch:g} to {np.radians(pitch):.4g})",
            np.radians(mount[3:]),
        )
    if angles_in_degrees(mount):
        return
    if pitch < 0:
        yield (
            "pitch has the wrong sign: the camera points up (a positive pitch points down)",
            "Negate pitch",
            np.array([roll, -pitch, yaw]),
        )
    yield (
        "the angles are those of the optical frame (x right, y down, z viewing direction)",
        "Give the angles of a frame with x in the viewing direction, y left, z up",
        _of_optical(mount[3:]),
    )
    for degrees, words in ((-90, "90"), (90, "-90"), (180, "180")):
        yield (
            f"yaw is off by {words} degrees, or the camera does not point ahead",
            "Correct yaw, or use a camera that points where the robot goes",
            np.array([roll, pitch, yaw + np.radians(degrees)]),
        )
    for words, value, other in (
        ("roll", roll, [pitch, roll, yaw]),
        ("yaw", yaw, [roll, yaw, pitch]),
    ):
        if max(abs(pitch), TILTED_RAD) < value < np.pi / 2:  # as given it points down
            yield (
                f"pitch and {words} are exchanged",
                "Write roll, pitch, yaw in this order",
                np.array(other),
            )


def _places(mount: FloatArray) -> Iterator[tuple[str, str, FloatArray]]:
    if mount[2] < 0:
        yield (
            "z has the wrong sign (the height above the terrain is positive)",
            "Negate z",
            mount[:3] * [1, 1, -1],
        )
    if too_far(mount):
        if np.abs(mount[:2]).max() < FARTHEST_M:
            yield "the height z is in mm", "Divide z by 1000", mount[:3] * [1, 1, 1e-3]
            yield "the height z is in cm", "Divide z by 100", mount[:3] * [1, 1, 1e-2]
            return
        yield "x, y and z are in mm", "Divide x, y and z by 1000", mount[:3] / 1000
        yield "x, y and z are in cm", "Divide x, y and z by 100", mount[:3] / 100


def _homographies(
    homography: FloatArray, table: Mapping[str, Any]
) -> Iterator[tuple[str, str, FloatArray]]:
    if np.linalg.cond(homography) > 1e15:
        return
    inverse: FloatArray = np.asarray(np.linalg.inv(homography))
    right_forward = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    bases: tuple[tuple[str, str, FloatArray], ...] = (
        ("", "", homography),
        ("it is image_to_ground, not ground_to_image", "Invert the matrix", inverse),
    )
    for words, remedy, base in bases:
        more = f"{words}, and " if words else ""
        if words:
            yield f"ground_to_image: {words}", remedy, base
        for unit, per_metre in (("mm", 1000.0), ("cm", 100.0)):
            yield (
                f"ground_to_image: {more}it takes {unit}, not metres",
                f"{remedy + '; multiply' if remedy else 'Multiply'} its first two columns by "
                f"{per_metre:g}",
                base @ np.diag([per_metre, per_metre, 1.0]),
            )
        yield (
            f"ground_to_image: {more}its ground frame has x right and y forward",
            f"{remedy + '; exchange' if remedy else 'Exchange'} its first two columns: x forward, "
            "y left",
            base @ right_forward,
        )
    matrix = np.array(table["matrix"], dtype=np.float64)
    yield (
        "ground_to_image: it leads to normalised coordinates, not pixels (matrix is left out)",
        "Multiply it by matrix from the left",
        matrix @ homography,
    )


def _robots(table: Mapping[str, Any], robot: Robot) -> Iterator[Reading]:
    for unit, factor in (("mm", 1000.0), ("cm", 100.0)):
        for names in (("length", "width"), ("length", "width", "track_width")):
            mended = {
                name: size / factor
                for name in names
                if (size := getattr(robot, name)) is not None and size > FARTHEST_M
            }
            if mended:
                yield Reading(
                    f"[robot] {' and '.join(mended)} of run.toml are in {unit}",
                    "Convert them to metres",
                    table,
                    replace(robot, **mended),
                )


def _of_optical(angles: FloatArray) -> FloatArray:
    """Roll, pitch and yaw of a camera whose optical axes have the angles given."""
    (sr, sp, sy), (cr, cp, cy) = np.sin(angles), np.cos(angles)
    optical = np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )
    r = optical @ _CAMERA_IN_OPTICAL
    pitch = -np.arcsin(np.clip(r[2, 0], -1, 1))
    return np.array([np.arctan2(r[2, 1], r[2, 2]), pitch, np.arctan2(r[1, 0], r[0, 0])])
