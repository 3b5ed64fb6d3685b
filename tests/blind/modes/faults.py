"""Faults of runs in modes, from a moment on: twelve that the study names, and some without a name.

Those of the drive befall the robot; those of the record change tables of its run folder.
"""

from dataclasses import dataclass

import numpy as np

from tests.blind.commands import RATE_HZ
from tests.blind.faults.catalogue import FAULTS
from tests.blind.faults.recordings import read_recording, write_recording
from tests.blind.modes import further_faults, robot_faults, worlds
from tests.blind.modes.more_faults import MORE


@dataclass(frozen=True, eq=False)
class Case:
    """A run folder, and from when on something is wrong.

    Attributes
    ----------
    folder : Path
    onset_s : float
        By the stamps of the run.
    """

    folder: object
    onset_s: float


def make_case(world, fault, seed, folder):
    """Write the run of a fault below a folder; "clean" has none.

    The drive of a seed is the same for all, and is kept in the folder for the faults of records.
    """
    rng = np.random.default_rng([seed, *world.key.encode()])
    commands, labels, onset = worlds.draw_drive(world, rng)
    drawn = np.random.default_rng([seed, *world.key.encode(), *fault.encode()])
    recorded = folder / (fault if fault in OF_DRIVE else "clean")
    if not recorded.exists():
        motion = OF_DRIVE.get(fault, _as_driven)(world, commands, labels, onset, drawn)
        worlds.written(world, motion, rng, recorded)
    recording = read_recording(recorded)
    onset_s = float(recording["odometry"]["t"][onset])
    if fault in OF_RECORD and not (folder / fault).exists():
        faulty = OF_RECORD[fault](recording, onset_s, drawn)
        write_recording(_from(recording, faulty, onset_s), folder / fault)
    return Case(folder / fault, onset_s)


def _from(recording, faulty, onset_s):
    """The rows of the faulty one from a time on, those of the recording before it."""
    for name in recording.tables:
        before, after = recording[name], faulty[name]
        rows = {
            key: np.concatenate([column[before["t"] < onset_s], after[key][after["t"] >= onset_s]])
            for key, column in before.items()
        }
        faulty = faulty.with_table(name, rows)
    return faulty


def _as_driven(world, commands, labels, onset, rng):  # noqa: ARG001
    return worlds.moved(world, commands, labels, rng)


def unseen_terrain(world, commands, labels, onset, rng):
    other = rng.choice(world.unseen)
    labels = np.where(np.arange(len(labels)) < onset, labels, other)
    return worlds.moved(world, commands, labels, rng)


def double_speed(world, commands, labels, onset, rng):
    factor = np.clip((np.arange(len(commands)) - onset) / RATE_HZ, 0.0, 1.0) + 1.0
    return worlds.moved(world, commands * factor[:, None], labels, rng)


def slope(world, commands, labels, onset, rng):
    return worlds.on_a_slope(world, commands, labels, onset, rng)


def _gyro(change):
    def draw(recording, onset_s, rng):
        table = recording["odometry"]
        values = change(table["gyro_z"].copy(), table["t"] >= onset_s, rng)
        return recording.with_columns("odometry", gyro_z=values)

    return draw


def _whole(key):
    """A fault of tests/blind/faults."""
    return lambda recording, onset_s, rng: FAULTS[key].draw(recording, rng)  # noqa: ARG005


def _scaled(values, late, rng):  # noqa: ARG001
    low, high = [(0.6, 0.9), (1.1, 1.6)][rng.integers(2)]
    return values * rng.uniform(low, high)


def _spiky(values, late, rng):
    """1 to 5 % of the samples are absurd."""
    rows = np.flatnonzero(late & (rng.random(len(values)) < rng.uniform(0.01, 0.05)))
    values[rows] = rng.choice([-1, 1], len(rows)) * np.exp(
        rng.uniform(*np.log([2, 100]), len(rows))
    )
    return values


def _frozen(values, late, rng):  # noqa: ARG001
    values[late] = values[np.flatnonzero(late)[0]]
    return values


def _noisy(values, late, rng):
    return values + late * rng.normal(0.0, rng.uniform(0.1, 0.3), len(values))


def _clipped(values, late, rng):  # noqa: ARG001
    limit = np.quantile(np.abs(values), 0.99) * rng.uniform(0.3, 0.5)
    return np.clip(values, -limit, limit)


def _drifting(values, late, rng):
    """A bias that walks by some hundredths in ten seconds."""
    walk = np.cumsum(late * rng.normal(0.0, 0.02 * rng.uniform(0.5, 1.5) / 22.0, len(values)))
    return values + walk


def _delayed(values, late, rng):  # noqa: ARG001
    rows = round(rng.uniform(0.3, 0.8) * RATE_HZ)
    return np.concatenate([values[:1].repeat(rows), values[:-rows]])


