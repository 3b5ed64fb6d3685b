"""Poses that are a little late: a note, for `run` undoes it."""

import pytest

from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import PERIOD_S, uneven
from tests.odometry.checks.faulty import pose_stamps

EARLY_S = PERIOD_S  # the yaw of the drive is that at the end of a row


@pytest.mark.parametrize("late_s", [0.08, 0.13])
def test_poses_that_are_a_little_late_are_noted(late_s):
    (found,) = check_recording(pose_stamps(uneven(), lambda t: t + EARLY_S + late_s)).findings
    assert (found.name, found.level) == ("pose_late", "note")
    assert float(found.remedy.split()[1]) == pytest.approx(late_s, abs=0.01)


@pytest.mark.parametrize("late_s", [0.0, 0.03, -0.1])
def test_poses_on_time_or_a_little_early_are_not(late_s):
    late = pose_stamps(uneven(), lambda t: t + EARLY_S + late_s)
    assert check_recording(late).findings == ()
