"""Drives without a fault that once had a finding: lobes of a figure eight, a steep slope."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.turns.constancy import uneven_map
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import PERIOD_S, drive, turning_all_round
from tests.odometry.checks.faulty import positions, put

AT_S = PERIOD_S * np.arange(4000)


def only(run):
    (found,) = check_recording(run).at(Level.WARNING)
    return found


def eight():
    """Lobes to the left and to the right, by ICRs of which the right one is nearer."""
    lobe = AT_S // (2 * np.pi * 0.9 / 0.8) % 2 == 0
    left, right = np.where(lobe[:, None], [0.2, 1.0], [1.0, 0.2]).T
    near, far = -0.25, 0.65
    turn = (right - left) / (far - near)
    run = drive((right * far - left * near) / (far - near), turn)
    noise = 1 + 0.01 * np.random.default_rng(1).standard_normal((2, len(left)))
    return put(run, "odometry", v_left=left * noise[0], v_right=right * noise[1])


def test_lobes_of_unlike_icrs_are_no_uneven_map():
    assert uneven_map(Evidence(eight())) == ""


def sliding(downhill=1.0, tilt=True):
    """A robot that slides by 0.3 m/s along y on a slope of 12 degrees, which goes down along y."""
    run = turning_all_round()
    run = positions(run, lambda x, y: (x, y + downhill * 0.3 * run.pose.stamps_s))
    heading = np.interp(AT_S, run.pose.stamps_s, np.unwrap(run.pose["yaw"]))
    slope = np.radians(12)
    pitch = np.arctan(np.tan(slope) * np.sin(heading))
    roll = -np.arcsin(np.sin(slope) * np.cos(heading))
    return put(run, "odometry", roll=roll, pitch=pitch) if tilt else run


def test_sliding_down_a_slope_is_no_fault_and_up_it_is():
    assert warnings(sliding()) == []
    assert "whatever the treads do" in only(sliding(downhill=-1.0)).seen
    assert "slides down a slope" in only(sliding(tilt=False)).seen


def lanes(seed, rows=4000):
    """Straight lines, three in twenty of them backwards, with a sharp turn between two."""
    rng, speed, turn, first = np.random.default_rng(seed), np.zeros(rows), np.zeros(rows), 0
    while first < rows:
        straight, turning = int(rng.integers(40, 160)), int(rng.integers(20, 60))
        speed[first : first + straight] = rng.uniform(0.4, 1.2) * (1 if rng.random() < 0.85 else -1)
        first += straight
        speed[first : first + turning] = rng.uniform(0.0, 0.6)
        turn[first : first + turning] = rng.uniform(0.3, 1.0) * rng.choice([-1, 1])
        first += turning
    smooth = np.ones(8) / 8
    return drive(*(np.convolve(of, smooth, "same") for of in (speed, turn)), seed=seed)


@pytest.mark.parametrize("seed", [5, 16])
def test_backing_up_on_straight_lines_gives_the_gyroscope_no_other_scale(seed):
    assert check_recording(lanes(seed)).at(Level.WARNING) == ()
