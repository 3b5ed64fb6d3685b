"""The check of recordings on what a live run has measured."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.recording.run import Robot
from terrain.live.checked_so_far import COLUMNS, CheckedSoFar
from terrain.live.live_odometry import LiveOdometry
from tests.odometry.checks.drives import turning_all_round

RUN = turning_all_round()
FRAMES = list(RUN.frames())


def notes_of(change, until_s=65.0):
    live = LiveOdometry(RUN.robot, at_pose=True)
    for frame in FRAMES:
        if frame.stamp_s < until_s:
            live.step(change(frame))
    return [note for note in live.notes if note.startswith("by the check of the last")]


def posed(change):
    """Another pose, by what was measured."""
    return lambda f: f if f.pose is None else replace(f, pose=np.array(change(*f.pose)))


def along_the_map(frame):
    """A velocity in the axes of the map."""
    if frame.pose is None:
        return frame
    ahead_m_s = 0.93 * frame.tread_speeds_m_s.mean()
    x, y = ahead_m_s * np.cos(frame.pose[2]), ahead_m_s * np.sin(frame.pose[2])
    return replace(frame, velocity=np.array([x, y, frame.yaw_rate_rad_s]))


FAULTS = {
    "velocities of the map": (along_the_map, "velocity.csv"),
    "north before east": (
        posed(lambda x, y, yaw: (y, x, np.pi / 2 - yaw)),
        "yaw of pose.csv turns",
    ),
    "positions mirrored": (posed(lambda x, y, yaw: (x, -y, yaw)), "turns against its own yaw"),
    "a yaw turned a little": (posed(lambda x, y, yaw: (x, y, yaw + 0.12)), "from the yaw"),
}


@pytest.mark.parametrize(("change", "words"), FAULTS.values(), ids=FAULTS)
def test_what_is_set_up_wrongly_is_said_after_a_minute(change, words):
    (note,) = notes_of(change)
    assert words in note
    assert notes_of(change, until_s=59.0) == []


def test_a_drive_that_is_right_has_no_note():
    assert notes_of(lambda frame: frame, until_s=130.0) == []


def test_what_the_robot_does_is_no_fault_of_the_setup():
    """At rest a recording is of no use, and a robot waits."""
    still = replace(FRAMES[0], tread_speeds_m_s=np.zeros(2), yaw_rate_rad_s=0.0)
    assert notes_of(lambda f: replace(still, stamp_s=f.stamp_s, odometry_row=f.odometry_row)) == []


def test_rows_are_kept_for_two_minutes_and_checked_rarely(monkeypatch):
    checks = []
    monkeypatch.setattr(CheckedSoFar, "_checked", lambda self: checks.append(self._last_s) or [])
    checked = CheckedSoFar(Robot(0.6), (0.0, 0.0))
    for row in range(6000):
        frame = FRAMES[row % len(FRAMES)]
        checked.add(replace(frame, stamp_s=row / 10, odometry_row=row))
        checked.notes()
    np.testing.assert_allclose(checks, [60.0, 120.0, 240.0, 480.0], atol=0.2)
    assert all(len(checked._rows[name]) <= 1201 for name in COLUMNS)
