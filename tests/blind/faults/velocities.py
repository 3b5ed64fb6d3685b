"""Faults of measured velocities: units, signs, axes, another clock, nothing measured."""

import numpy as np

from tests.blind.faults.fault import Fault, UnsuitableError

GOOD = frozenset({"good pose", "gyro"})
LEAST_ROWS = 100


def measured(recording, rng):
    """Velocities along the robot's axes, as a sensor at 2 to 20 Hz beside the poses has them."""
    pose = recording["pose"]
    stamps_s, yaw = pose["t"], np.unwrap(pose["yaw"])
    at_s = np.arange(stamps_s[0] + 1, stamps_s[-1] - 1, 1 / rng.uniform(2, 20))
    half_s, sigma = rng.uniform(0.2, 0.4), rng.uniform(0.01, 0.08)

    def rate(values):
        later, earlier = (np.interp(at_s + side * half_s, stamps_s, values) for side in (1, -1))
        return (later - earlier) / (2 * half_s)

    east, north, heading = rate(pose["x"]), rate(pose["y"]), np.interp(at_s, stamps_s, yaw)
    ahead = east * np.cos(heading) + north * np.sin(heading)
    left = north * np.cos(heading) - east * np.sin(heading)
    noise = sigma * rng.normal(size=(2, len(at_s)))
    columns = {"t": at_s, "vx": ahead + noise[0], "vy": left + noise[1], "wz": rate(yaw)}
    return columns, {"vx": east, "vy": north}


def right(recording, rng):
    return recording.with_table("velocity", measured(recording, rng)[0])


def _changed(change):
    def draw(recording, rng):
        columns, of_map = measured(recording, rng)
        if len(columns["t"]) < LEAST_ROWS:
            raise UnsuitableError
        return recording.with_table("velocity", columns | change(columns, of_map))

    return draw


def _times(factor, *names):
    return _changed(lambda columns, _: {name: factor * columns[name] for name in names})


def another_drive(recording, rng):
    """The velocities of the same drive run backwards in time: of another motion."""
    columns, _ = measured(recording, rng)
    turned = {name: values[::-1] for name, values in columns.items() if name != "t"}
    return recording.with_table("velocity", columns | turned)


FAULTS = (
    Fault(
        "velocity_in_km_h",
        "warning",
        "Velocities in km/h.",
        ("km/h",),
        _times(3.6, "vx", "vy"),
        GOOD,
    ),
    Fault(
        "velocity_in_mm_s",
        "warning",
        "Velocities in mm/s.",
        ("mm/s",),
        _times(1000.0, "vx", "vy"),
        GOOD,
    ),
    Fault(
        "velocity_turn_in_degrees",
        "warning",
        "Turn rates in degrees per second.",
        ("degrees",),
        _times(180 / np.pi, "wz"),
        GOOD,
    ),
    Fault(
        "velocity_backwards",
        "warning",
        "A sensor that looks back.",
        ("backwards", "sign", "other way"),
        _times(-1.0, "vx", "vy"),
        GOOD,
    ),
    Fault(
        "velocity_z_down",
        "warning",
        "Velocities in axes with z down.",
        ("clockwise", "z down", "ned", "frd"),
        _times(-1.0, "vy", "wz"),
        GOOD,
    ),
    Fault(
        "velocity_of_the_map",
        "warning",
        "Velocities along the axes of the map.",
        ("map", "axes", "world"),
        _changed(lambda _, of_map: of_map),
        GOOD,
    ),
    Fault(
        "velocity_exchanged",
        "warning",
        "vx and vy are exchanged.",
        ("exchanged", "axes"),
        _changed(lambda columns, _: {"vx": columns["vy"], "vy": columns["vx"]}),
        GOOD,
    ),
    Fault(
        "velocity_zeros",
        "warning",
        "Velocities that were never measured, as zeros.",
        ("never measured", "not measured", "empty"),
        _times(0.0, "vx", "vy", "wz"),
        GOOD,
    ),
    Fault(
        "velocity_of_another_drive",
        "warning",
        "Velocities of another drive.",
        ("another", "clock", "unrelated"),
        another_drive,
        GOOD,
    ),
)
