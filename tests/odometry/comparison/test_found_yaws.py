"""Models compared where yaw was found from positions, and may be off alike all along."""

import numpy as np

from odometry.comparison.compare import compare
from tests.odometry.positions_drives import drive, emptied


def narrowest(compared, quantity):
    """Half of the narrowest interval of a difference."""
    intervals = [each.interval for each in compared.differences if each.quantity == quantity]
    return min(min(each.high - each.mean, each.mean - each.low) for each in intervals)


def test_intervals_in_translation_are_as_wide_as_a_yaw_may_be_off():
    run = drive(6, noise_m=0.01, gyroscope=True)
    measured, found = compare([run]), compare([emptied(run)])
    three_degrees = 1.96 * np.radians(3.0)
    assert narrowest(measured, "translation") < three_degrees < narrowest(found, "translation")
    assert narrowest(found, "rotation") < 10 * narrowest(measured, "rotation")
    assert any("intervals of differences in translation are wider" in note for note in found.notes)
