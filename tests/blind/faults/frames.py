"""Faults of the frame of poses: axes, and places on the Earth."""

import math

import numpy as np

from tests.blind.faults.fault import Fault, about
from tests.blind.faults.poses import GOOD, OFFSET, YAW, posed

EARTH_M = 6_371_000.0


def north_east_down(recording, rng):  # noqa: ARG001
    pose = recording["pose"]
    down = {"z": -pose["z"]} if "z" in pose else {}
    return posed(recording, x=pose["y"], y=pose["x"], yaw=math.pi / 2 - pose["yaw"], **down)


def mirrored(recording, rng):  # noqa: ARG001
    return posed(recording, y=-recording["pose"]["y"], yaw=-recording["pose"]["yaw"])


def swap_x_y(recording, rng):  # noqa: ARG001
    return posed(recording, x=recording["pose"]["y"], y=recording["pose"]["x"])


def on_earth(recording, rng):
    """Latitude and longitude [rad] of the poses, and height [m]."""
    latitude, longitude = rng.uniform(0.5, 1.1), rng.uniform(-2.0, 2.5)
    north, east = recording["pose"]["y"] / EARTH_M, recording["pose"]["x"] / EARTH_M
    return latitude + north, longitude + east / math.cos(latitude)


def latitude_longitude(recording, rng):
    latitude, longitude = np.rad2deg(on_earth(recording, rng))
    if rng.random() < 0.5:
        return posed(recording, x=latitude, y=longitude)
    return posed(recording, x=longitude, y=latitude)


def earth_centred(recording, rng):
    latitude, longitude = on_earth(recording, rng)
    return posed(
        recording,
        x=EARTH_M * np.cos(latitude) * np.cos(longitude),
        y=EARTH_M * np.cos(latitude) * np.sin(longitude),
        z=EARTH_M * np.sin(latitude),
    )


def utm(recording, rng):
    pose = recording["pose"]
    east, north = rng.uniform(2e5, 8e5), rng.uniform(4e6, 7e6)
    return posed(recording, x=pose["x"] + east, y=pose["y"] + north)


def utm_with_local_yaw(recording, rng):
    """UTM positions; the yaw still counts from where the robot started."""
    pose, turn = recording["pose"], rng.choice([-1, 1]) * rng.uniform(0.4, 2.7)
    x, y = pose["x"], pose["y"]
    turned = posed(
        recording,
        x=x * math.cos(turn) - y * math.sin(turn),
        y=x * math.sin(turn) + y * math.cos(turn),
    )
    return utm(turned, rng)


def utm_in_single_precision(recording, rng):
    result = utm(recording, rng)
    pose = result["pose"]
    return posed(
        result,
        x=pose["x"].astype(np.float32).astype(float),
        y=pose["y"].astype(np.float32).astype(float),
    )


# fmt: off
FAULTS = (
    Fault("pose_ned", "warning", "North-east-down axes.", ("ned", "north", "mirror", "left-handed",
          "down"), north_east_down, GOOD, ("pose_mirrored",), named=True),
    Fault("pose_mirrored", "warning", "Left and right of the world are mirrored.",
          ("mirror", "left-handed", "ned", "down"), mirrored, GOOD),
    Fault("pose_x_y_swapped", "warning", "x and y are exchanged, yaw is not.",
          ("swap", "exchang", "interchang", "mirror", "x y", "left-handed"), swap_x_y, GOOD),
    Fault("pose_in_latitude_longitude", "warning", "Positions are latitude and longitude.",
          ("lat", "lon", "degree", "geograph"), latitude_longitude, GOOD, named=True),
    Fault("pose_earth_centred", "warning", "Positions count from the centre of the Earth.",
          ("ecef", "earth", "geocentric"), earth_centred, GOOD),
    Fault("pose_utm_against_local_truth", "warning", "Poses in UTM, truth in a local frame.",
          ("utm", "frame", "origin", "truth", "local", "map"), utm, frozenset({"truth"}),
          named=True),
    Fault("pose_utm_with_local_yaw", "warning", "UTM positions with the yaw of a local frame.",
          about(YAW, OFFSET), utm_with_local_yaw, GOOD, ("pose_yaw_off", "pose_yaw_off_90")),
    Fault("pose_in_single_precision", "warning", "UTM positions kept in 32 bits: 0.03 to 0.5 m.",
          ("single", "32", "float", "precision", "resolution", "quanti", "round", "step", "digit"),
          utm_in_single_precision, GOOD),
)
# fmt: on
