"""Faults between a command and the tread: motors, gears, batteries, brakes, radio.

The recorded speeds are those that were asked for.
"""
# ruff: noqa: ARG001 - all have one face, and few need all of it

import numpy as np

from tests.blind.commands import followed
from tests.blind.hidden.courses import bursts, delayed, lagged, moment, rates_of, sign, wander
from tests.blind.hidden.kind import Hidden, Kind


def top_speed(rng, scene):
    """A motor, or both, cannot turn faster than 50 to 85 % of the speeds that are asked for."""
    most = scene.speed_m_s * rng.uniform(0.5, 0.85, 2)
    if rng.uniform() < 0.5:
        most[rng.integers(2)] = np.inf

    def hide(rng, clock):
        return Hidden({"most_m_s": most.tolist()}, treads=lambda v: np.clip(v, -most, most))

    return hide


def acceleration_limit(rng, scene):
    """The treads change their speed by at most 0.15 to 0.5 m/s a second."""
    most = rng.uniform(0.15, 0.5)

    def hide(rng, clock):
        step = most * clock.step_s

        def treads(asked):
            return np.column_stack([followed(side, step, side[0]) for side in asked.T])

        return Hidden({"most_m_s2": most}, treads=treads)

    return hide


def weak_side(rng, scene):
    """One motor does nothing below 0.08 to 0.2 m/s."""
    side, least = int(rng.integers(2)), rng.uniform(0.08, 0.2)

    def hide(rng, clock):
        limits = np.where(np.arange(2) == side, least, 0.0)
        truth = {"side": side, "least_m_s": least}
        return Hidden(truth, treads=lambda v: np.where(np.abs(v) < limits, 0.0, v))

    return hide


def backlash(rng, scene):
    """After each reversal a gear turns freely through 4 to 15 cm of tread."""
    play_m = rng.uniform(0.04, 0.15)

    def hide(rng, clock):
        def treads(asked):
            result, place, held = np.empty_like(asked), np.zeros(2), np.zeros(2)
            for row, speed in enumerate(asked):
                place = place + speed * clock.step_s
                moved = np.clip(held, place - play_m / 2, place + play_m / 2)
                result[row], held = (moved - held) / clock.step_s, moved
            return result

        return Hidden({"play_m": play_m}, treads=treads)

    return hide


def low_battery(rng, scene):
    """Speed fades by 5 to 15 % over a run as the battery empties, as reported speeds do not."""

    def hide(rng, clock):
        loss = rng.uniform(0.05, 0.15)
        factor = (1 - loss * clock.share**2)[:, None]
        return Hidden({"loss": loss}, treads=lambda v: v * factor)

    return hide


def voltage_sag(rng, scene):
    """The harder both motors are driven, the less voltage is left for both."""
    sag = rng.uniform(0.05, 0.25) / scene.speed_m_s

    def hide(rng, clock):
        return Hidden(
            {"sag_s_m": sag}, treads=lambda v: v * (1 - sag * np.abs(v).mean(axis=1))[:, None]
        )

    return hide


def rubbing_brake(rng, scene):
    """A brake of one side rubs for some seconds, now and then."""
    side, kept = int(rng.integers(2)), rng.uniform(0.6, 0.9)

    def hide(rng, clock):
        mask, events = bursts(rng, clock, (2.0, 8.0), (8.0, 30.0))
        factor = np.where(mask[:, None] & (np.arange(2) == side), kept, 1.0)
        return Hidden({"side": side, "kept": kept, "events": events}, treads=lambda v: v * factor)

    return hide


def lost_commands(rng, scene):
    """The radio drops commands for 0.3 to 1.5 s; the last one holds."""

    def hide(rng, clock):
        mask, events = bursts(rng, clock, (0.3, 1.5), (2.0, 10.0))
        rows = np.maximum.accumulate(np.where(mask, 0, np.arange(len(mask))))
        return Hidden({"events": events}, treads=lambda v: v[rows])

    return hide


def radio_jitter(rng, scene):
    """Commands arrive 0 to 0.5 s late, now more, now less."""
    mean_s = rng.uniform(0.15, 0.3)

    def hide(rng, clock):
        late_s = np.clip(mean_s * (1 + 0.6 * wander(rng, clock, 2.0)), 0.0, 2 * mean_s)
        rows = np.arange(len(late_s)) - np.round(late_s / clock.step_s).astype(int)
        rows = np.maximum.accumulate(np.maximum(rows, 0))
        return Hidden({"mean_s": mean_s}, treads=lambda v: v[rows])

    return hide


def late_side(rng, scene):
    """One side follows its commands 0.1 to 0.3 s late."""
    side, delay_s = int(rng.integers(2)), round(rng.uniform(0.1, 0.3), 2)

    def hide(rng, clock):
        return Hidden(
            {"side": side, "delay_s": delay_s},
            treads=lambda v: np.where(np.arange(2) == side, delayed(v, delay_s, clock.step_s), v),
        )

    return hide


