"""Faults and terrains that were made last: no setting of the modes was chosen with them.

Those of the drive move the robot by other tread speeds than its encoders count, or change the
terrain in patches; those of the record change tables of its run folder.
"""

import numpy as np

from tests.blind.commands import RATE_HZ
from tests.blind.modes import worlds


def patches_of_unseen_terrain(world, commands, labels, onset, rng):
    """Every few seconds the robot crosses some metres of a terrain that was not calibrated."""
    other, at, labels = rng.choice(world.unseen), onset, labels.copy()
    while at < len(labels):
        lasts = round(rng.uniform(2.0, 5.0) * RATE_HZ)
        labels[at : at + lasts] = other
        at += lasts + round(rng.uniform(2.0, 5.0) * RATE_HZ)
    return worlds.moved(world, commands, labels, rng)


def tread_slips_in_bursts(world, commands, labels, onset, rng):
    """One tread loses a part of its speed for a second or two, again and again."""
    share, at = np.ones(len(commands)), onset
    while at < len(commands):
        lasts = round(rng.uniform(0.5, 2.0) * RATE_HZ)
        share[at : at + lasts] = rng.uniform(0.6, 0.85)
        at += lasts + round(rng.uniform(1.0, 3.0) * RATE_HZ)
    moved_by = commands.copy()
    moved_by[:, rng.integers(2)] *= share
    return _counted(world, commands, moved_by, labels, rng)


def cable_dragged(world, commands, labels, onset, rng):
    """A cable holds one side back the more, the farther the robot has gone since."""
    travel_m = np.cumsum(np.abs(commands).mean(axis=1)) / RATE_HZ
    gone_m = np.maximum(travel_m - travel_m[onset], 0.0)
    moved_by = commands.copy()
    moved_by[:, rng.integers(2)] *= 1 - np.minimum(0.01 * rng.uniform(0.5, 1.5) * gone_m, 0.3)
    return _counted(world, commands, moved_by, labels, rng)


def small_turns_are_lost(world, commands, labels, onset, rng):
    """Play in the drive: differences of the treads below some tenths of m/s turn nothing."""
    half = (commands[:, 1] - commands[:, 0]) / 2
    lost_m_s = rng.uniform(0.03, 0.1) * (np.arange(len(commands)) >= onset)
    left = np.sign(half) * np.maximum(np.abs(half) - lost_m_s, 0.0)
    middle = commands.mean(axis=1)
    moved_by = np.column_stack([middle - left, middle + left])
    return _counted(world, commands, moved_by, labels, rng)


def slips_as_it_speeds_up(world, commands, labels, onset, rng):
    """Both treads slip while they change speed."""
    changes = np.abs(np.gradient(commands, 1 / RATE_HZ, axis=0))
    late = (np.arange(len(commands)) >= onset)[:, None]
    slip = np.minimum(rng.uniform(0.1, 0.3) * changes, 0.5) * late
    return _counted(world, commands, commands * (1 - slip), labels, rng)


def _counted(world, commands, moved_by, labels, rng):
    """The robot moves by other tread speeds than its encoders count."""
    found = worlds.moved(world, moved_by, labels, rng)
    return worlds.Motion(found.step_s, commands, found.poses, found.yaw_rates_rad_s, found.labels)


def gyro_soft_limit(recording, onset_s, rng):  # noqa: ARG001
    """It reads less the faster the robot turns, and never more than a limit."""
    values = recording["odometry"]["gyro_z"]
    limit = np.quantile(np.abs(values), 0.99) * rng.uniform(0.8, 1.5)
    return _with_gyro(recording, limit * np.tanh(values / limit))


def gyro_follows_vibration(recording, onset_s, rng):  # noqa: ARG001
    """Its bias grows with the speed of the treads."""
    table = recording["odometry"]
    speed = np.abs(table["v_left"] + table["v_right"]) / 2
    return _with_gyro(
        recording, table["gyro_z"] + rng.choice([-1, 1]) * rng.uniform(0.02, 0.08) * speed
    )


def gyro_filtered(recording, onset_s, rng):  # noqa: ARG001
    """A filter with a time constant of half a second and more."""
    values, share = recording["odometry"]["gyro_z"], 1 / (RATE_HZ * rng.uniform(0.5, 1.5))
    followed = [values[0]]
    for value in values[1:]:
        followed.append(followed[-1] + share * (value - followed[-1]))
    return _with_gyro(recording, np.array(followed))


def wheels_wear(recording, onset_s, rng):
    """Both counts drift away from the way that was gone, one of them faster."""
    table = recording["odometry"]
    since_s = np.maximum(table["t"] - onset_s, 0.0)
    drifts = rng.uniform(0.0, 0.006, 2) * rng.choice([-1, 1])
    scaled = {
        side: table[side] * (1 + drift * since_s)
        for side, drift in zip(("v_left", "v_right"), drifts, strict=True)
    }
    return recording.with_columns("odometry", **scaled)


def poses_in_bursts(recording, onset_s, rng):  # noqa: ARG001
    """Positions and headings err together for some seconds at a time."""
    pose = recording["pose"]
    bad = (pose["t"] // rng.uniform(1.5, 4.0)).astype(int) % 2 == 0
    x, y = (pose[name] + bad * rng.normal(0.0, 0.5) for name in ("x", "y"))
    yaw = pose["yaw"] + bad * rng.normal(0.0, 0.3)
    return recording.with_columns("pose", x=x, y=y, yaw=np.angle(np.exp(1j * yaw)))


def _with_gyro(recording, values):
    return recording.with_columns("odometry", gyro_z=values)


OF_DRIVE = {
    f"further_{fault.__name__}": fault
    for fault in (
        patches_of_unseen_terrain,
        tread_slips_in_bursts,
        cable_dragged,
        small_turns_are_lost,
        slips_as_it_speeds_up,
    )
}
OF_RECORD = {
    f"further_{fault.__name__}": fault
    for fault in (
        gyro_soft_limit,
        gyro_follows_vibration,
        gyro_filtered,
        wheels_wear,
        poses_in_bursts,
    )
}
FURTHER = (*OF_DRIVE, *OF_RECORD)
