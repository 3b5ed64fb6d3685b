"""Treads that a filter has smoothed without a delay."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.recording import check_recording
from odometry.checks.treads.smoothed_treads import smoothed_treads
from tests.odometry.checks.drives import stepping, turning_all_round, varied
from tests.odometry.checks.faulty import SENSORS, gyroscope, treads

PERIOD_S = 0.05


def mean_over(values, over_s):
    rows = round(over_s / PERIOD_S)
    return np.convolve(np.pad(values, rows // 2, mode="edge"), np.ones(rows) / rows, "same")[
        rows // 2 : len(values) + rows // 2
    ]


def smoothed(run, over_s):
    return treads(run, lambda *both: [mean_over(of, over_s) for of in both])


@pytest.mark.parametrize("over_s", [1.0, 2.0, 3.0])
def test_treads_of_a_moving_mean_are_named_with_its_time(over_s):
    found = check_recording(smoothed(stepping(), over_s)).findings[0]
    assert found.name == "smoothed_treads"
    said_s = float(found.cause.split("over some ")[1].split(" s")[0])
    assert said_s == pytest.approx(over_s, rel=0.5)


@pytest.mark.parametrize("sensors", SENSORS)
@pytest.mark.parametrize("drive", [stepping, turning_all_round, varied])
def test_treads_as_they_are_are_not_smooth(sensors, drive):
    assert not list(smoothed_treads(Evidence(SENSORS[sensors](drive()))))


def test_noise_of_a_gyroscope_beside_gentle_treads_is_no_smoothing():
    """A robot that changes its turns slowly has smooth treads."""
    noise = 0.2 * np.random.default_rng(3).standard_normal(len(turning_all_round().odometry["t"]))
    gentle = smoothed(turning_all_round(), 1.0)
    noisy = gyroscope(gentle, lambda rate: rate + noise)
    assert not list(smoothed_treads(Evidence(noisy)))
