"""Faults of poses all along the run: units, direction of yaw, place on the robot."""

import math

import numpy as np

from tests.blind.faults.fault import Fault, UnsuitableError, about

GOOD = frozenset({"good pose", "gyro"})
YAW = ("yaw", "heading", "pose", "orientation", "world")
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


def compass(recording, rng):  # noqa: ARG001
    return posed(recording, yaw=(math.pi / 2 - recording["pose"]["yaw"]) % (2 * math.pi))


def compass_degrees(recording, rng):  # noqa: ARG001
    return posed(recording, yaw=(90 - np.rad2deg(recording["pose"]["yaw"])) % 360)


def _scaled(factor):
    def draw(recording, rng):  # noqa: ARG001
        pose = recording["pose"]
        return posed(recording, **{n: pose[n] * factor for n in ("x", "y", "z") if n in pose})

    return draw


def free_scale(recording, rng):
    """One camera's SLAM: a scale of its own, 3 to 8 times off either way."""
    return _scaled(rng.uniform(3, 8) ** rng.choice([-1, 1]))(recording, rng)


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
    Fault("pose_yaw_reversed", "warning", "Yaw counts clockwise.", about(YAW, TURN),
          yaw_reversed, GOOD, named=True),
    Fault("pose_yaw_off_90", "warning", "Yaw is 90 degrees off the robot's x.",
          ("90", "quarter", "right angle"), yaw_off_90, GOOD, named=True),
    Fault("pose_yaw_off_180", "warning", "Yaw points to the rear.",
          ("180", "rear", "backward", "half turn", "opposite"), yaw_off_180, GOOD,
          ("front_is_rear",)),
    Fault("pose_yaw_off", "warning", "Yaw has an offset of its own.", about(YAW, OFFSET),
          yaw_off, GOOD),
    Fault("pose_yaw_is_compass", "warning", "Yaw is a compass bearing, clockwise from north.",
          about(YAW, TURN), compass, GOOD),
    Fault("pose_yaw_is_compass_degrees", "warning", "Yaw is a compass bearing in degrees.",
          ("compass", "bearing", "degree"), compass_degrees, GOOD),
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
    Fault("pose_at_a_far_sensor", "warning", "Poses are of a sensor far from the centre.",
          ("lever", "antenna", "sensor", "mount", "centre", "arm"), at_the_sensor,
          GOOD),
    Fault("pose_yaw_is_quaternion_z", "warning", "Yaw holds the z of the quaternion.",
          ("quaternion",), quaternion_z, GOOD),
    Fault("pose_yaw_is_course", "warning", "Yaw is the direction of travel.",
          ("course", "direction of travel", "travel", "track", "ground track"), course, GOOD),
    Fault("pose_yaw_constant", "warning", "Yaw was never measured.",
          about(YAW[:4], ("constant", "never", "not measured", "empty", "fixed", "default", "zero",
          "placeholder", "frozen")), constant_yaw, GOOD),
)
# fmt: on
