"""Drives whose equations are integrated here, in small steps, by code of their own."""

from pathlib import Path

import numpy as np

from odometry.recording.run import Robot, Run
from odometry.tables.table import Table

ROBOT = Robot(track_width=0.5, length=0.8)
PIECES = 4  # of a step, in which equations are integrated


def integrated(rates, state, lasts_s, pieces):
    """The state (..., n) after a time: Runge and Kutta's fourth order in so many equal pieces."""
    h = lasts_s / pieces
    for _ in range(pieces):
        first = rates(state)
        second = rates(state + h / 2 * first)
        third = rates(state + h / 2 * second)
        fourth = rates(state + h * third)
        state = state + h / 6 * (first + 2 * second + 2 * third + fourth)
    return state


def wandering(rng, size, step_s, *, hold_s=1.0, turn_m_s=0.5):
    """Tread speeds (size, 2) that jump each `hold_s`: 0.2 to 1 m/s, turning to both sides."""
    times = np.ceil(size * step_s / hold_s).astype(int)
    speed, turn = rng.uniform(0.2, 1.0, times), rng.uniform(-turn_m_s, turn_m_s, times)
    held = np.minimum((np.arange(size) * step_s / hold_s).astype(int), times - 1)
    return np.column_stack([speed - turn / 2, speed + turn / 2])[held]


def velocities(A, B, treads, step_s, start=(0.5, 0.0)):
    """Speed and yaw rate (N, 2) of A and B (N, 2, 2), each in force to the next stamp."""
    states = [np.array(start)]
    for a, b, u in zip(A[:-1], B[:-1], treads[:-1], strict=True):
        pushed = b @ u
        states.append(integrated(lambda q, a=a, p=pushed: a @ q + p, states[-1], step_s, PIECES))
    return np.array(states)


def poses_and_yaw_rates(asked, lag_s, step_s):
    """x, y, yaw and yaw rate (N, 4) of twists (N, 3); the turn, at first as asked, follows late.

    As `integrated`: the place does not count for how fast it changes, and is summed up after all.
    """
    h = step_s / PIECES
    turns, stages = [(0.0, float(asked[0, 2]))], []
    for turn in asked[:-1, 2].tolist():
        yaw, omega = turns[-1]
        for _ in range(PIECES):
            first = (turn - omega) / lag_s
            at_second = omega + h / 2 * first
            second = (turn - at_second) / lag_s
            at_third = omega + h / 2 * second
            third = (turn - at_third) / lag_s
            at_fourth = omega + h * third
            fourth = (turn - at_fourth) / lag_s
            stages.append((yaw, yaw + h / 2 * omega, yaw + h / 2 * at_second, yaw + h * at_third))
            yaw += h / 6 * (omega + 2 * at_second + 2 * at_third + at_fourth)
            omega += h / 6 * (first + 2 * second + 2 * third + fourth)
        turns.append((yaw, omega))
    ahead, aside = np.repeat(asked[:-1, :2], PIECES, axis=0).T[..., None]
    c, s = np.cos(stages), np.sin(stages)
    moves = [
        h / 6 * (first + 2 * second + 2 * third + fourth)
        for first, second, third, fourth in ((c * ahead - s * aside).T, (s * ahead + c * aside).T)
    ]
    places = [np.concatenate([[0.0], np.cumsum(move)])[::PIECES] for move in moves]
    return np.column_stack([*places, turns])


def asked_twists(gains, treads, track_width):
    """Twists (N, 3) by gains (2, 3, 5) of left and right turns.

    In terms of the angle whose tangent is the tightness of the turn.
    """
    left, right = np.transpose(treads)
    speed, difference = (left + right) / 2, right - left
    angle = np.arctan2(difference, speed)
    turn = difference / track_width
    terms = [speed, turn, speed * np.sin(angle) ** 2, difference * np.cos(angle) ** 2]
    terms.append(np.abs(speed) * (speed * turn))
    of_turn = np.where((speed * difference < 0)[:, None, None], gains[1], gains[0])
    return np.stack([sum(of_turn[:, n, k] * u for k, u in enumerate(terms)) for n in range(3)], 1)


def gains_of(shared, *of_turns):
    """Gains (2, 3, 5): what u_1 and u_2 move, and what u_3 to u_5 do in left and right turns."""
    return np.stack([np.array([*shared, *of]).T for of in of_turns])


def table(columns):
    return Table(Path("t.csv"), columns, np.arange(len(columns["t"])) + 2)


def run_of_tables(odometry, *, terrain=None, folder="drive", **others):
    """A run of columns by name."""
    said = {} if terrain is None else {"run": {"terrain": terrain}}
    tables = {name: table(columns) for name, columns in others.items()}
    return Run(Path(folder), ROBOT, said, table(odometry), **tables)


def velocity_run(rng, A, B, labels, *, step_s=0.02, sigmas=(0.02, 0.02), **others):
    """Speed and gyroscope at each stamp; A and B by label, labels (N,)."""
    treads = wandering(rng, len(labels), step_s)
    true = velocities([A[n] for n in labels], [B[n] for n in labels], treads, step_s)
    seen = true + rng.normal(size=true.shape) * sigmas
    t = step_s * np.arange(len(labels))
    odometry = {"t": t, "v_left": treads[:, 0], "v_right": treads[:, 1], "gyro_z": seen[:, 1]}
    if None not in labels:
        odometry["terrain"] = np.array(labels, dtype=object)
    velocity = {"t": t, "vx": seen[:, 0], "wz": seen[:, 1]}
    return run_of_tables(odometry, velocity=velocity, **others)


def traction_run(rng, gains, lag_s, *, size=3000, step_s=0.02, turn_m_s=0.5, **others):
    """A gyroscope at each stamp, a pose at each fifth (10 Hz at the usual step)."""
    treads = wandering(rng, size, step_s, turn_m_s=turn_m_s)
    asked = asked_twists(gains, treads, ROBOT.track_width)
    states = poses_and_yaw_rates(asked, lag_s, step_s)
    t = step_s * np.arange(size)
    gyro = states[:, 3] + 0.02 * rng.normal(size=size)
    odometry = {"t": t, "v_left": treads[:, 0], "v_right": treads[:, 1], "gyro_z": gyro}
    x, y, yaw = (states[::5, :3] + rng.normal(size=(len(t[::5]), 3)) * [0.01, 0.01, 0.005]).T
    pose = {"t": t[::5], "x": x, "y": y, "yaw": yaw}
    return run_of_tables(odometry, pose=pose, **others)
