"""Faults of poses all along the run: units, axes and frames."""

import math

import numpy as np

from tests.blind.faults.fault import Fault, UnsuitableError

GOOD = frozenset({"good pose", "gyro"})
EARTH_M = 6_371_000.0
TURN = ("revers", "sign", "clockwise", "compass", "bearing", "north", "opposite", "negat", "ned")
OFFSET = ("offset", "rotat", "mount", "misalign", "turned", "off by", "frame", "axis", "axes")


def posed(recording, **columns):
    return recording.with_columns("pose", **columns)


def yaw_in_degrees(recording, rng):
    degrees = np.rad2deg(recording["pose"]["yaw"])
    return posed(recording, yaw=degrees if rng.random() < 0.5 else (degrees + 180) % 360 - 180)


def yaw_reversed(recording, rng):  # noqa: ARG001
    return posed(recording, yaw=-recording["pose"]["yaw"])


def yaw_off_90(recording, rng):
    return posed(recording, yaw=recording["pose"]["yaw"] + rng.choice([-1, 1]) * math.pi / 2)


def yaw_off_180(recording, rng):  # noqa: ARG001
    return posed(recording, yaw=recording["pose"]["yaw"] + math.pi)


def yaw_off(recording, rng):
    offset = np.deg2rad(rng.choice([rng.uniform(15, 75), rng.uniform(105, 165)]))
    return posed(recording, yaw=recording["pose"]["yaw"] + rng.choice([-1, 1]) * offset)


def north_east_down(recording, rng):  # noqa: ARG001
    pose = recording["pose"]
    down = {"z": -pose["z"]} if "z" in pose else {}
    return posed(recording, x=pose["y"], y=pose["x"], yaw=math.pi / 2 - pose["yaw"], **down)


def mirrored(recording, rng):  # noqa: ARG001
    return posed(recording, y=-recording["pose"]["y"], yaw=-recording["pose"]["yaw"])


def compass(recording, rng):  # noqa: ARG001
    return posed(recording, yaw=(math.pi / 2 - recording["pose"]["yaw"]) % (2 * math.pi))


def compass_degrees(recording, rng):  # noqa: ARG001
    return posed(recording, yaw=(90 - np.rad2deg(recording["pose"]["yaw"])) % 360)


def swap_x_y(recording, rng):  # noqa: ARG001
    return posed(recording, x=recording["pose"]["y"], y=recording["pose"]["x"])


def _scaled(factor):
    def draw(recording, rng):  # noqa: ARG001
        pose = recording["pose"]
        return posed(recording, **{n: pose[n] * factor for n in ("x", "y", "z") if n in pose})

    return draw


def free_scale(recording, rng):
    """One camera's SLAM: a scale of its own, 3 to 8 times off either way."""
    return _scaled(rng.uniform(3, 8) ** rng.choice([-1, 1]))(recording, rng)


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


def at_the_sensor(recording, rng):
    """The place of a sensor 1 to 2.5 robot lengths ahead or behind, e.g. on a trailer or boom."""
    pose, robot = recording["pose"], recording.robot
    arm = rng.choice([-1, 1]) * rng.uniform(1.0, 2.5) * robot.get("length", 1.0)
    return posed(
        recording, x=pose["x"] + arm * np.cos(pose["yaw"]), y=pose["y"] + arm * np.sin(pose["yaw"])
    )


def quaternion_z(recording, rng):  # noqa: ARG001
    yaw = np.angle(np.exp(1j * recording["pose"]["yaw"]))
    return posed(recording, yaw=np.sin(yaw / 2))


def course(recording, rng):
    """Yaw is the direction of travel of the receiver, also where the robot drives backwards."""
    pose, table = recording["pose"], recording["odometry"]
    reverse = np.mean(table["v_left"] + table["v_right"] < -0.2)
    if not 0.05 < reverse < 0.95:
        raise UnsuitableError
    noise = rng.normal(0, 0.01, (2, len(pose["t"])))
    dx, dy = np.gradient(pose["x"] + noise[0]), np.gradient(pose["y"] + noise[1])
    return posed(recording, yaw=np.arctan2(dy, dx))


def constant_yaw(recording, rng):
    value = rng.choice([0.0, rng.uniform(-3, 3)])
    return posed(recording, yaw=np.full(len(recording["pose"]["t"]), value))


