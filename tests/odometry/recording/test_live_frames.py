"""Frames made of messages while they come in are those of the run folder."""

from dataclasses import fields

import numpy as np
import pytest

from odometry.recording.live_frames import AHEAD_S, LiveFrames
from odometry.recording.run import Run


@pytest.fixture
def drive(make_run, rng):
    """A run, and its messages as (when it comes, name, stamp, values)."""
    stamps = {
        "treads": np.arange(0.0, 6.0, 0.1),
        "gyroscope": np.arange(0.013, 6.2, 0.01),
        "pose": np.arange(0.35, 6.0, 0.25),
        "velocity": np.arange(0.05, 5.9, 0.1),
    }
    stamps["gyroscope"] = np.delete(stamps["gyroscope"], slice(200, 220))  # a short silence
    widths = {"treads": 2, "gyroscope": 1, "pose": 3, "velocity": 3}
    values = {name: rng.normal(size=(len(of), widths[name])) for name, of in stamps.items()}
    delays_s = {"treads": 0.004, "gyroscope": 0.001, "pose": 0.06, "velocity": 0.02}
    messages = [
        (stamp_s + delays_s[name] + rng.uniform(0, 0.004), name, stamp_s, of)
        for name in stamps
        for stamp_s, of in zip(stamps[name].tolist(), values[name].tolist(), strict=True)
    ]
    header = {"treads": "v_left,v_right", "gyroscope": "gyro_z", "pose": "x,y,yaw"}
    files = {
        name: f"t,{header.get(name, 'vx,vy,wz')}\n"
        + "".join(
            ",".join(map(repr, [stamp_s, *of])) + "\n"
            for _, kind, stamp_s, of in sorted(messages, key=lambda m: m[2])
            if kind == name
        )
        for name in stamps
    }
    folder = make_run(
        odometry=files["treads"],
        imu=files["gyroscope"],
        pose=files["pose"],
        velocity=files["velocity"],
    )
    return Run.read(folder), sorted(messages)


def fed(frames, messages):
    found = []
    for _, name, stamp_s, values in messages:
        getattr(frames, name)(stamp_s, *values)
        found += frames.ready()
    return found + frames.rest()


def assert_same(one, other):
    assert len(one) == len(other)
    for mine, theirs in zip(one, other, strict=True):
        for field in fields(mine):
            np.testing.assert_array_equal(
                getattr(mine, field.name), getattr(theirs, field.name), err_msg=field.name
            )


def test_frames_of_messages_are_those_of_the_run_folder(drive):
    run, messages = drive
    frames = LiveFrames(wait_s=0.1)
    expected = [f for f in run.frames() if f.stamp_s <= run.odometry.stamps_s[-1]]
    found = fed(frames, messages)
    assert_same([frame for frame in found if frame.stamp_s <= expected[-1].stamp_s], expected)
    assert frames.too_late == 0


def test_a_frame_comes_when_nothing_older_can_and_the_gyroscope_has_come(drive):
    _, messages = drive
    frames = LiveFrames(wait_s=0.1)
    now_s = -np.inf
    for _, name, stamp_s, values in messages:
        getattr(frames, name)(stamp_s, *values)
        now_s = max(now_s, stamp_s)
        for frame in frames.ready():
            silent_s = 0.2 if 2.0 < now_s < 2.4 else 0.0
            assert now_s - 0.13 - silent_s < frame.stamp_s <= now_s - 0.1 + 1e-9


def test_without_waiting_what_comes_late_is_dropped_and_counted(drive):
    run, messages = drive
    frames = LiveFrames(wait_s=0.0, has_gyroscope=False)
    found = fed(frames, messages)
    assert frames.too_late >= len(run.pose)
    assert [f.stamp_s for f in found] == sorted({f.stamp_s for f in found})
    assert all(np.isnan(frame.yaw_rate_rad_s) for frame in found)


def test_a_repeated_stamp_is_dropped_and_counted():
    frames = LiveFrames(has_gyroscope=False)
    frames.treads(1.0, 0.5, 0.5)
    frames.treads(1.0, 0.7, 0.7)
    (frame,) = frames.rest()
    np.testing.assert_array_equal(frame.tread_speeds_m_s, [0.5, 0.5])
    assert frames.too_late == 1


