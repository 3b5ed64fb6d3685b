"""What wears, loosens, shifts, sags or warms up on a robot, from a moment on.

Written from what happens to robots, without a look at how modes are recognised. Those of the drive
move the robot by other tread speeds than its encoders count; those of the record change tables.
"""

import numpy as np

from tests.blind.commands import RATE_HZ
from tests.blind.modes import worlds


def payload_shifts(world, commands, labels, onset, rng):
    """A load slides to one side: turns to that side get tighter, to the other side wider."""
    half, middle = (commands[:, 1] - commands[:, 0]) / 2, commands.mean(axis=1)
    late = np.arange(len(commands)) >= onset
    gain = 1 + late * rng.choice([-1, 1]) * rng.uniform(0.03, 0.12) * np.sign(half)
    return _counted(world, commands, (middle, gain * half), labels, rng)


def tyre_goes_flat(world, commands, labels, onset, rng):
    """The tyres of one side lose their air within some ten seconds."""
    since_s = np.maximum(np.arange(len(commands)) - onset, 0) / RATE_HZ
    smaller = rng.uniform(0.04, 0.12) * (1 - np.exp(-since_s / rng.uniform(3.0, 10.0)))
    moved_by = commands.copy()
    moved_by[:, rng.integers(2)] *= 1 - smaller
    half, middle = (moved_by[:, 1] - moved_by[:, 0]) / 2, moved_by.mean(axis=1)
    return _counted(world, commands, (middle, half), labels, rng)


def battery_sags(world, commands, labels, onset, rng):
    """The record holds commands; what the motors make of them falls as they work harder."""
    work = np.abs(np.diff(commands, axis=1)[:, 0]) + np.abs(np.gradient(commands.mean(axis=1)))
    share = 1 - rng.uniform(0.1, 0.3) * np.minimum(work, 1.0) * (np.arange(len(work)) >= onset)
    half, middle = (commands[:, 1] - commands[:, 0]) / 2, commands.mean(axis=1)
    return _counted(world, commands, (share * middle, share * half), labels, rng)


def slack_at_reversals(world, commands, labels, onset, rng):
    """Chains are loose: a tread that changes its direction or its push first takes up slack."""
    pushes, slack_m = np.sign(np.gradient(commands, axis=0)), rng.uniform(0.01, 0.05)
    moved_by, loose_m = commands.copy(), np.zeros(2)
    for row in range(max(onset, 1), len(commands)):
        loose_m[pushes[row] * pushes[row - 1] < 0] = slack_m
        taken_m = np.minimum(loose_m, np.abs(commands[row]) / RATE_HZ * 0.7)
        moved_by[row] -= np.sign(commands[row]) * taken_m * RATE_HZ
        loose_m -= taken_m
    half, middle = (moved_by[:, 1] - moved_by[:, 0]) / 2, moved_by.mean(axis=1)
    return _counted(world, commands, (middle, half), labels, rng)


def _counted(world, commands, moves, labels, rng):
    """The robot moves by other tread speeds than its encoders count."""
    middle, half = moves
    moved_by = np.column_stack([middle - half, middle + half])
    found = worlds.moved(world, moved_by, labels, rng)
    return worlds.Motion(found.step_s, commands, found.poses, found.yaw_rates_rad_s, found.labels)


def encoder_reversed_for_a_while(recording, onset_s, rng):
    """One tread is counted backwards for some seconds, again and again."""
    table, at_s = recording["odometry"], onset_s
    side, sign = ("v_left", "v_right")[rng.integers(2)], np.ones(len(table["t"]))
    while at_s < table["t"][-1]:
        lasts_s = rng.uniform(1.0, 5.0)
        sign[(table["t"] >= at_s) & (table["t"] < at_s + lasts_s)] = -1.0
        at_s += lasts_s + rng.uniform(3.0, 8.0)
    return recording.with_columns("odometry", **{side: table[side] * sign})


def encoders_saturate(recording, onset_s, rng):  # noqa: ARG001
    """Counts come faster than the counter reads them: no speed above a limit."""
    table = recording["odometry"]
    both = np.abs(np.column_stack([table["v_left"], table["v_right"]]))
    limit = np.quantile(both, 0.98) * rng.uniform(0.6, 0.85)
    clipped = {side: np.clip(table[side], -limit, limit) for side in ("v_left", "v_right")}
    return recording.with_columns("odometry", **clipped)


