"""Faults of wheels and clocks that an import has to notice, in made streams of messages.

    python -m tests.studies.recordings.import_faults [--seed 0] [--half-turns held]

Printed: how often what is wrong is noticed, and what is right is accused.

- clocks that are set back by 0.15 to 20 s; messages late by chance, and of two publishers;
- a wheel of four that keeps its last value;
- velocities of joints in another unit or sign than the changes of their positions;
- with `--half-turns`, positions within one turn that are sampled too rarely: the drives of half of
  the recordings of `TERRAIN_ODOMETRY_DATA` ("dev" or "held").
"""

import argparse
from types import SimpleNamespace

import numpy as np

import odometry
from odometry.bags.rows.places_watch import PlacesWatch
from odometry.bags.rows.set_clock import SetClock
from odometry.bags.wheels import speeds
from odometry.bags.wheels.side_agreement import SideAgreement
from odometry.bags.wheels.wheel_source import WheelSource
from odometry.errors import BagError
from tests.studies.recordings.live_notes import recordings

NAMES = ("fl", "rl", "fr", "rr")
WHEELS = WheelSource("/joint_states", "joints", NAMES[:2], NAMES[2:])
UNITS = {
    "m/s": 0.15,
    "rpm": 30 / np.pi,
    "deg/s": 180 / np.pi,
    "mm/s": 150.0,
    "turns/s": 0.5 / np.pi,
}
OTHERS = {"gear 30": 30.0, "sign": -1.0, "one sign": np.array([1.0, 1.0, -1.0, 1.0])}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--half-turns", choices=["dev", "held"])
    arguments = parser.parse_args()
    if arguments.half_turns:
        half_turns(arguments.half_turns)
        return
    set_clocks(arguments.seed)
    held_wheels(arguments.seed)
    velocities(arguments.seed)


def kept(stamps_ns):
    clock, used = SetClock(), []
    for stamp_ns in stamps_ns:
        used += [one for one, _ in clock.add(int(stamp_ns), ())]
    return clock, np.array(used + [one for one, _ in clock.rest()])


def late(kind, stamps_s, period_s, rng):
    """Stamps in the order in which messages come that are late by chance."""
    if kind == "each by some time":
        late_s = rng.exponential(rng.uniform(0.001, 0.3), len(stamps_s))
    elif kind == "some by up to a second":
        some = rng.random(len(stamps_s)) < rng.uniform(0.01, 0.5)
        late_s = some * rng.uniform(0, 1, len(stamps_s))
    elif kind == "each by some periods":
        late_s = rng.normal(0, 2 * period_s, len(stamps_s))
    else:
        late_s = (rng.random(len(stamps_s)) < 0.5) * rng.uniform(0.05, 0.8)
    return stamps_s[np.argsort(stamps_s + late_s, kind="stable")]


def set_clocks(seed):
    kinds = ("each by some time", "some by up to a second", "each by some periods")
    kinds = (*kinds, "two publishers by chance")
    accused, worst = dict.fromkeys(kinds, 0), dict.fromkeys(kinds, 0.0)
    found = made = 0
    for number in range(300):
        rng = np.random.default_rng(seed + number)
        period_s = 1 / float(rng.choice([5, 10, 20, 50, 100, 200, 400]))
        stamps_s, kind = np.arange(0, 60, period_s), kinds[number % 4]
        clock, _ = kept(1e9 * late(kind, stamps_s, period_s, rng))
        accused[kind] += bool(clock.found)
        worst[kind] = max(worst[kind], clock.left_out / len(stamps_s))
        by_s, at_s = np.exp(rng.uniform(*np.log([0.15, 20]))), rng.uniform(10, 40)
        if by_s < 8 * period_s:
            continue
        set_back_s = np.where(stamps_s >= at_s, stamps_s - by_s, stamps_s)
        clock, used = kept(1e9 * (set_back_s + rng.normal(0, 0.05 * period_s, len(stamps_s))))
        made += 1
        sizes_s = [one.by_ns / 1e9 for one in clock.found]
        right = len(sizes_s) == 1 and abs(sizes_s[0] - by_s) < 2 * period_s
        found += right and bool((np.diff(used) >= 0).all())
    print(f"clocks that were set back: {found} of {made} found")
    for kind in kinds:
        print(f"  late {kind}: {accused[kind]} of 75 accused, {100 * worst[kind]:.1f} % left out")


def wheel_speeds(rng):
    """Stamps [ns] and speeds (N, 4) of a drive, in steps of some encoder and with some noise."""
    rate_hz, hold_s = float(rng.choice([10, 20, 50])), rng.uniform(2, 15)
    stamps_s = np.arange(0, 120, 1 / rate_hz)
    levels = rng.uniform(-0.2, 1, int(120 / hold_s) + 9)
    asked = np.repeat(levels, int(hold_s * rate_hz) + 1)[: len(stamps_s)]
    driven = np.convolve(asked, np.ones(5) / 5, "same")[:, None] * (1 + rng.normal(0, 0.03, 4))
    step, noise = rng.choice([0, 0.005, 0.02, 0.05, 0.1]), rng.choice([0, 0.002, 0.01])
    driven = driven + noise * rng.normal(0, 1, driven.shape)
    if rng.random() < 0.5:  # a wheel that slips by itself
        driven[:, 1] += 0.1 * np.sin(stamps_s * rng.uniform(0.1, 1))
    return (1e9 * stamps_s).astype(np.int64), np.round(driven / step) * step if step else driven


