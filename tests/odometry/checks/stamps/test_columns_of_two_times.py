"""One column of the treads late against the other, values that are held, and rows of two runs."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.stamps.explained_lags import explained_lags
from odometry.checks.stamps.one_column_late import _squares_left
from odometry.tables.table import Table
from tests.odometry.checks.drives import drive, varied
from tests.odometry.checks.faulty import put, treads, without_gyroscope

ROWS = 4000


def warnings(run):
    return list(check_recording(run).at(Level.WARNING))


@pytest.mark.parametrize(("rows", "side"), [(10, "v_left"), (16, "v_right")])
def test_a_column_that_is_shifted_is_named_with_its_time(rows, side):
    run = varied()
    (found,) = warnings(put(run, "odometry", **{side: np.roll(run.odometry[side], rows)}))
    assert found.name == "tread_late"
    assert found.cause.startswith(f"{side} alone is late")
    assert f"{rows * 0.05:.2f} s" in found.seen
    mended = found.mend(put(run, "odometry", **{side: np.roll(run.odometry[side], rows)}))
    inside = slice(100, -100)
    off = mended.odometry[side][inside] - run.odometry[side][inside]
    assert np.sqrt(np.mean(off**2)) < 0.05 * np.std(run.odometry[side])


def test_both_columns_late_are_no_column_late():
    run = varied()
    (found,) = warnings(treads(run, lambda left, right: (np.roll(left, 12), np.roll(right, 12))))
    assert found.name == "treads_late"


def test_yaw_that_follows_the_speed_is_no_column_late():
    """Without a gyroscope its turns are those of two columns of different times."""
    run = without_gyroscope(varied())
    speed = np.interp(run.pose["t"], run.odometry["t"], run.odometry["v_left"])
    beside = put(run, "pose", yaw=run.pose["yaw"] + 0.6 * speed)
    assert "tread_late" not in [finding.name for finding in warnings(beside)]


def test_a_drive_that_hardly_turns_has_no_column_late():
    at_s = 0.05 * np.arange(ROWS)
    run = drive(0.5 + 0.4 * np.sin(at_s), 0.05 * np.sin(at_s / 1.7))
    shifted = put(run, "odometry", v_left=np.roll(run.odometry["v_left"], 12))
    assert "tread_late" not in [finding.name for finding in warnings(shifted)]


def test_columns_of_a_straight_drive_explain_no_turns(rng):
    left, turns = rng.normal(1, 0.3, 80)[None, :], rng.normal(0, 1e-3, 80)
    right = left + 1e-4 * turns
    assert _squares_left(left, right, turns) > 0.9 * np.sum(turns**2)


def test_columns_of_a_spin_explain_its_turns_at_one_time(rng):
    left = rng.normal(0, 0.3, 80)[None, :]
    turns = -2.0 * left[0] + rng.normal(0, 1e-2, 80)
    assert _squares_left(left, -left, turns) < 0.01 * np.sum(turns**2)


@pytest.mark.parametrize("held_s", [0.7, 1.2, "irregular"])
def test_speeds_that_are_held_are_not_late(held_s):
    run = varied()
    t = run.odometry["t"]
    steps = np.random.default_rng(1).uniform(0.3, 1.5, 500) if held_s == "irregular" else held_s
    begins = t[0] + np.cumsum(np.broadcast_to(steps, 500))
    rows = np.searchsorted(t, np.append(t[0], begins)[np.searchsorted(begins, t, side="right")])
    rows = np.minimum(rows, np.arange(len(t)))
    (found,) = warnings(treads(run, lambda left, right: (left[rows], right[rows])))
    assert found.name == "treads_held"


def joined(first, second, gap_s):
    """Tables of one drive after those of another."""
    later_s = first.odometry["t"][-1] + gap_s

    def one(table, other):
        columns = {
            name: np.concatenate([table[name], other[name] + later_s * (name == "t")])
            for name in table.columns
        }
        return Table(Path(table.file), columns, np.arange(2, 2 + len(columns["t"])))

    tables = {
        name: one(getattr(first, name), getattr(second, name)) for name in ("odometry", "pose")
    }
    return replace(first, **tables)


def elsewhere(run):
    return put(run, "pose", x=30 - run.pose["x"], y=8 - run.pose["y"], yaw=run.pose["yaw"] + np.pi)


@pytest.mark.parametrize(("gap_s", "gyroscope"), [(0.1, True), (1.0, False)])
def test_two_recordings_in_one_file_are_said_before_what_else_moves_poses(gap_s, gyroscope):
    run = joined(varied(), elsewhere(varied(seed=3)), gap_s)
    (found,) = warnings(run if gyroscope else without_gyroscope(run))
    assert found.name == "recordings_joined"
    assert "cannot be distinguished" in found.cause
    assert found.spans_s[0][0] == pytest.approx(ROWS * 0.05, abs=0.5)


@pytest.mark.parametrize(("row", "turn_rad"), [(900, 1.0), (900, 0.0), (15, 0.0)])
def test_positions_that_jump_in_motion_or_without_yaw_are_no_file_of_two(row, turn_rad):
    """Row 15 lies in the rest of two seconds from which the drive begins."""
    run = varied()
    later = np.arange(len(run.pose)) > row
    columns = {"x": run.pose["x"] + 8.0 * later, "yaw": run.pose["yaw"] + turn_rad * later}
    names = [finding.name for finding in warnings(put(run, "pose", **columns))]
    assert names
    assert "recordings_joined" not in names


def test_turns_that_are_late_where_the_way_is_not_are_no_late_treads():
    """A filter of the turn rate alone, before both speeds were made of it."""
    run = varied()

    def late_turns(left, right):
        mean, half = (left + right) / 2, np.roll((right - left) / 2, 10)
        return mean - half, mean + half

    (found,) = explained_lags(Evidence(treads(run, late_turns)))
    assert found.name == "sensors_disagree"
    assert "mean and difference of the treads" in found.seen
