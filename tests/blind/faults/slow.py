"""Faults that come slowly: a map whose scale drifts, a gyroscope whose bias wanders."""

import numpy as np

from tests.blind.faults.fault import Fault

GOOD = frozenset({"good pose", "gyro"})


def drift_scale(recording, rng):
    """Steps of visual odometry: their scale goes from one to 0.75 ... 1.3, over the recording."""
    table = recording["pose"]
    share = np.linspace(0, 1, len(table["t"]) - 1) ** rng.choice([0.7, 1.0, 1.5])
    scale = 1 + share * rng.choice([rng.uniform(-0.25, -0.12), rng.uniform(0.15, 0.3)])
    x, y = (
        table[name][0] + np.append(0.0, np.cumsum(scale * np.diff(table[name])))
        for name in ("x", "y")
    )
    return recording.with_columns("pose", x=x, y=y)


def wander(recording, rng):
    """A bias that goes to and fro once or twice in the recording."""
    t = recording["odometry"]["t"]
    size, period_s = rng.uniform(0.012, 0.035), rng.uniform(0.4, 1.2) * np.ptp(t)
    bias = size * np.sin(2 * np.pi * (t - t[0]) / period_s + rng.uniform(0, 2 * np.pi))
    return recording.with_columns("odometry", gyro_z=recording["odometry"]["gyro_z"] + bias)


# fmt: off
FAULTS = (
    Fault("pose_scale_drifts", "warning", "the scale of the map drifts",
          ("scale map drift",), drift_scale, GOOD),
    Fault("gyro_bias_wanders", "note", "the bias of the gyroscope wanders",
          ("bias gyroscope wander",), wander, GOOD),
)
