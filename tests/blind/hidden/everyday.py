"""Everyday defects: warm tyres, play in gears, loads that swing, ruts, filters, slipped mounts."""
# ruff: noqa: ARG001, ARG005 - all have one face, and few need all of it

import math

import numpy as np
from scipy.signal import lfilter

from tests.blind.hidden.courses import lagged, moment, sign
from tests.blind.hidden.kind import Hidden, Kind


def warming_tyres(rng, scene):
    """Tyres grow by 4 to 12 % as they warm within 20 to 60 s, and start cold in each run."""
    share, constant_s = rng.uniform(0.04, 0.12), rng.uniform(20.0, 60.0)

    def hide(rng, clock):
        warm = (1 - np.exp(-clock.times_s / constant_s))[:, None]
        return Hidden(
            {"share": share, "constant_s": constant_s}, treads=lambda v: v * (1 + share * warm)
        )

    return hide


def cold_grease(rng, scene):
    """Treads are slower by 10 to 30 % at first, and free within 15 to 50 s."""
    share, constant_s = rng.uniform(0.1, 0.3), rng.uniform(15.0, 50.0)

    def hide(rng, clock):
        cold = np.exp(-clock.times_s / constant_s)[:, None]
        return Hidden(
            {"share": share, "constant_s": constant_s}, treads=lambda v: v * (1 - share * cold)
        )

    return hide


def play_in_gears(rng, scene):
    """After a reversal a tread stands until its gears have taken up a play of 2 to 8 cm."""
    play_m = rng.uniform(0.02, 0.08)

    def hide(rng, clock):
        def treads(asked):
            result = np.zeros_like(asked)
            for side in range(2):
                place_m = play_m
                for row, speed in enumerate(asked[:, side]):
                    reached_m = place_m + speed * clock.step_s
                    place_m = min(max(reached_m, 0.0), play_m)
                    result[row, side] = (reached_m - place_m) / clock.step_s
            return result

        return Hidden({"play_m": play_m}, treads=treads)

    return hide


def swinging_payload(rng, scene):
    """A hung load swings after each change of speed; one tread loses grip as far as it swings."""
    turns, share = 2 * math.pi * rng.uniform(0.3, 0.7), rng.uniform(0.2, 0.6)
    side = np.arange(2) == rng.integers(2)

    def hide(rng, clock):
        step_s = clock.step_s

        def treads(asked):
            push = np.gradient(lagged(asked.mean(axis=1)[:, None], 0.1, step_s)[:, 0], step_s)
            pole = np.exp((-0.1 + 1j * math.sqrt(0.99)) * turns * step_s)
            swing = np.abs(lfilter([step_s], [1, -pole], push.astype(complex)))
            loss = share * np.clip(swing / 0.3, 0.0, 1.0)
            return asked * (1 - loss[:, None] * side)

        return Hidden({"turns_rad_s": turns, "share": share}, treads=treads)

    return hide


def weather_vane(rng, scene):
    """A steady wind turns a tall robot until it looks downwind, by up to 2 to 10 degrees/s."""
    most = np.deg2rad(rng.uniform(2.0, 10.0))

    def hide(rng, clock):
        downwind = rng.uniform(-math.pi, math.pi)

        def at_place(row, pose, twist):
            return twist[0], twist[1], twist[2] + most * math.sin(downwind - pose[2])

        return Hidden({"most_rad_s": most, "downwind_rad": downwind}, at_place=at_place)

    return hide


def ruts(rng, scene):
    """Ruts of a field steer the robot along one axis of the world, the more the faster it is."""
    steer_1_m, axis = rng.uniform(0.05, 0.3), rng.uniform(-math.pi, math.pi)

    def hide(rng, clock):
        def at_place(row, pose, twist):
            turn = steer_1_m * abs(twist[0]) * math.sin(2 * (axis - pose[2]))
            return twist[0], twist[1], twist[2] + turn

        return Hidden({"steer_1_m": steer_1_m, "axis_rad": axis}, at_place=at_place)

    return hide


def inner_brake(rng, scene):
    """Steering by a brake: in turns the inner tread loses 10 to 30 % more than was asked."""
    share = rng.uniform(0.1, 0.3)

    def hide(rng, clock):
        def treads(asked):
            slower = np.abs(asked) < 0.9 * np.abs(asked[:, ::-1])
            return asked * (1 - share * slower)

        return Hidden({"share": share}, treads=treads)

    return hide


def slow_encoder(rng, scene):
    """Recorded speeds pass a filter of 0.1 to 0.4 s: treads are ahead of what is recorded."""
    constant_s = rng.uniform(0.1, 0.4)

    def hide(rng, clock):
        return Hidden(
            {"constant_s": constant_s},
            reported=lambda asked, v: lagged(v, constant_s, clock.step_s),
        )

    return hide


def filtered_positions(rng, scene):
    """A receiver smooths its positions over 0.3 to 1 s as they come; its yaw is as it is."""
    constant_s = rng.uniform(0.3, 1.0)

    def hide(rng, clock):
        def reference(times_s, poses):
            smooth = lagged(poses[:, :2], constant_s, float(np.median(np.diff(times_s))))
            return times_s, np.column_stack([smooth, poses[:, 2]])

        return Hidden({"constant_s": constant_s}, reference=reference)

    return hide


def slow_yaw(rng, scene):
    """The yaw of the reference comes from a filter that is 0.2 to 0.6 s slow; positions do not."""
    constant_s = rng.uniform(0.2, 0.6)

    def hide(rng, clock):
        def reference(times_s, poses):
            slow = lagged(poses[:, 2:], constant_s, float(np.median(np.diff(times_s))))
            return times_s, np.column_stack([poses[:, :2], slow])

        return Hidden({"constant_s": constant_s}, reference=reference)

    return hide


def slipped_mount(rng, scene):
    """At some moment the reference turns on its mount by 3 to 12 degrees."""

    def hide(rng, clock):
        turn, at_s = sign(rng) * np.deg2rad(rng.uniform(3.0, 12.0)), moment(rng, clock)

        def reference(times_s, poses):
            error = np.where(times_s >= at_s, turn, 0.0)
            return times_s, poses + np.column_stack([np.zeros((len(poses), 2)), error])

        return Hidden({"turn_rad": turn, "moment_s": at_s}, reference=reference)

    return hide


REFERENCE = (("reference",),)
EVERYDAY = {
    "warming_tyres": Kind(
        warming_tyres,
        (("wheel size gradual", "unknown"),),
        acceptable=("traction gradual",),
        course="gradual",
    ),
    "cold_grease": Kind(cold_grease, acceptable=("traction gradual", "wheel size gradual")),
    "play_in_gears": Kind(
        play_in_gears, acceptable=("drive limits", "slow drive", "late commands")
    ),
    "swinging_payload": Kind(swinging_payload, acceptable=("tread slip", "traction in_bursts")),
    "weather_vane": Kind(weather_vane),
    "ruts": Kind(ruts),
    "inner_brake": Kind(inner_brake, acceptable=("turn radius", "tread slip", "drive limits")),
    "slow_encoder": Kind(
        slow_encoder, acceptable=("late stamps",), without_gyroscope=("slow drive", "late commands")
    ),
    "filtered_positions": Kind(filtered_positions, REFERENCE, acceptable=("late stamps",)),
    "slow_yaw": Kind(slow_yaw, REFERENCE, acceptable=("unknown",)),
    "slipped_mount": Kind(
        slipped_mount,
        (("reference", "sensor heading from_a_moment"),),
        acceptable=("unknown",),
        course="from_a_moment",
    ),
}