def poses_late(recording, onset_s, rng):
    """A pose says where the robot was a moment ago."""
    pose, late_s = recording["pose"], rng.uniform(0.15, 0.6)
    late = pose["t"] >= onset_s
    then = np.where(late, pose["t"] - late_s, pose["t"])
    x, y, yaw = (
        np.interp(then, pose["t"], column)
        for column in (pose["x"], pose["y"], np.unwrap(pose["yaw"]))
    )
    return recording.with_columns("pose", x=x, y=y, yaw=np.angle(np.exp(1j * yaw)))


def wheel_scale(recording, onset_s, rng):  # noqa: ARG001
    table = recording["odometry"]
    factor = rng.uniform(1.04, 1.15) ** rng.choice([-1, 1])
    side = ("v_left", "v_right")[rng.integers(2)]
    return recording.with_columns("odometry", **{side: table[side] * factor})


def dropouts(recording, onset_s, rng):
    """Rows of odometry are lost, up to a second at a time, and cells of the gyroscope."""
    table = recording["odometry"]
    t = table["t"]
    lost, silent = np.zeros((2, len(t)), dtype=bool)
    at_s = onset_s
    while at_s < t[-1]:
        lasts_s = rng.uniform(0.1, 1.0)
        which = lost if rng.random() < 0.5 else silent
        which |= (t >= at_s) & (t < at_s + lasts_s)
        at_s += lasts_s + rng.uniform(0.3, 3.0)
    lost[-1] = False
    gyro = np.where(silent, np.nan, table["gyro_z"])
    return recording.with_columns("odometry", gyro_z=gyro).with_rows("odometry", ~lost)


def stuck_tread(recording, onset_s, rng):
    table = recording["odometry"]
    side = ("v_left", "v_right")[rng.integers(2)]
    held = 0.0 if rng.random() < 0.5 else table[side][np.flatnonzero(table["t"] >= onset_s)[0]]
    return recording.with_columns("odometry", **{side: np.full(len(table["t"]), held)})


def treads_delayed(recording, onset_s, rng):  # noqa: ARG001
    table, rows = recording["odometry"], round(rng.uniform(0.3, 0.8) * RATE_HZ)
    late = {
        side: np.concatenate([table[side][:1].repeat(rows), table[side][:-rows]])
        for side in ("v_left", "v_right")
    }
    return recording.with_columns("odometry", **late)


def _effect(name, **values):
    """An effect of tests/blind/effects on the drive, from the onset on."""

    def befall(world, commands, labels, onset, rng):
        start = (0.0, 0.0, 0.0)
        before = world.moves(commands[: onset + 1], labels[: onset + 1], start)
        drawn = {key: rng.uniform(*of) for key, of in values.items()}
        after = world.moves(
            commands[onset:], labels[onset:], before.poses[-1, [0, 1, 4]], **{name: drawn}
        )
        return worlds.Motion(
            before.step_s,
            commands,
            np.concatenate([before.poses[:-1], after.poses]),
            np.concatenate([before.yaw_rates_rad_s[:-1], after.yaw_rates_rad_s]),
            labels,
        )

    return befall


OF_DRIVE = (
    {
        "unseen_terrain": unseen_terrain,
        "double_speed": double_speed,
        "slope": slope,
        "own_ripple": _effect(
            "unknown_ripple", amplitude_rad_m=(0.15, 0.6), phase_rad=(-np.pi, np.pi)
        ),
    }
    | further_faults.OF_DRIVE
    | robot_faults.OF_DRIVE
)
OF_RECORD = (
    {
        "gyro_bias": _whole("gyro_bias"),
        "gyro_scale": _gyro(_scaled),
        "gyro_spikes": _gyro(_spiky),
        "gyro_frozen": _gyro(_frozen),
        "poses_late": poses_late,
        "treads_swapped": _whole("treads_swapped"),
        "wheel_scale": wheel_scale,
        "dropouts": dropouts,
        "gyro_in_degrees": _whole("gyro_in_degrees"),
        "own_gyro_noise": _gyro(_noisy),
        "own_gyro_clipped": _gyro(_clipped),
        "own_gyro_drift": _gyro(_drifting),
        "own_gyro_late": _gyro(_delayed),
        "own_gyro_sign": _whole("gyro_reversed"),
        "own_stuck_tread": stuck_tread,
        "own_tread_offset": _whole("tread_offset"),
        "own_treads_late": treads_delayed,
    }
    | MORE
    | further_faults.OF_RECORD
    | robot_faults.OF_RECORD
)
NAMED = (
    "gyro_bias",
    "gyro_scale",
    "gyro_spikes",
    "gyro_frozen",
    "poses_late",
    "treads_swapped",
    "unseen_terrain",
    "double_speed",
    "slope",
    "wheel_scale",
    "dropouts",
    "gyro_in_degrees",
)
OWN = tuple(key for key in (*OF_DRIVE, *OF_RECORD) if key.startswith("own"))


def possible(world, fault):
    """Whether a fault can befall a world: contacts do not know the ripple."""
    return fault != "own_ripple" or world.key.startswith("formula")
