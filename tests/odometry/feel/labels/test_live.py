"""Rows that come one by one against the whole run at once, and what cannot be felt."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import RunFolderError
from odometry.feel.identify_feel import identify_feel
from odometry.feel.labels.felt import FeltWindows
from odometry.feel.labels.follow import follow_feel
from odometry.feel.labels.live import LATE_S, LiveFeel
from odometry.feel.labels.live_run import follow_feel_live
from odometry.feel.recorded.signals import usual_rate_hz
from odometry.recording.run import Robot, Run
from tests.odometry.feel.feel_drives import drive, with_imu


def rows_of(run, ahead_s=0.0):
    """Frames with the rows of the IMU up to their stamps, or by so much later, before them."""
    imu, odometry, row = run.imu, run.odometry, 0
    for frame in run.frames():
        first = row
        while row < len(imu) and imu.stamps_s[row] <= frame.stamp_s + ahead_s:
            row += 1
        currents = odometry.stack("current_left", "current_right")[frame.odometry_row]
        yield frame, range(first, row), currents


def fed(live, run, ahead_s=0.0):
    """Each window as it becomes known, with the stamp of the frame at which it is given."""
    for frame, rows, currents in rows_of(run, ahead_s):
        for row in rows:
            gyro, accel = (
                [run.imu[f"{kind}_{axis}"][row] for axis in "xyz"] for kind in ("gyro", "accel")
            )
            live.imu(run.imu.stamps_s[row], gyro=gyro, accel=accel)
        live.currents(frame.stamp_s, *currents)
        for felt in live.step(frame):
            yield frame.stamp_s, felt


@pytest.mark.parametrize("terrain", ["gravel", "grates"])
def test_rows_one_by_one_give_what_the_whole_run_gives(model, terrain):
    run = drive(terrain, 940, seconds=40.0)
    whole = follow_feel(run, model)
    live = LiveFeel(model, run.robot, rate_hz=usual_rate_hz(run.imu.stamps_s))
    latest = [felt.since(len(felt.windows) - 1) for _, felt in fed(live, run)]
    assert len(latest) >= len(whole.windows) - 2
    found = FeltWindows.joined(latest)
    rows = slice(len(latest))
    np.testing.assert_allclose(found.windows.begins_s, whole.windows.begins_s[rows], 1e-12)
    for name in ("probabilities", "unknown"):
        np.testing.assert_allclose(
            getattr(found, name), getattr(whole, name)[rows], rtol=1e-12, atol=1e-13
        )
    np.testing.assert_array_equal(found.lasting_answers, whole.lasting_answers[rows])


def test_the_last_window_of_each_stretch_is_that_of_the_whole_run(model):
    run = drive("snow", 941, seconds=40.0)
    whole = follow_feel(run, model)
    live = LiveFeel(model, run.robot, rate_hz=usual_rate_hz(run.imu.stamps_s))
    for row, (stamp_s, felt) in enumerate(fed(live, run)):
        assert stamp_s >= whole.stamps_s[row] - 1e-9
        assert len(felt.windows) <= 10  # of the stretch: memory does not grow
        np.testing.assert_allclose(
            felt.lasting_probabilities[-1], whole.lasting_probabilities[row], rtol=1e-12, atol=1e-13
        )
        assert felt.lasting_answers[-1] == whole.lasting_answers[row]
    assert row > 30


def test_nothing_later_than_a_frame_changes_what_is_given_there(model):
    """Rows that are there already count for nothing before their time."""
    run = drive("gravel", 942, seconds=20.0)
    at_once, ahead = (
        [(stamp_s, felt.lasting_probabilities[-1]) for stamp_s, felt in fed(live, run, ahead_s)]
        for live, ahead_s in ((LiveFeel(model, run.robot), 0.0), (LiveFeel(model, run.robot), 1.0))
    )
    assert [stamp_s for stamp_s, _ in at_once] == [stamp_s for stamp_s, _ in ahead]
    np.testing.assert_array_equal([of for _, of in at_once], [of for _, of in ahead])


@pytest.mark.slow
def test_a_real_recording_row_by_row_gives_what_it_gives_at_once(shared_data):
    """A minute of sandy loam; the model is of six other recordings."""
    names = ("ice_00", "ice_02", "snow_00", "snow_02", "sandy_loam_00", "sandy_loam_02")
    model = identify_feel([Run.read(shared_data / "feel" / name) for name in names])
    run = Run.read(shared_data / "feel" / "sandy_loam_03")
    whole = follow_feel(run, model)
    live = LiveFeel(model, run.robot, rate_hz=usual_rate_hz(run.imu.stamps_s))
    rows = -1
    for rows, (_, felt) in enumerate(fed(live, run)):
        for name in ("lasting_probabilities", "lasting_unknown", "probabilities", "unknown"):
            of = getattr(felt, name)[-1], getattr(whole, name)[rows]
            np.testing.assert_allclose(*of, rtol=1e-12, atol=1e-13)
        assert felt.lasting_answers[-1] == whole.lasting_answers[rows]
    assert rows >= len(whole.windows) - 3


def with_hole(columns, begin_s=8.0, end_s=12.0):
    keep = (columns["t"] < begin_s) | (columns["t"] > end_s)
    return {name: of[keep] for name, of in columns.items()}


def test_a_recording_as_if_live_waits_for_the_sample_after_a_hole(model):
    run = with_imu(drive("gravel", 943, seconds=20.0), with_hole)
    felt = follow_feel_live(run, model)
    begins_s, ends_s = felt.windows.begins_s, felt.windows.ends_s
    np.testing.assert_array_equal(felt.windows.whole, (ends_s <= 8.0) | (begins_s > 12.0))
    in_hole = (ends_s > 8.02) & (ends_s < 12.0)
    assert in_hole.any()
    assert felt.stamps_s[in_hole].min() >= 12.0  # the gap is known once it ends
    np.testing.assert_allclose(felt.stamps_s[~in_hole], ends_s[~in_hole], atol=0.02)


def test_an_imu_that_ends_is_not_waited_for_and_memory_does_not_grow(model):
    run = with_imu(
        drive("gravel", 944, seconds=40.0), lambda c: {n: of[:1000] for n, of in c.items()}
    )
    live = LiveFeel(model, run.robot)
    found = list(fed(live, run))
    assert [felt.windows.whole[-1] for _, felt in found].count(True) == 9
    assert not found[-1][1].windows.whole[-1]
    assert found[-1][0] - found[-1][1].windows.ends_s[-1] < LATE_S + 0.2
    assert len(live._treads.stamps_s) < 100


def test_treads_that_are_held_for_too_long_are_not_known(model):
    run = drive("gravel", 945, seconds=30.0)
    keep = (run.odometry.stamps_s < 10.0) | (run.odometry.stamps_s > 16.0)
    columns = {name: of[keep] for name, of in run.odometry.columns.items()}
    run = replace(run, odometry=replace(run.odometry, columns=columns))
    felt = follow_feel_live(run, model)
    inside = (felt.windows.begins_s > 10.0) & (felt.windows.ends_s < 16.0)
    assert inside.any()
    assert not felt.windows.whole[inside].any()


def changed(factor, kind):
    return lambda columns: {
        name: of * (factor if name.startswith(kind) else 1.0) for name, of in columns.items()
    }


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (changed(1 / 9.81, "accel"), "in g or mg"),
        (changed(180 / np.pi, "gyro"), "degrees a second"),
        (lambda c: {name: of[::40] for name, of in c.items()}, "rows of the IMU a second"),
        (lambda c: {name: of[::2] for name, of in c.items()}, "recorded at 50 Hz"),
    ],
)
def test_what_cannot_be_felt_is_noted_and_gives_nothing(model, change, words):
    run = with_imu(drive("gravel", 946, seconds=20.0, turning=0.4), change)
    live = LiveFeel(model, run.robot)
    named = {felt.answers[-1] for _, felt in fed(live, run)}
    assert words in live.note
    assert not named & set(model.names)


def test_rows_out_of_order_are_counted_and_another_robot_is_refused(model):
    live = LiveFeel(model, Robot(0.5))
    for stamp_s in (0.0, 0.1, 0.1, 0.05, np.nan):
        live.imu(stamp_s, gyro=(0.0, 0.0, 0.0))
    assert live.too_late == 3
    with pytest.raises(RunFolderError, match="how terrain feels on one robot"):
        LiveFeel(model, Robot(1.2))
