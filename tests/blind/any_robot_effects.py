"""What is hidden from `gap` on robots of any size and pace: each as large as the robot asks for.

Speeds are shares of the fastest, lengths of the track width. Kinds of `tests/blind/hidden` that are
so already, or are times, angles and shares, are taken from there.
"""
# ruff: noqa: ARG001, ARG005 - all have one face, and few need all of it

import math

import numpy as np

from tests.blind.commands import followed
from tests.blind.effects import curvature, slope_sliding
from tests.blind.formula import icrs_by_curvature
from tests.blind.hidden.catalogue import HIDDEN
from tests.blind.hidden.courses import lagged, sign
from tests.blind.hidden.kind import Hidden, Kind
from tests.blind.hidden.mixed import mix
from tests.blind.hidden.seen import sliding
from tests.blind.hidden.surroundings import carried


def deadband(rng, scene):
    least = scene.speed_m_s * rng.uniform(0.15, 0.4)
    return lambda rng, clock: Hidden(
        {"least_m_s": least}, treads=lambda v: np.where(np.abs(v) < least, 0.0, v)
    )


def acceleration_limit(rng, scene):
    most = scene.speed_m_s / rng.uniform(1.0, 4.0)

    def hide(rng, clock):
        def treads(asked):
            step = most * clock.step_s
            return np.column_stack([followed(side, step, side[0]) for side in asked.T])

        return Hidden({"most_m_s2": most}, treads=treads)

    return hide


def slow_drive(rng, scene):
    constant_s = rng.uniform(0.2, 0.8)
    return lambda rng, clock: Hidden(
        {"constant_s": constant_s}, treads=lambda v: lagged(v, constant_s, clock.step_s)
    )


def late_poses(rng, scene):
    delay_s = rng.uniform(0.1, 0.6)
    return lambda rng, clock: Hidden(
        {"delay_s": delay_s}, reference=lambda t, poses: (t + delay_s, poses)
    )


def wheel_scale(rng, scene):
    scale = rng.permutation([1.0, 1 + sign(rng) * rng.uniform(0.03, 0.15)])
    return lambda rng, clock: Hidden({"scale": scale.tolist()}, treads=lambda v: v * scale)


def sensor_place(rng, scene):
    ahead, left = sign(rng), sign(rng)
    arm = scene.body.track_width * (rng.uniform(0.2, 0.8) * ahead + 1j * rng.uniform(0, 0.8) * left)

    def reference(times_s, poses):
        off = arm * np.exp(1j * poses[:, 2])
        return times_s, poses + np.column_stack([off.real, off.imag, np.zeros(len(off))])

    return lambda rng, clock: Hidden({"arm": [arm.real, arm.imag]}, reference=reference)


def sensor_heading(rng, scene):
    turned = sign(rng) * np.deg2rad(rng.uniform(2.0, 12.0))
    return lambda rng, clock: Hidden(
        {"yaw": turned}, reference=lambda t, poses: (t, poses + np.array([0.0, 0.0, turned]))
    )


def sideways(rng, scene):
    shift = sign(rng) * scene.body.track_width * rng.uniform(0.1, 0.5)
    return lambda rng, clock: Hidden(
        {"x_m": shift}, icrs=lambda values, treads: {**values, "x_icr": values["x_icr"] + shift}
    )


def turn_radius(rng, scene):
    p = curvature(rng, scene.body, scene.base)

    def icrs(values, treads):
        places = tuple(values[key] for key in ("y_left", "y_right", "x_icr"))
        alphas = (values["alpha_left"], values["alpha_right"])
        bent = icrs_by_curvature(*(alphas * treads.T), places, p)
        return {**values, "y_left": bent[0], "y_right": bent[1]}

    return lambda rng, clock: Hidden(p, icrs=icrs)


def slope(rng, scene):
    p = slope_sliding(rng, scene.body, scene.base)
    faster = scene.speed_m_s * rng.uniform(1.1, 2.0) / p["v_max"]
    p |= {"v_max": faster * p["v_max"]} | {k: p[k] / faster for k in ("lambda_1", "lambda_2")}
    return lambda rng, clock: Hidden(
        p, at_place=lambda row, pose, twist: sliding(scene.base, p, pose, twist)
    )


