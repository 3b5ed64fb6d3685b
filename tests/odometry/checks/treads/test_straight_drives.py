"""One tread that reads some per cent more than the other."""

import re
from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.treads.straight_drives import straight_drives
from odometry.recording.run import Run
from tests.odometry.checks.drives import drive
from tests.odometry.checks.faulty import treads, without_gyroscope

SENSORS = {
    "gyroscope and poses": lambda run: run,
    "gyroscope": lambda run: replace(run, pose=None),
    "poses": without_gyroscope,
}


def straights_and_turns():
    at_s = 0.05 * np.arange(3600)
    turns = 0.5 * np.sin(at_s / 1.5) * (at_s % 30 > 18)
    return drive(1 + 0.3 * np.sin(at_s / 7), turns)


def noted(run):
    return list(straight_drives(Evidence(run)))


@pytest.mark.parametrize("sensors", SENSORS)
@pytest.mark.parametrize(("left", "right", "more"), [(1.12, 1, "left"), (1, 1.1, "right")])
def test_a_tread_that_reads_more_is_noted_with_its_size(left, right, more, sensors):
    run = treads(straights_and_turns(), lambda *speeds: (left * speeds[0], right * speeds[1]))
    (found,) = noted(SENSORS[sensors](run))
    assert found.level is Level.NOTE
    assert f"the {more} tread" in found.seen
    size, sigma = map(float, re.findall(r"([\d.]+) \+- ([\d.]+) %", found.seen)[0])
    assert size == pytest.approx(100 * (max(left, right) - 1), abs=max(3 * sigma, 0.3))
    assert "both are possible" in found.cause
    sensor = {"poses": ["the poses"], "gyroscope": ["the gyroscope"]}.get(
        sensors, ["the gyroscope", "the poses"]
    )
    assert found.seen.endswith(" and ".join(sensor))


@pytest.mark.parametrize("factor", [1.0, 1.03, 0.97])
def test_what_real_robots_have_is_not_noted(factor):
    assert noted(treads(straights_and_turns(), lambda left, right: (factor * left, right))) == []


def test_a_bias_of_the_gyroscope_is_no_tread():
    run = replace(straights_and_turns(), pose=None)
    rate = run.odometry["gyro_z"] + 0.05
    odometry = replace(run.odometry, columns={**run.odometry.columns, "gyro_z": rate})
    assert noted(replace(run, odometry=odometry)) == []


def test_turns_to_one_side_alone_say_nothing():
    at_s = 0.05 * np.arange(2400)
    spiral = drive(1 + 0.2 * np.sin(at_s / 5), 0.5 * np.exp(-at_s / 60) + 0.01)
    assert noted(treads(spiral, lambda left, right: (1.12 * left, right))) == []


def test_a_real_drive_on_grass(shared_data):
    run = Run.read(shared_data / "motion" / "warthog_grass_20240729_1446")
    assert noted(run) == []
    unequal = treads(run, lambda left, right: (1.12 * left, right))
    (found,) = (f for f in check_recording(unequal).findings if f.name == "straight_drives")
    assert "left" in found.seen