def sluggish_side(rng, scene):
    """One side follows its commands with a first-order lag of 0.15 to 0.5 s."""
    side, constant_s = int(rng.integers(2)), rng.uniform(0.15, 0.5)

    def hide(rng, clock):
        return Hidden(
            {"side": side, "constant_s": constant_s},
            treads=lambda v: np.where(np.arange(2) == side, lagged(v, constant_s, clock.step_s), v),
        )

    return hide


def overshoot(rng, scene):
    """A badly tuned speed controller: a second-order lag that swings, 0.5 to 1.2 Hz."""
    frequency, damping = 2 * np.pi * rng.uniform(0.5, 1.2), rng.uniform(0.1, 0.4)

    def hide(rng, clock):
        def treads(asked):
            result = np.empty_like(asked)
            speed, rate = asked[0], np.zeros(2)
            for row, wanted in enumerate(asked):
                rate = rate + clock.step_s * (
                    frequency**2 * (wanted - speed) - 2 * damping * frequency * rate
                )
                speed = speed + clock.step_s * rate
                result[row] = speed
            return result

        return Hidden({"frequency_rad_s": frequency, "damping": damping}, treads=treads)

    return hide


def shared_pump(rng, scene):
    """A hydraulic pump feeds both sides: each takes from the other what it uses."""
    share = rng.uniform(0.05, 0.25) / scene.speed_m_s

    def hide(rng, clock):
        return Hidden({"share_s_m": share}, treads=lambda v: v * (1 - share * np.abs(v[:, ::-1])))

    return hide


def turtle_mode(rng, scene):
    """At some moment the drive switches to a slower gear, and says nothing of it."""
    ratio = rng.uniform(0.7, 0.93)

    def hide(rng, clock):
        at_s = moment(rng, clock)
        factor = np.where(clock.times_s >= at_s, ratio, 1.0)[:, None]
        return Hidden({"ratio": ratio, "moment_s": at_s}, treads=lambda v: v * factor)

    return hide


def slipping_clutch(rng, scene):
    """Above a hard acceleration a clutch lets a side slip by half until it eases."""
    least_m_s2, kept = rng.uniform(0.3, 0.6), rng.uniform(0.3, 0.7)

    def hide(rng, clock):
        def treads(asked):
            hard = np.abs(rates_of(asked, clock.step_s)) > least_m_s2
            return asked * np.where(hard, kept, 1.0)

        return Hidden({"least_m_s2": least_m_s2, "kept": kept}, treads=treads)

    return hide


def tread_trim(rng, scene):
    """A trim knob adds a fixed speed to one side whenever it is asked to move."""
    trim = sign(rng) * rng.uniform(0.02, 0.08)
    side = np.arange(2) == rng.integers(2)

    def hide(rng, clock):
        return Hidden(
            {"trim_m_s": trim},
            treads=lambda v: v + np.where(side & (np.abs(v) > 0.02), trim, 0.0),
        )

    return hide


DRIVES = {
    "top_speed": Kind(top_speed, (("drive limits",),), acceptable=("tread slip",)),
    "acceleration_limit": Kind(
        acceleration_limit, (("drive limits",),), acceptable=("slow drive",)
    ),
    "weak_side": Kind(weak_side, (("drive limits",),), style="crawl"),
    "backlash": Kind(backlash, acceptable=("drive limits",)),
    "low_battery": Kind(
        low_battery,
        (("unknown", "drive limits gradual"),),
        acceptable=("wheel size gradual", "traction gradual", "tread slip gradual"),
        course="gradual",
    ),
    "voltage_sag": Kind(voltage_sag, acceptable=("tread slip", "drive limits")),
    "rubbing_brake": Kind(
        rubbing_brake,
        acceptable=("wheel size in_bursts", "traction in_bursts", "tread slip in_bursts"),
        course="in_bursts",
    ),
    "lost_commands": Kind(
        lost_commands, acceptable=("late commands in_bursts",), course="in_bursts"
    ),
    "radio_jitter": Kind(radio_jitter, (("late commands",),)),
    "late_side": Kind(late_side, (("late commands",),), acceptable=("slow drive",)),
    "sluggish_side": Kind(sluggish_side, (("slow drive",),), acceptable=("late commands",)),
    "overshoot": Kind(overshoot, acceptable=("slow drive", "late commands")),
    "shared_pump": Kind(shared_pump),
    "turtle_mode": Kind(
        turtle_mode,
        (("wheel size", "drive limits"),),
        acceptable=("traction from_a_moment", "tread slip from_a_moment"),
        course="from_a_moment",
    ),
    "slipping_clutch": Kind(slipping_clutch, acceptable=("tread slip",)),
    "tread_trim": Kind(tread_trim),
}