def steady_pull(rng, scene):
    speed, direction = scene.speed_m_s * rng.uniform(0.05, 0.2), rng.uniform(-math.pi, math.pi)
    return lambda rng, clock: Hidden(
        {"speed_m_s": speed},
        at_place=lambda row, pose, twist: carried(pose[2], twist, speed, direction),
    )


def tether(rng, scene):
    """The farther from the start, the more a cable brakes."""
    half_m = scene.speed_m_s * rng.uniform(10.0, 30.0)

    def hide(rng, clock):
        start = []

        def at_place(row, pose, twist):
            if not start:
                start.append(complex(*pose[:2]))
            kept = 1 / (1 + abs(complex(*pose[:2]) - start[0]) / half_m)
            return twist[0] * kept, twist[1], twist[2]

        return Hidden({"half_m": half_m}, at_place=at_place)

    return hide


def swell_and_ebb(rng, scene):
    """Both treads lose more and less, with a period of 30 to 60 s."""
    share, period_s = rng.uniform(0.1, 0.3), rng.uniform(30.0, 60.0)

    def hide(rng, clock):
        factor = 1 - share * (1 + np.sin(2 * np.pi * clock.times_s / period_s)) / 2
        return Hidden({"share": share}, treads=lambda v: v * factor[:, None])

    return hide


def in_steps(rng, scene):
    """A controller that sets speeds in steps."""
    step = scene.speed_m_s * rng.uniform(0.2, 0.5)
    return lambda rng, clock: Hidden({"step_m_s": step}, treads=lambda v: step * np.round(v / step))


SCALED = {
    "deadband": Kind(deadband, (("drive limits",),)),
    "acceleration_limit": Kind(acceleration_limit, (("drive limits",),), ("slow drive",)),
    "slow_drive": Kind(slow_drive, (("slow drive",),), ("late commands",)),
    "late_poses": Kind(late_poses, (("late stamps",),), (), ("late commands",)),
    "wheel_scale": Kind(wheel_scale, (("wheel size",),), ("terrain",)),
    "sensor_place": Kind(sensor_place, (("sensor place",),), ("sideways",)),
    "sensor_heading": Kind(sensor_heading, (("sensor heading",),)),
    "sideways": Kind(sideways, (("sideways",),), ("sensor place", "terrain")),
    "turn_radius": Kind(turn_radius, (("turn radius",),)),
    "slope": Kind(slope, (("slope",),), sloped=True),
    "steady_pull": Kind(steady_pull, acceptable=("reference",)),
    "tether": Kind(tether),
    "swell_and_ebb": Kind(swell_and_ebb),
    "in_steps": Kind(in_steps, acceptable=("drive limits",)),
}
CLEAN = ("nothing",)
NAMED = (
    *("deadband", "acceleration_limit", "slow_drive", "late_commands", "late_poses"),
    *("wheel_scale", "sensor_place", "sensor_heading", "sideways", "turn_radius", "slope"),
    *("outliers", "slip_by_speed", "slip_backward", "slip_by_acceleration", "grip_lost"),
    *("lost_tyre", "one_side_deflates", "other_terrain", "top_speed", "gyroscope_scale"),
    "gyroscope_bias",
)
UNNAMED = (
    *("steady_pull", "wide_when_fast", "tether", "swell_and_ebb", "in_steps", "rubbing_brake"),
    *("voltage_sag", "shared_pump", "head_wind", "magnetic_floor", "hot_motor", "low_battery"),
    *("one_turn_slips", "slip_by_turning", "stick_and_slip", "crabbing", "overshoot", "bumps"),
    *("clogging_mud", "missing_ticks"),
)
BY_COMMANDS = ("deadband", "acceleration_limit", "slow_drive", "late_commands", "top_speed")
BY_COMMANDS += ("in_steps", "voltage_sag", "shared_pump", "hot_motor", "low_battery", "overshoot")
KINDS = {name: (HIDDEN | SCALED)[name] for name in (*CLEAN, *NAMED, *UNNAMED)}


def kind_named(name):
    """A kind, or two at once: "slope+late_poses"."""
    parts = [KINDS[part] for part in name.split("+")]
    return mix(*parts) if len(parts) == 2 else parts[0]
