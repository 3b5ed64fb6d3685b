"""Faults of tread speeds at moments of the run: stuck, absurd, coarse, limited, smoothed."""

import math
from functools import partial

import numpy as np

from tests.blind.faults.fault import (
    Fault,
    UnsuitableError,
    about,
    distance,
    pick_stretch,
)

GOOD = frozenset({"good pose", "gyro"})
STUCK = ("stuck", "frozen", "froze", "stop", "dead", "encoder", "hang", "no longer", "stand")


def stick(side, recording, rng):
    """One encoder holds zero or its last value for 5 to 50 % of the run, at least 1 m wrong."""
    table = recording["odometry"]
    speed, t = table[side], table["t"]
    at_zero = rng.random() < 0.5
    steps = np.diff(t, append=t[-1])

    def value(mask):
        return 0.0 if at_zero else speed[np.flatnonzero(mask)[0] - 1]

    def wrong(mask):
        return np.abs(speed[mask] - value(mask)) @ steps[mask] > 1.0 and np.ptp(speed[mask]) > 0.1

    mask = pick_stretch(rng, t, (0.05, 0.5), (0.1, 0.7), wrong)
    return recording.with_columns("odometry", **{side: np.where(mask, value(mask), speed)})


def put_absurd(recording, rng):
    """One sample of 5 to 100 m/s, on one tread or both, and at least 4 m/s beyond the usual."""
    table = recording["odometry"]
    usual = max(np.abs(table["v_left"]).max(), np.abs(table["v_right"]).max())
    value = rng.choice([-1, 1]) * max(math.exp(rng.uniform(*np.log([5, 100]))), usual + 4)
    row = rng.integers(1, len(table["t"]) - 1)
    sides = [("v_left",), ("v_right",), ("v_left", "v_right")][rng.integers(3)]
    return recording.with_columns(
        "odometry",
        **{side: np.where(np.arange(len(table["t"])) == row, value, table[side]) for side in sides},
    )


def quantise(recording, rng):
    table, step = recording["odometry"], rng.uniform(0.05, 0.2)
    return recording.with_columns(
        "odometry",
        v_left=np.rint(table["v_left"] / step) * step,
        v_right=np.rint(table["v_right"] / step) * step,
    )


def saturate(recording, rng):
    """The counter overflows: speeds beyond 40 to 70 % of the largest are cut."""
    table = recording["odometry"]
    both = np.abs([table["v_left"], table["v_right"]])
    limit = np.quantile(both, 0.995) * rng.uniform(0.4, 0.7)
    if np.mean(both.max(axis=0) > 1.15 * limit) < 0.1:
        raise UnsuitableError
    return recording.with_columns(
        "odometry",
        v_left=np.clip(table["v_left"], -limit, limit),
        v_right=np.clip(table["v_right"], -limit, limit),
    )


def smooth(recording, rng):
    """A low-pass filter of first order in the driver, time constant 0.4 to 1.5 s."""
    table, constant = recording["odometry"], rng.uniform(0.4, 1.5)
    kept = np.exp(-np.diff(table["t"], prepend=table["t"][0]) / constant)
    result = {}
    for side in ("v_left", "v_right"):
        state, out = table[side][0], []
        for value, keep in zip(table[side], kept, strict=True):
            state = value + (state - value) * keep
            out.append(state)
        result[side] = np.array(out)
    return recording.with_columns("odometry", **result)


def delay(recording, rng):
    """Tread speeds come 0.2 to 0.6 s late, gyroscope and poses do not."""
    table, late = recording["odometry"], rng.uniform(0.2, 0.6)
    return recording.with_columns(
        "odometry",
        **{
            side: np.interp(table["t"] - late, table["t"], table[side])
            for side in ("v_left", "v_right")
        },
    )


def drop_out(recording, rng):
    """Lost messages read as zero: 5 to 20 % of the rows, one tread or both."""
    table = recording["odometry"]
    lost = rng.random(len(table["t"])) < rng.uniform(0.05, 0.2)
    sides = [("v_left",), ("v_right",), ("v_left", "v_right")][rng.integers(3)]
    return recording.with_columns(
        "odometry", **{side: np.where(lost, 0.0, table[side]) for side in sides}
    )


def carry(recording, rng):
    """The robot moves at least 2 m by wheels that read zero: carried, towed, or no encoders."""
    table = recording["odometry"]

    def moves(mask):
        way, _ = distance(table, mask)
        return way > 2.0 and np.ptp(table["t"][mask]) < 60

    mask = pick_stretch(rng, table["t"], (0.05, 0.4), (0.1, 0.8), moves)
    return recording.with_columns(
        "odometry",
        v_left=np.where(mask, 0.0, table["v_left"]),
        v_right=np.where(mask, 0.0, table["v_right"]),
    )


def leave_cells_empty(recording, rng):
    side = rng.choice(["v_left", "v_right"])
    speed = recording["odometry"][side].copy()
    start = rng.integers(1, len(speed) - 25)
    speed[start : start + rng.integers(1, 20)] = math.nan
    return recording.with_columns("odometry", **{side: speed})


# fmt: off
FAULTS = (
    Fault("tread_left_stuck", "warning", "The left encoder is stuck for a part of the run.",
          about(["left"], STUCK), partial(stick, "v_left"), GOOD, named=True),
    Fault("tread_right_stuck", "warning", "The right encoder is stuck for a part of the run.",
          about(["right"], STUCK), partial(stick, "v_right"), GOOD, named=True),
    Fault("tread_absurd_sample", "warning", "A single sample no robot can drive.",
          ("single", "spike", "sample", "outlier", "glitch", "absurd", "corrupt", "one row",
           "transmission"), put_absurd, named=True),
    Fault("treads_quantised", "note", "Speeds come in steps of 0.05 to 0.2 m/s.",
          ("quanti", "step", "resolution", "coarse", "round"), quantise, named=True),
    Fault("treads_saturate", "warning", "Speeds are cut at a limit below the true ones.",
          ("satur", "clip", "limit", "cut", "overflow"), saturate, GOOD),
    Fault("treads_smoothed", "warning", "A low-pass filter delays the speeds.",
          ("smooth", "filter", "lag", "late", "delay", "low-pass"), smooth, GOOD,
          ("treads_late",)),
    Fault("treads_late", "warning", "The tread speeds are late.",
          about(("tread", "wheel", "odometry", "encoder"), ("late", "delay", "lag", "behind",
          "latenc", "clock", r"time\b", "stamp")), delay, GOOD),
    Fault("treads_drop_out", "warning", "Lost messages read as zero speed.",
          ("drop", "lost", "zero", "intermit", "missing"), drop_out, GOOD),
    Fault("treads_zero_while_moving", "warning", "The robot moves while the wheels read zero.",
          ("carried", "towed", "pushed", "lifted", "encoder", "stuck", "slid", "moved by hand",
           "by hand"), carry, GOOD),
    Fault("treads_with_empty_cells", "refused", "Tread speeds are missing in some rows.",
          ("empty", "nan", "missing", "number", "finite"), leave_cells_empty),
)
# fmt: on