def test_a_silent_gyroscope_is_not_waited_for_longer_than_half_a_second():
    frames = LiveFrames(wait_s=0.0)
    frames.gyroscope(0.0, 0.1)
    frames.gyroscope(0.05, 0.1)
    given = []
    for k in range(20):
        frames.treads(0.1 * k, 0.5, 0.5)
        given += [(0.1 * k, frame) for frame in frames.ready()]
    assert [round(now_s - frame.stamp_s, 9) for now_s, frame in given[1:]] == [0.5] * 14
    assert all(np.isnan(frame.yaw_rate_rad_s) for _, frame in given[2:])


@pytest.mark.parametrize("stamp_s", [np.nan, np.inf, -np.inf])
def test_a_stamp_that_is_no_number_is_dropped_and_harms_nothing(stamp_s):
    frames = LiveFrames(wait_s=0.0)
    frames.treads(1.0, 0.5, 0.5)
    for add in (frames.treads, frames.pose):
        add(stamp_s, 0.5, 0.5)
    frames.gyroscope(stamp_s, 0.1)
    frames.gyroscope(1.0, np.nan)
    assert frames.too_late == 4
    assert frames.ready() == []  # no row of the gyroscope yet
    frames.gyroscope(1.1, 0.1)
    frames.treads(1.1, 0.5, 0.5)
    assert [frame.stamp_s for frame in frames.ready()] == [1.0, 1.1]


@pytest.mark.parametrize("kind", ["treads", "gyroscope", "pose"])
def test_one_stamp_far_ahead_is_dropped_alone(drive, kind):
    _, messages = drive
    whole, one_less = LiveFrames(wait_s=0.1), LiveFrames(wait_s=0.1)
    place = [place for place, message in enumerate(messages) if message[1] == kind][7]
    at, _, stamp_s, values = messages[place]
    ahead = [*messages[:place], (at, kind, stamp_s + 3600.0, values), *messages[place + 1 :]]
    found, expected = fed(whole, ahead), fed(one_less, messages[:place] + messages[place + 1 :])
    assert whole.too_late == 1
    assert [frame.stamp_s for frame in found] == [frame.stamp_s for frame in expected]
    rates = [[frame.yaw_rate_rad_s for frame in each] for each in (found, expected)]
    np.testing.assert_array_equal(*rates)


def test_an_image_clock_that_is_ahead_does_not_stop_the_treads():
    frames, given = LiveFrames(wait_s=0.1, has_gyroscope=False), []
    for step in range(100):
        frames.treads(0.1 * step, 0.5, 0.5)
        if step % 5 == 0:
            frames.image(0.1 * step + 2.02, np.zeros((2, 2), dtype=np.uint8))
        given += frames.ready()
    assert frames.too_late == 0
    with_images = [frame.stamp_s for frame in given if frame.image is not None]
    assert np.allclose(np.diff(with_images), 0.5)
    assert len(given) - len(with_images) == 99


def test_a_clock_that_jumps_for_all_sensors_is_followed():
    frames, given = LiveFrames(wait_s=0.1), []
    for step in range(200):
        stamp_s = 0.1 * step + (3600.0 if step >= 100 else 0.0)
        frames.treads(stamp_s, 0.5, 0.5)
        frames.gyroscope(stamp_s + 0.01, 0.2)
        given += frames.ready()
    assert len(given) == 199  # the last waits
    assert frames.too_late == 0


def test_poses_keep_time_where_treads_have_stopped():
    frames, given = LiveFrames(wait_s=0.1, has_gyroscope=False), []
    frames.treads(0.0, 0.5, 0.5)
    for second in range(1, 31):
        frames.pose(float(second), second, 0.0, 0.0)
        given += frames.ready()
    assert given[-1].stamp_s > 30.0 - 2 * AHEAD_S
    assert np.all(np.diff([frame.stamp_s for frame in given]) == 1.0)
    assert frames.too_late == 0


def test_images_that_come_late_are_counted_with_their_delay():
    frames = LiveFrames(wait_s=0.1, has_gyroscope=False)
    for row in range(100):
        stamp_s = row / 10
        frames.treads(stamp_s, 0.5, 0.5)
        if row >= 20 and row % 2 == 0:
            frames.image(stamp_s - 2.0, np.zeros((4, 4), np.uint8))
        frames.ready()
    (note,) = frames.notes
    assert note.startswith("40 of 40 images were dropped: they came 2.00 s behind treads")
    assert frames.too_late == 40
    assert frames.pose(9.85, 0.0, 0.0) is None  # on time
    assert len(frames.notes) == 1
