"""Clocks that are set back while a bag is recorded, and rows that merely come late."""

import numpy as np
import pytest

from odometry.bags.rows.set_clock import SetClock
from odometry.checks.recording import check_recording
from odometry.recording.run_span import Span, cut_run
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import BEGIN_NS, RADIUS_M, Bag, course, name_of

NAMES = ["left_wheel", "right_wheel"]
SET_AT_S = 10.0


def put_in(stamps_s):
    """The clock, and the stamps of the rows that it gives on."""
    clock, used = SetClock(), []
    for stamp_s in stamps_s:
        used += [stamp / 1e9 for stamp, _ in clock.add(round(stamp_s * 1e9), ())]
    return clock, used + [stamp / 1e9 for stamp, _ in clock.rest()]


@pytest.mark.parametrize("by_s", [0.31, 1.013, 30.0])
def test_rows_behind_a_clock_that_was_set_back_are_left_out(by_s):
    true_s = np.arange(0.0, 100.0, 0.05)
    stamps_s = np.where(true_s >= 50.0, true_s - by_s, true_s)
    clock, used = put_in(stamps_s)
    (found,) = clock.found
    assert found.at_ns == pytest.approx(49.95e9)
    assert found.by_ns == pytest.approx((by_s - 0.05) * 1e9)
    assert np.all(np.diff(used) >= 0)
    assert len(used) + clock.left_out == len(stamps_s)


def late_now_and_then(stamps_s, rng):
    late_s = np.where(rng.random(len(stamps_s)) < 0.1, rng.uniform(0, 0.5, len(stamps_s)), 0.0)
    return stamps_s[np.argsort(stamps_s + late_s)]


RIGHT = {
    "in order": lambda stamps_s, _: stamps_s,
    "rows come late now and then": late_now_and_then,
    "bursts of 20 ms in any order": lambda stamps_s, rng: stamps_s[
        np.argsort(np.floor(stamps_s / 0.02) + rng.random(len(stamps_s)))
    ],
    "two publishers, one late by 0.3 s": lambda stamps_s, _: np.concatenate(
        [[one + 0.001, max(one - 0.3, 0.0)] for one in stamps_s]
    ),
}


@pytest.mark.parametrize("order", RIGHT.values(), ids=RIGHT)
def test_rows_that_merely_come_late_are_all_used(order, rng):
    stamps_s = order(np.arange(0.0, 20.0, 0.005), rng)
    clock, used = put_in(stamps_s)
    assert clock.found == []
    assert sorted(used) == pytest.approx(sorted(stamps_s))


def set_back_bag(kind, by_s):
    """The clock of the robot is set back at 10 s, that of the recorder is not."""
    bag = Bag(kind)
    for t_s, left, right, *_ in course():
        stamp_s = t_s - by_s * (t_s >= SET_AT_S)
        bag.joints(t_s, NAMES, [], np.array([left, right]) / RADIUS_M, stamp_s=stamp_s)
    return bag


@pytest.mark.parametrize("kind", ["ros1", "sqlite3", "mcap"])
def test_an_import_says_when_a_clock_was_set_back_and_check_remembers(kind, tmp_path):
    path = set_back_bag(kind, 1.013).write(tmp_path / name_of(kind))
    run, said = imported(tmp_path / "run", path)
    (set_back,) = run.settings["source"]["clock_set_back"]
    assert set_back["topics"] == ["/joint_states"]
    assert set_back["t"] == pytest.approx(BEGIN_NS / 1e9 + 9.95, abs=1e-6)
    assert set_back["by"] == pytest.approx(0.963)
    assert any("20 messages have stamps that had been there" in loss for loss in said.losses)
    before = np.array([speeds for t_s, *speeds, _, _, _ in course() if t_s < SET_AT_S])
    np.testing.assert_allclose(run.odometry.stack("v_left", "v_right")[: len(before)], before)
    (finding,) = (f for f in check_recording(run).findings if f.name == "clock_set_back")
    assert "go back by 0.963 s at 9.95 s of run time" in finding.line
    for part in (Span(0.0, 9.0), Span(10.5, 20.0)):
        found = check_recording(cut_run(run, part)).findings
        assert "clock_set_back" not in {f.name for f in found}


def test_the_times_of_a_recorder_whose_clock_stayed_are_whole(tmp_path):
    path = set_back_bag("mcap", 1.013).write(tmp_path / "bag")
    run, said = imported(tmp_path / "run", path, time="log")
    assert len(run.odometry) == 400
    assert "clock_set_back" not in run.settings["source"]
    assert said.losses == ()


def test_files_that_overlap_are_no_clock_that_was_set(tmp_path):
    """Snapshots of the latest seconds hold the same messages twice."""
    bag = set_back_bag("mcap", 0.0)
    parts = [
        bag.write(tmp_path / "one", lambda t_s: t_s < 12),
        bag.write(tmp_path / "two", lambda t_s: t_s >= 8),
    ]
    run, said = imported(tmp_path / "run", *parts)
    assert len(run.odometry) == 400
    assert "clock_set_back" not in run.settings["source"]
    assert any("80 messages repeat the stamp" in loss for loss in said.losses)