METRES = ("unit", "scale")
# fmt: off
FAULTS = (
    Fault("pose_yaw_in_degrees", "warning", "Yaw is in degrees.", ("degree", "deg"),
          yaw_in_degrees, GOOD, named=True),
    Fault("pose_yaw_reversed", "warning", "Yaw counts clockwise.", TURN, yaw_reversed, GOOD,
          named=True),
    Fault("pose_yaw_off_90", "warning", "Yaw is 90 degrees off the robot's x.",
          ("90", "quarter", "right angle"), yaw_off_90, GOOD, named=True),
    Fault("pose_yaw_off_180", "warning", "Yaw points to the rear.",
          ("180", "rear", "backward", "half turn", "opposite"), yaw_off_180, GOOD,
          ("front_is_rear",)),
    Fault("pose_yaw_off", "warning", "Yaw has an offset of its own.", OFFSET, yaw_off, GOOD),
    Fault("pose_ned", "warning", "North-east-down axes.", ("ned", "north", "mirror", "left-handed",
          "down"), north_east_down, GOOD, ("pose_mirrored",), named=True),
    Fault("pose_mirrored", "warning", "Left and right of the world are mirrored.",
          ("mirror", "left-handed", "ned", "down"), mirrored, GOOD),
    Fault("pose_yaw_is_compass", "warning", "Yaw is a compass bearing, clockwise from north.",
          TURN, compass, GOOD),
    Fault("pose_yaw_is_compass_degrees", "warning", "Yaw is a compass bearing in degrees.",
          ("compass", "bearing", "degree"), compass_degrees, GOOD),
    Fault("pose_x_y_swapped", "warning", "x and y are exchanged, yaw is not.",
          ("swap", "exchang", "interchang", "mirror", "x y", "left-handed"), swap_x_y, GOOD),
    Fault("pose_in_mm", "warning", "Positions in millimetres.", ("mm", "millimet"),
          _scaled(1000.0), GOOD, named=True),
    Fault("pose_in_cm", "warning", "Positions in centimetres.", ("cm", "centimet"),
          _scaled(100.0), GOOD),
    Fault("pose_in_feet", "warning", "Positions in feet.", ("feet", "foot", "ft"),
          _scaled(1 / 0.3048), GOOD, ("pose_scale_free",)),
    Fault("pose_in_km", "warning", "Positions in kilometres.", ("km", "kilomet"),
          _scaled(0.001), GOOD),
    Fault("pose_scale_free", "warning", "Positions have a scale of their own.", METRES, free_scale,
          GOOD, ("pose_in_feet", "treads_in_rad_s", "treads_in_km_h")),
    Fault("pose_in_latitude_longitude", "warning", "Positions are latitude and longitude.",
          ("lat", "lon", "degree", "geograph"), latitude_longitude, GOOD, named=True),
    Fault("pose_earth_centred", "warning", "Positions count from the centre of the Earth.",
          ("ecef", "earth", "geocentric"), earth_centred, GOOD),
    Fault("pose_utm_against_local_truth", "warning", "Poses in UTM, truth in a local frame.",
          ("utm", "frame", "origin", "truth", "local", "map"), utm, frozenset({"truth"}),
          named=True),
    Fault("pose_utm_with_local_yaw", "warning", "UTM positions with the yaw of a local frame.",
          OFFSET, utm_with_local_yaw, GOOD, ("pose_yaw_off", "pose_yaw_off_90")),
    Fault("pose_in_single_precision", "warning", "UTM positions kept in 32 bits: 0.03 to 0.5 m.",
          ("single", "32", "float", "precision", "resolution", "quanti", "round", "step", "digit"),
          utm_in_single_precision, GOOD),
    Fault("pose_at_a_far_sensor", "warning", "Poses are of a sensor far from the centre.",
          ("lever", "antenna", "sensor", "mount", "offset", "centre", "arm"), at_the_sensor,
          GOOD),
    Fault("pose_yaw_is_quaternion_z", "warning", "Yaw holds the z of the quaternion.",
          ("quaternion",), quaternion_z, GOOD),
    Fault("pose_yaw_is_course", "warning", "Yaw is the direction of travel.",
          ("course", "direction of travel", "travel", "track", "ground track"), course, GOOD),
    Fault("pose_yaw_constant", "warning", "Yaw was never measured.",
          ("constant", "never", "not measured", "empty", "fixed", "default", "zero", "placeholder",
           "frozen"), constant_yaw, GOOD),
)
# fmt: on