def mount_loosens(recording, onset_s, rng):
    """The IMU rocks on its rubber: it leans more and more, and swings when the robot turns."""
    table = recording["odometry"]
    since_s = np.maximum(table["t"] - onset_s, 0.0)
    lean_rad = np.deg2rad(rng.uniform(10.0, 35.0)) * (1 - np.exp(-since_s / 8.0))
    swing = 0.0 * since_s
    own_hz, speed = rng.uniform(2.0, 6.0) * 2 * np.pi, 0.0
    changes = np.gradient(table["gyro_z"])
    for row in range(1, len(swing)):
        speed += (changes[row] * RATE_HZ - own_hz**2 * swing[row - 1]) / RATE_HZ
        speed *= 1 - 0.3 * own_hz / RATE_HZ
        swing[row] = swing[row - 1] + speed / RATE_HZ
    play = rng.uniform(0.1, 0.4) * own_hz * (since_s > 0)
    return _with_gyro(recording, np.cos(lean_rad) * table["gyro_z"] + play * swing)


def gyro_warms_up(recording, onset_s, rng):
    """Its scale and its bias follow a temperature that rises for half a minute."""
    table = recording["odometry"]
    warm = 1 - np.exp(-np.maximum(table["t"] - onset_s, 0.0) / rng.uniform(5.0, 15.0))
    scale = 1 + warm * rng.choice([-1, 1]) * rng.uniform(0.05, 0.2)
    bias = warm * rng.choice([-1, 1]) * rng.uniform(0.0, 0.02)
    return _with_gyro(recording, table["gyro_z"] * scale + bias)


def gyro_feels_acceleration(recording, onset_s, rng):  # noqa: ARG001
    """It reads a part of the lateral acceleration, which grows with speed and turn rate."""
    table = recording["odometry"]
    lateral = (table["v_left"] + table["v_right"]) / 2 * table["gyro_z"]
    share = rng.choice([-1, 1]) * rng.uniform(0.05, 0.2)
    return _with_gyro(recording, table["gyro_z"] + share * lateral)


def gyro_clock_is_slow(recording, onset_s, rng):
    """Its values come later and later."""
    table = recording["odometry"]
    late_s = rng.uniform(0.01, 0.03) * np.maximum(table["t"] - onset_s, 0.0)
    measured = np.interp(table["t"] - late_s, table["t"], table["gyro_z"])
    return _with_gyro(recording, measured)


def gyro_is_coarse(recording, onset_s, rng):  # noqa: ARG001
    """Eight bits for a wide range."""
    step = rng.uniform(0.05, 0.2)
    return _with_gyro(recording, np.trunc(recording["odometry"]["gyro_z"] / step) * step)


def pose_latency_varies(recording, onset_s, rng):
    """A pose says where the robot was some tenths of a second ago, now more, now less."""
    pose = recording["pose"]
    phase, period_s = rng.uniform(-np.pi, np.pi), rng.uniform(4.0, 15.0)
    late_s = rng.uniform(0.1, 0.4) * (1 + np.sin(2 * np.pi * pose["t"] / period_s + phase))
    then = np.where(pose["t"] >= onset_s, pose["t"] - late_s, pose["t"])
    x, y, yaw = (
        np.interp(then, pose["t"], column)
        for column in (pose["x"], pose["y"], np.unwrap(pose["yaw"]))
    )
    return recording.with_columns("pose", x=x, y=y, yaw=np.angle(np.exp(1j * yaw)))


def positions_wander(recording, onset_s, rng):  # noqa: ARG001
    """Reflections move the positions by some tenths of a metre within seconds."""
    pose = recording["pose"]
    steps = rng.normal(0.0, 1.0, (2, len(pose["t"])))
    moved, keep = np.zeros((2, len(pose["t"]))), np.exp(-1 / (10 * rng.uniform(1.0, 5.0)))
    for row in range(1, moved.shape[1]):
        moved[:, row] = keep * moved[:, row - 1] + steps[:, row]
    moved *= rng.uniform(0.1, 0.5) * np.sqrt(1 - keep**2)
    return recording.with_columns("pose", x=pose["x"] + moved[0], y=pose["y"] + moved[1])


def _with_gyro(recording, values):
    return recording.with_columns("odometry", gyro_z=values)


OF_DRIVE = {
    f"robot_{fault.__name__}": fault
    for fault in (payload_shifts, tyre_goes_flat, battery_sags, slack_at_reversals)
}
OF_RECORD = {
    f"robot_{fault.__name__}": fault
    for fault in (
        encoder_reversed_for_a_while,
        encoders_saturate,
        mount_loosens,
        gyro_warms_up,
        gyro_feels_acceleration,
        gyro_clock_is_slow,
        gyro_is_coarse,
        pose_latency_varies,
        positions_wander,
    )
}
ROBOT = (*OF_DRIVE, *OF_RECORD)
