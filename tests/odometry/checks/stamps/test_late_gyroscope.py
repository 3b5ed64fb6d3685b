"""A gyroscope that is late and treads that are early: poses decide, or both are named."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.findings.undo import TREADS
from odometry.checks.recording import check_recording
from odometry.checks.stamps.late_stamps import pose_late
from odometry.checks.statistics.lag import Lag
from tests.odometry.checks.drives import winding
from tests.odometry.checks.faulty import later


def sparse(run):
    """A pose in 2.5 s: between them the robot turns to and fro."""
    return replace(run, pose=run.pose.rows(np.arange(0, len(run.pose), 25)))


WITHOUT = {"no poses": lambda run: replace(run, pose=None), "few poses": sparse}


@pytest.mark.parametrize(
    ("poses", "names", "seconds"),
    [
        *(("no poses", ("gyro_z",), -0.4), ("no poses", TREADS, -0.4)),
        *(("few poses", ("gyro_z",), 0.4), ("few poses", TREADS, 0.4)),
    ],
)
def test_where_poses_do_not_decide_both_are_named(poses, names, seconds):
    found = check_recording(WITHOUT[poses](later(winding(), names, seconds))).findings[0]
    assert found.name in ("treads_late", "treads_are_commands")
    of_treads = (seconds > 0) == (names == TREADS)
    assert f"stamps of the gyroscope are {'early' if of_treads else 'late'}" in found.cause
    assert "poses do not decide between these" in found.cause


@pytest.mark.parametrize("seconds", [-0.4, 0.4])
def test_where_poses_decide_one_is_named(seconds):
    gyroscope, treads = (
        check_recording(later(winding(), names, seconds)).findings[0]
        for names in (("gyro_z",), TREADS)
    )
    assert gyroscope.name == "gyroscope_late"
    assert ("smoothed" in gyroscope.cause) == (seconds > 0)
    assert treads.name in ("treads_late", "treads_are_commands")
    assert "poses do not decide" not in treads.cause


@pytest.mark.parametrize(
    ("gyroscope", "words"), [(True, "by the gyroscope here"), (False, "without a gyroscope")]
)
def test_late_poses_beside_treads_alone_say_what_does_not_decide(gyroscope, words):
    lag = Lag(0.2, 0.01, 0.0, 0.0, 0.9, 5, 1.0)
    found = pose_late(lag, "the treads", gyroscope=gyroscope)
    assert f"treads are early: {words} this cannot be determined" in found.cause


def test_treads_that_are_early_by_a_constant_time_may_be_commands():
    found = check_recording(later(winding(), TREADS, -0.8)).findings[0]
    assert found.name == "treads_late"
    assert "or they are commands on which the robot acts so much later" in found.cause