def odd_wheels(stamps_ns, wheels):
    agreement = SideAgreement(WHEELS)
    agreement.add(stamps_ns, wheels)
    return [one.wheel for one in agreement.contradictions()]


def held_wheels(seed):
    accused = noticed = named = 0
    for number in range(300):
        rng = np.random.default_rng(seed + number)
        stamps_ns, wheels = wheel_speeds(rng)
        accused += bool(odd_wheels(stamps_ns, wheels))
        place, row = rng.integers(4), np.searchsorted(stamps_ns, 1e9 * rng.uniform(10, 90))
        wheels[row:, place] = wheels[row, place]
        odd = odd_wheels(stamps_ns, wheels)
        noticed, named = noticed + bool(odd), named + (odd == [NAMES[place]])
    print(f"a wheel keeps its last value: {noticed} of 300 noticed, {named} named; {accused} of "
          "300 right ones accused of anything")  # fmt: skip


def joints(rng):
    """Stamps [s], positions and velocities (N, 4) as drivers give them."""
    rate_hz, hold_s = float(rng.choice([5, 10, 20, 50, 100])), rng.uniform(1, 8)
    asked = np.repeat(rng.uniform(-0.3, 1, int(90 / hold_s) + 3), int(200 * hold_s) + 1)[:18000]
    asked = asked * rng.uniform(0.2, 2) / 0.15
    rates = np.convolve(asked, np.ones(60) / 60, "same")[:, None] * (1 + rng.normal(0, 0.05, 4))
    places, tick = (
        np.cumsum(rates, axis=0) / 200,
        rng.choice([0, 2 * np.pi / 100, 2 * np.pi / 1000]),
    )
    places = np.floor(places / tick) * tick if tick else places
    rows = np.arange(0, len(rates), int(200 / rate_hz))
    kind, given = rng.choice(["measured", "smoothed", "asked", "differences"]), rates[rows]
    if kind == "smoothed":
        lag = np.ones(int(200 * rng.uniform(0.02, 0.4)))
        filtered = [np.convolve(rate, lag / len(lag))[: len(rates)] for rate in rates.T]
        given = np.stack(filtered, axis=1)[rows]
    elif kind == "asked":
        given = np.repeat(np.roll(asked, -int(200 * rng.uniform(0, 0.2)))[rows, None], 4, axis=1)
    elif kind == "differences":
        given = np.diff(places[rows], axis=0, prepend=places[:1]) * rate_hz
    if rng.random() < 0.4:
        places = (places + np.pi) % (2 * np.pi) - np.pi
    return (
        rows / 200,
        places[rows],
        given + rng.choice([0, 0.05, 0.3]) * rng.normal(size=given.shape),
    )


def said_of(stamps_s, places, rates):
    watch = PlacesWatch(WHEELS, 0.15)
    for stamp_s, place, rate in zip(stamps_s, places, rates, strict=True):
        received = SimpleNamespace(received_ns=int(1e9 * (1e9 + stamp_s)))
        watch.take(received, SimpleNamespace(name=NAMES, position=place, velocity=rate))
    try:
        watch.check()
    except BagError as error:
        return str(error)
    return ""


def velocities(seed):
    stopped, named, accused = dict.fromkeys((*UNITS, *OTHERS), 0), dict.fromkeys(UNITS, 0), 0
    for number in range(120):
        stamps_s, places, rates = joints(np.random.default_rng(seed + number))
        accused += bool(said_of(stamps_s, places, rates))
        for kind, factor in {**UNITS, **OTHERS}.items():
            said = said_of(stamps_s, places, factor * rates)
            stopped[kind] += bool(said)
            if kind in UNITS:
                named[kind] += f"--unit {kind}." in said
    print(f"velocities beside positions: stopped of 120 {stopped}, unit named {named}; {accused} "
          "right ones stopped")  # fmt: skip


def half_turns(half):
    """Radius 0.1 m and that of the robot, 1 to 20 messages a second."""
    wrong = stopped_wrong = below = stopped_below = 0
    for folder in recordings(half):
        run = odometry.Run.read(folder)
        stamps_s, lasts_s = run.odometry.stamps_s, np.diff(run.odometry.stamps_s)
        for radius_m in (run.robot.wheel_radius or 0.17, 0.1):
            ways_m = [
                np.append(0, np.cumsum(run.odometry[n][:-1] * lasts_s))
                for n in ("v_left", "v_right")
            ]
            for rate_hz in (1, 2, 3, 5, 10, 20):
                at_s = np.arange(stamps_s[0], stamps_s[-1], 1 / rate_hz)
                turned = [np.diff(np.interp(at_s, stamps_s, way)) for way in ways_m]
                steps = np.concatenate(turned) / (2 * np.pi * radius_m)
                told = np.abs(steps - np.rint(steps))
                far, moving = np.sum(told > speeds.FAR_TURN), np.sum(told > speeds.MOVING_TURN)
                stops = far >= max(speeds.LEAST_FAR, speeds.FAR_SHARE * moving)
                is_wrong = np.abs(np.rint(steps)).sum() > 0.02 * np.abs(steps).sum()
                is_below = np.abs(steps).max() < 0.5
                wrong, stopped_wrong = wrong + is_wrong, stopped_wrong + (stops and is_wrong)
                below, stopped_below = below + is_below, stopped_below + (stops and is_below)
    print(f"positions within one turn: {stopped_wrong} of {wrong} that are wrong by more than 2 % "
          f"of the way stop, {stopped_below} of {below} that stay below half a turn")  # fmt: skip


if __name__ == "__main__":
    main()
