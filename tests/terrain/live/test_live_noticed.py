"""What live says of sensors that mislead it."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import EstimationError
from odometry.installed import shipped_data
from odometry.recording.frames import Frame
from odometry.recording.live_frames import LiveFrames
from odometry.recording.run import Robot
from terrain.live.live_odometry import LiveOdometry

PERIOD_S = 0.05
TRACK_M, WIDTH_M = 0.6, 1.0


def drive(seconds=40.0):
    """Frames of a robot that turns as if 1 m wide, and is measured without noise."""
    for row in range(round(seconds / PERIOD_S)):
        stamp_s = row * PERIOD_S
        ahead, turn = 0.6 + 0.2 * np.sin(stamp_s), 0.5 * np.cos(0.7 * stamp_s)
        treads = np.array([ahead - turn * WIDTH_M / 2, ahead + turn * WIDTH_M / 2])
        rate = 0.5 * np.cos(0.7 * (stamp_s - PERIOD_S)) + 1e-5 * (row % 3)  # never repeated
        velocity = np.array([ahead, 0.0, turn])
        yield Frame(stamp_s, treads, row, None, None, yaw_rate_rad_s=rate), velocity


def notes_of(change):
    live = LiveOdometry(Robot(TRACK_M))
    for frame, velocity in drive():
        live.step(change(frame, velocity))
    return live.notes


def test_a_drive_that_is_right_has_no_note():
    assert notes_of(lambda frame, _: frame) == ()
    assert notes_of(lambda frame, velocity: replace(frame, velocity=velocity)) == ()


FAULTS = {
    "rad/s": (lambda f, _: replace(f, tread_speeds_m_s=f.tread_speeds_m_s / 0.15), "turns as if"),
    "degrees per second": (
        lambda f, _: replace(f, yaw_rate_rad_s=np.degrees(f.yaw_rate_rad_s)),
        "turns as if",
    ),
    "the sign of the gyroscope": (
        lambda f, _: replace(f, yaw_rate_rad_s=-f.yaw_rate_rad_s),
        "turns as if",
    ),
    "swapped treads": (
        lambda f, _: replace(f, tread_speeds_m_s=f.tread_speeds_m_s[::-1]),
        "turns as if",
    ),
    "velocities backwards": (lambda f, v: replace(f, velocity=v * [-1, 1, 1]), "moves 0.0"),
    "velocities in km/h": (lambda f, v: replace(f, velocity=v * [3.6, 3.6, 1]), "moves 3."),
}


@pytest.mark.parametrize(("change", "words"), FAULTS.values(), ids=FAULTS)
def test_a_motion_that_no_robot_has_is_said(change, words):
    found = [note for note in notes_of(change) if note.startswith(f"the robot {words}")]
    assert len(found) == 1
    assert "run `check` on it" in found[0]


def test_a_motion_that_the_user_states_is_no_surprise():
    """The Warthog's printed ICRs are 9.8 track widths apart (Baril 2020, Table I)."""
    parameters = shipped_data() / "parameters/warthog_icr.toml"
    live = LiveOdometry(Robot(1.08), parameters=parameters, terrain="concrete")
    for frame, _ in drive(2.0):
        live.step(replace(frame, yaw_rate_rad_s=np.nan))
        assert live.notes == ()


def test_what_the_filter_noticed_is_said_once_with_its_latest_time():
    def held_twice(frame, _):
        held = 5 < frame.stamp_s % 20 < 15
        return replace(frame, tread_speeds_m_s=np.array([0.5, 0.9])) if held else frame

    live = LiveOdometry(Robot(TRACK_M))
    events = []
    for frame, velocity in drive():
        step = live.step(held_twice(frame, velocity))
        events += [event for event in step.estimate.events if event.kind == "contrary_treads"]
    (note,) = (note for note in live.notes if "the treads turned the robot by less" in note)
    assert note.startswith(events[-1].text)
    assert len(events) == 2
    assert note.endswith("s, the latest of 2 times)")


def test_a_gyroscope_that_fell_silent_is_said_until_it_speaks_again():
    live, said = LiveOdometry(Robot(TRACK_M)), []
    for frame, _ in drive(20):
        silent = 5 < frame.stamp_s < 12
        live.step(replace(frame, yaw_rate_rad_s=np.nan) if silent else frame)
        if any("the gyroscope was silent" in note for note in live.notes):
            said.append(frame.stamp_s)
    assert said[0] == pytest.approx(6.0, abs=0.15)
    assert said[-1] == pytest.approx(12.0, abs=0.15)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("tread_speeds_m_s", np.array([np.inf, 0.5])),
        ("yaw_rate_rad_s", -np.inf),
        ("pose", np.array([0.0, np.inf, 0.0])),
        ("velocity", np.array([np.inf, 0.0, 0.0])),
    ],
)
def test_a_frame_with_an_infinite_number_is_refused_and_changes_nothing(name, value):
    live, other = LiveOdometry(Robot(TRACK_M)), LiveOdometry(Robot(TRACK_M))
    for frame, _ in drive(2.0):
        with pytest.raises(EstimationError, match=f"{name} = "):
            live.step(replace(frame, **{name: value}))
        step, expected = live.step(frame), other.step(frame)
    np.testing.assert_array_equal(step.estimate.mean, expected.estimate.mean)


def test_infinite_numbers_of_poses_and_velocities_count_as_not_measured():
    frames = LiveFrames(wait_s=0.0, has_gyroscope=False)
    frames.treads(0.0, 0.5, 0.5)
    frames.pose(0.0, np.inf, 1.0, 0.2)
    frames.velocity(0.0, 0.5, np.nan, -np.inf)
    (frame,) = frames.rest()
    np.testing.assert_array_equal(frame.pose, [np.nan, 1.0, 0.2])
    np.testing.assert_array_equal(frame.velocity, [0.5, np.nan, np.nan])
    assert frames.too_late == 2


def test_tread_speeds_that_a_frame_does_not_know_are_noted():
    live = LiveOdometry(Robot(TRACK_M))
    for frame, _ in drive(10.0):
        lost = 4 < frame.stamp_s < 6
        live.step(replace(frame, tread_speeds_m_s=np.full(2, np.nan)) if lost else frame)
    (note,) = live.notes
    assert note.startswith("no tread speeds came for 2.0 s in all")


@pytest.mark.parametrize("speed_m_s", [np.nan, np.inf])
def test_tread_speeds_that_are_no_numbers_are_lost_messages_and_no_rest(speed_m_s):
    frames, live = LiveFrames(wait_s=0.0, has_gyroscope=False), LiveOdometry(Robot(TRACK_M))
    for row in range(200):
        lost = 80 <= row < 140
        frames.treads(row * PERIOD_S, speed_m_s if lost else 0.5, 0.5)
        for frame in frames.ready():
            step = live.step(frame)
    assert frames.too_late == 60
    assert any(note.startswith("no tread speeds came for 3.0 s") for note in live.notes)
    assert step.odometer[0] == pytest.approx(199 * PERIOD_S * 0.5, abs=0.03)  # the last was held
