"""Faults of the record of a robot of any size and pace, from a moment on."""

import numpy as np


def gyro_bias(record, rng):
    """As a bad gyroscope has, or as large as the turns."""
    usual = float(np.sqrt(np.mean(record.moved.turn**2)))
    size = rng.uniform(0.02, 0.08) if rng.random() < 0.5 else rng.uniform(0.1, 0.5) * usual
    record.odometry["gyro_z"] = record.gyro + record.late * size * rng.choice([-1, 1])


def gyro_scale(record, rng):
    low, high = [(0.6, 0.9), (1.1, 1.6)][rng.integers(2)]
    _from_onset(record, "gyro_z", record.gyro * rng.uniform(low, high))


def gyro_spikes(record, rng):
    count = len(record.gyro)
    hit = record.late & (rng.random(count) < rng.uniform(0.01, 0.05))
    spikes = rng.choice([-1, 1], count) * rng.uniform(2, 100, count)
    record.odometry["gyro_z"] = np.where(hit, spikes, record.gyro)


def gyro_frozen(record, rng):  # noqa: ARG001
    _from_onset(record, "gyro_z", record.gyro[record.late.argmax()])


def gyro_in_degrees(record, rng):  # noqa: ARG001
    _from_onset(record, "gyro_z", np.rad2deg(record.gyro))


def poses_late(record, rng):
    if record.pose is None:
        return
    t = record.pose["t"]
    then = t - (t >= record.onset_s) * rng.uniform(0.15, 0.6)
    late = {key: np.interp(then, t, column) for key, column in record.pose.items()}
    record.pose = late | {"t": t}


def treads_swapped(record, rng):  # noqa: ARG001
    left, right = record.odometry["v_left"], record.odometry["v_right"]
    _from_onset(record, "v_left", right)
    _from_onset(record, "v_right", left)


def wheel_scale(record, rng):
    side = ("v_left", "v_right")[rng.integers(2)]
    factor = rng.uniform(1.04, 1.15) ** rng.choice([-1, 1])
    _from_onset(record, side, factor * record.odometry[side])


def dropouts(record, rng):
    """Rows of odometry are lost, up to a second at a time."""
    t = record.odometry["t"]
    kept, at_s = np.ones(len(t), dtype=bool), record.onset_s
    while at_s < t[-1]:
        gone_s = rng.uniform(0.1, 1.0)
        kept &= (t < at_s) | (t >= at_s + gone_s)
        at_s += gone_s + rng.uniform(0.3, 3.0)
    record.odometry = {key: column[kept] for key, column in record.odometry.items()}


def _from_onset(record, name, values):
    record.odometry[name] = np.where(record.late, values, record.odometry[name])


FAULTS = {
    fault.__name__: fault
    for fault in (
        gyro_bias,
        gyro_scale,
        gyro_spikes,
        gyro_frozen,
        poses_late,
        treads_swapped,
        wheel_scale,
        dropouts,
        gyro_in_degrees,
    )
}
