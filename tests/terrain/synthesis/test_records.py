"""What the sensors of a made run show of its motion."""

from dataclasses import replace

import numpy as np

from odometry.simulation.drive import Drive
from terrain.synthesis.config import SynthesisConfig
from terrain.synthesis.records import measured_twists, motion_tables

STEP_S = 0.05


def test_turns_that_are_integrated_from_the_gyroscope_are_those_of_the_truth(rng):
    """By the trapezoidal rule, as estimators do, wherever the rate does not just change."""
    rates = np.repeat(rng.uniform(-0.6, 0.6, 20), 7)  # held, as tread speeds are, and changed
    count = len(rates)
    stamps_s = STEP_S * np.arange(count)
    yaw = np.append(0.0, np.cumsum(rates[:-1]) * STEP_S)
    flat = np.zeros((count, 2))
    drive = Drive(
        stamps_s,
        np.column_stack([flat, yaw]),
        flat,
        np.column_stack([flat, rates]),
        np.zeros((count, 3)),
        ("grass",) * count,
    )
    tables = motion_tables(replace(SynthesisConfig(), sigma_gyro_rad_s=0.0), drive, rng)
    shown = tables["odometry"]["gyro_z"]
    np.testing.assert_array_equal(shown, measured_twists(drive)[:, 2])
    turned = np.append(0.0, np.cumsum((shown[1:] + shown[:-1]) / 2 * STEP_S))
    steady = np.flatnonzero(np.append(rates[1:] == rates[:-1], False) & (shown == rates))
    np.testing.assert_allclose(turned[steady], yaw[steady], atol=1e-12)
