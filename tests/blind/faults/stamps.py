"""Faults of stamps and clocks."""

import numpy as np

from tests.blind.faults.fault import Fault, UnsuitableError, distance

EPOCH_S = 1.7e9
CLOCK = ("clock", "time zone", "synchron", "epoch", "1970", "overlap", "hour")
BACK = ("back", "decreas", "order", "earlier", "sorted", "not increas")


def _in_units(factor, epoch):
    def draw(recording, rng):
        start = EPOCH_S + rng.uniform(0, 3e7) if epoch and rng.random() < 0.5 else 0.0
        return recording.restamped(lambda t: np.rint((t + start) * factor).astype(np.int64))

    return draw


def one_file_in_another_unit(recording, rng):
    factor = 10.0 ** rng.choice([3, 6, 9])
    return recording.restamped(lambda t: np.rint(t * factor).astype(np.int64), ["pose"])


def repeat_rows(recording, rng):
    name = rng.choice([name for name in ("odometry", "pose") if name in recording])
    count = len(recording[name]["t"])
    rows = np.sort(np.r_[np.arange(count), rng.integers(0, count, rng.integers(1, 4))])
    return recording.with_rows(name, rows)


def step_back(recording, rng):
    """From one row on, the stamps are earlier by 0.2 to 30 s."""
    name = rng.choice([name for name in ("odometry", "pose") if name in recording])
    t = recording[name]["t"]
    row = rng.integers(len(t) // 10, len(t) * 9 // 10)
    back = rng.uniform(0.2, 30.0) + t[row] - t[row - 1]
    rows = slice(row, row + 1) if rng.random() < 0.5 else slice(row, None)
    moved = t.copy()
    moved[rows] -= back
    return recording.with_columns(name, t=moved)


def shuffle_rows(recording, rng):
    """Blocks of rows in another order, as parallel exports write them."""
    blocks = np.array_split(np.arange(len(recording["odometry"]["t"])), rng.integers(3, 30))
    order = rng.permutation(len(blocks))
    if np.all(np.diff(order) > 0):
        order = order[::-1]
    return recording.with_rows("odometry", np.concatenate([blocks[block] for block in order]))


def write_twice(recording, rng):
    name = rng.choice([name for name in ("odometry", "pose") if name in recording])
    rows = np.arange(len(recording[name]["t"]))
    return recording.with_rows(name, np.r_[rows, rows])


def lose_rows(recording, rng):
    """Rows of 3 to 20 s are missing where the held speeds would lead at least 1 m astray."""
    table = recording["odometry"]
    t, left, right = table["t"], table["v_left"], table["v_right"]
    for _ in range(500):
        start, length = rng.uniform(t[0], t[-1]), rng.uniform(3.0, 20.0)
        lost = (t >= start) & (t < start + length)
        if lost.sum() < 5 or lost[0] or lost[-1] or not distance(table, lost)[0]:
            continue
        before = np.flatnonzero(lost)[0] - 1
        steps = np.diff(t, append=t[-1])[lost]
        astray = np.abs(
            [(left[lost] - left[before]) @ steps, (right[lost] - right[before]) @ steps]
        )
        if astray.max() > 1.0 and max(abs(left[before]), abs(right[before])) > 0.1:
            return recording.with_rows("odometry", ~lost)
    raise UnsuitableError


def drift(recording, rng):
    """Stamps of poses run fast or slow by 0.5 to 2 %, at least 0.8 s at the end."""
    t = recording["pose"]["t"]
    least = max(0.005, 0.8 / (t[-1] - t[0]))
    if least > 0.02:
        raise UnsuitableError
    rate = 1 + rng.choice([-1, 1]) * rng.uniform(least, 0.02)
    return recording.restamped(lambda t: t[0] + (t - t[0]) * rate, ["pose"])


def jump_ahead(recording, rng):
    """The clock of one file is set ahead by a minute to an hour in the midst of the run."""
    name = rng.choice(["odometry", "pose"])
    ahead = np.exp(rng.uniform(np.log(60), np.log(3600)))
    moment = np.quantile(recording[name]["t"], rng.uniform(0.2, 0.8))
    return recording.restamped(lambda t: np.where(t > moment, t + ahead, t), [name])


def other_time_zone(recording, rng):
    start = EPOCH_S + rng.uniform(0, 3e7)
    hours = rng.choice([-1, 1]) * rng.integers(1, 13)
    return recording.restamped(lambda t: t + start).restamped(
        lambda t: t + 3600.0 * hours, ["pose"]
    )


def one_file_since_1970(recording, rng):
    start = EPOCH_S + rng.uniform(0, 3e7)
    return recording.restamped(lambda t: t + start, [rng.choice(["odometry", "pose"])])


def round_stamps(recording, rng):
    """Whole seconds, or the ten digits that a careless print keeps of an epoch stamp."""
    if rng.random() < 0.5:
        return recording.restamped(np.floor)
    start = EPOCH_S + rng.uniform(0, 3e7)
    return recording.restamped(lambda t: np.floor(t + start))


def stamp_on_arrival(recording, rng):
    """Rows come in bunches of 8 to 30 and are stamped as they arrive."""
    t = recording["odometry"]["t"]
    bunch = rng.integers(8, 31)
    arrival = t[np.minimum((np.arange(len(t)) // bunch + 1) * bunch, len(t)) - 1]
    return recording.with_columns("odometry", t=arrival + 1e-4 * (np.arange(len(t)) % bunch))


def stamp_few_on_arrival(recording, rng, file="odometry"):
    """As a serial port or a network hands on what it has: 2 to 7 rows, milliseconds apart."""
    t = recording[file]["t"]
    most = int(rng.integers(2, 8))
    sizes = rng.integers(max(most - 2, 2), most + 1, len(t))
    last = np.minimum(np.cumsum(sizes), len(t)) - 1
    burst = np.searchsorted(last, np.arange(len(t)))
    place = np.arange(len(t)) - np.concatenate([[-1], last])[burst] - 1
    return recording.with_columns(file, t=t[last[burst]] + rng.uniform(1e-4, 1e-3) * place)


def stamp_few_poses_on_arrival(recording, rng):
    return stamp_few_on_arrival(recording, rng, "pose")


def write_dates(recording, rng):
    start = np.datetime64("2024-07-29T14:04:00", "ms") + np.int64(rng.integers(0, 10**10))
    return recording.restamped(
        lambda t: (start + np.rint(t * 1000).astype("timedelta64[ms]")).astype(str).astype(object)
    )


POSE = frozenset({"pose"})
FAULTS = (
    Fault("stamps_in_ns", "refused", "Stamps of all files are in nanoseconds.",
          ("nanosecond", r"ns\b"), _in_units(1e9, epoch=True), named=True),
    Fault("stamps_in_us", "refused", "Stamps of all files are in microseconds.",
          ("microsecond", r"us\b", "µs"), _in_units(1e6, epoch=True), named=True),
    Fault("stamps_in_ms", "refused", "Stamps of all files are in milliseconds.",
          ("millisecond", r"ms\b"), _in_units(1e3, epoch=True), named=True),
    Fault("pose_stamps_in_another_unit", "refused", "Only the poses' stamps are in ms, us or ns.",
          ("millisecond", "microsecond", "nanosecond", r"ms\b", r"us\b", r"ns\b"),
          one_file_in_another_unit, POSE),
    Fault("rows_repeated", "note", "Rows are written twice in a row.",
          ("repeat", "twice", "duplicat", "same stamp"), repeat_rows, named=True,
          harmless=True),
    Fault("stamps_go_back", "refused", "Stamps go back at one row.", BACK, step_back, named=True),
    Fault("rows_in_disorder", "refused", "Blocks of rows are out of order.", BACK, shuffle_rows),
    Fault("file_written_twice", "refused", "All rows of a file follow once more.",
          (*BACK, "twice", "duplicat", "repeat"), write_twice),
    Fault("rows_lost", "warning", "Odometry rows are missing while the robot drives on.",
          ("gap", "missing", "lost", "drop", "interrupt"), lose_rows,
          frozenset({"good pose", "gyro"}), named=True),
    Fault("pose_clock_drifts", "warning", "The clock of the poses runs fast or slow.",
          ("clock", "drift", "run apart"), drift, frozenset({"good pose"}), named=True),
    Fault("clock_set_ahead", "warning", "The clock of one file is set ahead during the run.",
          (*CLOCK, "jump", "set ahead"), jump_ahead, POSE),
    Fault("pose_in_other_time_zone", "warning", "Poses are stamped in another time zone.",
          CLOCK, other_time_zone, POSE, ("one_file_since_1970",)),
    Fault("one_file_since_1970", "warning", "One file counts from 1970, another from its start.",
          CLOCK, one_file_since_1970, POSE, ("pose_in_other_time_zone",)),
    Fault("stamps_rounded", "warning", "Stamps are rounded to whole seconds.",
          ("round", "resolution", "whole second", "digit", "precision", "truncat", "coarse"),
          round_stamps),
    Fault("stamped_on_arrival", "warning", "Rows come in bunches and are stamped on arrival.",
          ("burst", "bunch", "arriv", "batch", "buffer", "receiv"), stamp_on_arrival),
    Fault("stamped_few_on_arrival", "note", "Rows come two to seven at once, with such stamps.",
          ("burst", "bunch", "arriv", "batch", "buffer", "receiv"), stamp_few_on_arrival),
    Fault("poses_stamped_few_on_arrival", "note", "Poses come two to seven at once, so stamped.",
          ("burst", "bunch", "arriv", "batch", "buffer", "receiv"), stamp_few_poses_on_arrival,
          POSE),
    Fault("stamps_are_dates", "refused", "Stamps are written as dates, not as seconds.",
          ("date", "second", "number", "text", "numeric"), write_dates),
)  # fmt: skip
