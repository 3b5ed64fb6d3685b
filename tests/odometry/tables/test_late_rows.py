"""Rows of a steady sensor with stamps of their arrival."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.recording.run import with_table
from odometry.recording.run_span import Span, cut_run
from odometry.tables.late_rows import SLACK, even_stamps_s, late_rows
from tests.odometry.arrivals import after_stalls, by_chance, cut_off, stamped
from tests.odometry.checks.drives import PERIOD_S, table, winding


@pytest.fixture(scope="module")
def rows():
    """Two minutes at 20 Hz."""
    return winding().odometry


LATE = {
    "by chance": by_chance,
    "a twentieth, by more": lambda t: by_chance(t, 0.2, 0.05),
    "after stalls": after_stalls,
    "after one stall": lambda t: after_stalls(t, 70.0),
    "after a stall, ended by another row": lambda t: after_stalls(t, 70.01),
    "twenty at once": lambda t: by_chance(np.repeat(t[19::20], 20), 1e-4),
    "polled": lambda t: by_chance(0.33 * np.ceil(t / 0.33), 1e-4),
}


@pytest.mark.parametrize("step_s", [1e-6, 1e-3, 1e-2])
@pytest.mark.parametrize("change", LATE.values(), ids=LATE)
def test_even_stamps_are_nearly_those_of_the_measurement(rows, change, step_s):
    """Rows that came at once share stamps of few digits: the reader drops all but the first."""
    arrived_s = cut_off(change(rows.stamps_s), step_s)
    late = late_rows(stamped(rows, arrived_s))
    assert late.period_s == pytest.approx(PERIOD_S, rel=0.01)
    assert np.std(late.even_s - rows.stamps_s) < 0.3 * np.std(arrived_s - rows.stamps_s)
    assert late.late_s == pytest.approx(arrived_s - late.even_s)
    assert late.rows["v_left"].tolist() == rows["v_left"].tolist()
    assert not late.are_coarse


@pytest.mark.parametrize("step_s", [0.1, 0.25, 1.0])
@pytest.mark.parametrize("began_s", [0.0, 0.03, 1.7e9 + 0.02])
def test_rows_of_coarse_stamps_are_spread_over_their_steps(rows, step_s, began_s):
    true_s = began_s + rows.stamps_s
    late = late_rows(stamped(rows, cut_off(true_s, step_s)))
    assert (late.step_s, late.are_coarse) == (step_s, True)
    assert np.abs(late.even_s - true_s).max() < PERIOD_S + 3 * SLACK * step_s
    assert len(late.even_s) == len(rows)


@pytest.mark.parametrize("span", [Span(10.3, 70.7), Span(10.3), Span(0.0, 70.7)])
def test_rows_of_coarse_stamps_are_spread_in_a_part_of_the_run(span):
    run = winding()
    true_s = run.odometry.stamps_s
    part = cut_run(with_table(run, "odometry", stamped(run.odometry, cut_off(true_s, 1.0))), span)
    late = late_rows(part.odometry)
    assert late.are_coarse
    off_s = late.even_s - true_s[late.rows.lines - 2]
    assert np.abs(off_s[1:]).max() < 2 * PERIOD_S  # the first is held from before


def test_rows_that_are_late_by_more_than_a_step_came_late(rows):
    assert not late_rows(stamped(rows, cut_off(by_chance(rows.stamps_s, 0.3), 0.1))).are_coarse


def test_treads_that_are_measured_in_turn_are_no_merged_logs(rows):
    row = np.arange(len(rows))
    left, right = rows["v_left"][row // 6 * 6], rows["v_right"][np.abs(row - 3) // 6 * 6]
    slow = replace(rows, columns={**rows.columns, "v_left": left, "v_right": right})
    assert late_rows(stamped(slow, by_chance(rows.stamps_s))) is not None


def test_even_stamps_are_the_earliest_that_later_rows_allow():
    arrived_s = by_chance(PERIOD_S * np.arange(60))
    step_s = (1 - SLACK) * PERIOD_S
    expected_s = [
        min(arrived_s[j] - step_s * (j - i) for j in range(i, len(arrived_s)))
        for i in range(len(arrived_s))
    ]
    assert even_stamps_s(arrived_s, PERIOD_S) == pytest.approx(np.array(expected_s))


def test_a_gap_stays_where_no_row_came():
    arrived_s = np.array([0.0, 0.05, 0.1, 5.0, 5.001, 5.1])
    even_s = even_stamps_s(arrived_s, PERIOD_S)
    assert even_s[3] - even_s[2] > 4.8
    assert (even_s <= arrived_s).all()


def lost(rows, share, seed=0):
    kept = np.flatnonzero(np.random.default_rng(seed).random(len(rows)) > share)
    return stamped(rows, rows.stamps_s[kept], kept)


def without_a_second(rows):
    kept = np.flatnonzero(np.abs(rows.stamps_s - 50) > 0.5)
    return stamped(rows, rows.stamps_s[kept], kept)


def test_rows_on_time_stay_where_they_are_though_many_are_lost(rows):
    few = lost(rows, 0.1)
    stalled = late_rows(stamped(few, after_stalls(few.stamps_s, 30.0)))
    on_time = few.stamps_s % 30 < 29
    assert np.abs(stalled.late_s[on_time]).max() < 0.5 * PERIOD_S


def own_times(rows, draw):
    return stamped(rows, np.cumsum(draw(np.random.default_rng(0), len(rows))))


def of_changes(rows, limit_m_s):
    """Rows where a speed changed by so much since the last one."""
    speeds, kept = rows.stack("v_left", "v_right"), [0]
    for row in range(len(rows)):
        if np.abs(speeds[row] - speeds[kept[-1]]).max() > limit_m_s:
            kept.append(row)
    return stamped(rows, rows.stamps_s[kept], np.array(kept))


def twice(rows):
    each = np.repeat(np.arange(len(rows)), 2)
    return stamped(rows, rows.stamps_s[each] + 2e-3 * (np.arange(len(each)) % 2), each)


def merged(rows):
    """The latest of treads at 20 Hz and of a gyroscope at 50 Hz, both with stamps that are off."""
    rng, columns = np.random.default_rng(0), {}
    of_treads, of_gyroscope = (
        np.sort(even_s + rng.exponential(0.004, len(even_s)))
        for even_s in (np.arange(0, 119, PERIOD_S), np.arange(0, 119, 0.02))
    )
    stamps_s = np.unique(np.concatenate([of_treads, of_gyroscope]))[4:]
    for name in ("v_left", "v_right", "gyro_z"):
        own_s = of_gyroscope if name == "gyro_z" else of_treads
        latest_s = own_s[np.searchsorted(own_s, stamps_s, side="right") - 1]
        columns[name] = np.interp(latest_s, rows.stamps_s, rows[name])
    return table("odometry.csv", t=stamps_s, **columns)


def now_and_then(rows):
    kept = np.flatnonzero(rows.stamps_s % 5 < 1)
    return stamped(rows, rows.stamps_s[kept], kept)


def at_one_stamp(rows, second, step_s=1e-3):
    """Each row is followed by another of its stamp."""
    each = np.repeat(np.arange(len(rows)), 2)
    both = stamped(rows, rows.stamps_s[each] + 1e-9 * (np.arange(len(each)) % 2), each)
    for name in ("v_left", "v_right", "gyro_z"):
        both.columns[name][1::2] = second(rows[name])
    return stamped(both, cut_off(both.stamps_s, step_s))


OTHERS = {
    "copies at one stamp": lambda rows: at_one_stamp(rows, lambda v: v),
    "copies in other digits": lambda rows: at_one_stamp(rows, np.float32),
    "a command beside": lambda rows: at_one_stamp(rows, lambda v: np.roll(v, -8)),
    "another robot beside": lambda rows: at_one_stamp(rows, lambda v: np.roll(v, 800), 0.1),
    "times by chance, in ms": lambda rows: stamped(
        rows, cut_off(own_times(rows, lambda r, n: r.exponential(0.05, n)).stamps_s, 1e-3)
    ),
    "changes of 0.02 m/s, in 0.1 s": lambda rows: stamped(
        changed := of_changes(rows, 0.02), cut_off(changed.stamps_s, 0.1)
    ),
    "even": lambda rows: rows,
    "rows lost": lambda rows: lost(rows, 0.1),
    "rows lost at most times": lambda rows: lost(rows, 0.6),
    "times of their own": lambda rows: own_times(rows, lambda r, n: r.uniform(0.01, 0.09, n)),
    "times by chance": lambda rows: own_times(rows, lambda r, n: r.exponential(0.05, n)),
    "changes of 0.02 m/s": lambda rows: of_changes(rows, 0.02),
    "changes of 0.1 m/s": lambda rows: of_changes(rows, 0.1),
    "each row twice": twice,
    "two logs merged": merged,
    "now and then": now_and_then,
    "a second lost": without_a_second,
    "set ahead": lambda rows: stamped(rows, rows.stamps_s + 3.0 * (rows.stamps_s > 60)),
    "few": lambda rows: stamped(rows, by_chance(rows.stamps_s)[:60], slice(60)),
    "late by little": lambda rows: stamped(rows, by_chance(rows.stamps_s, 0.005)),
    "back in time": lambda rows: stamped(rows, rows.stamps_s[::-1]),
}


@pytest.mark.parametrize("log", OTHERS.values(), ids=OTHERS)
def test_other_logs_have_no_late_rows(rows, log):
    assert late_rows(log(rows)) is None


@pytest.fixture(scope="module")
def longer_rows():
    """Eight minutes at 20 Hz."""
    return winding(9600).odometry


@pytest.mark.parametrize("step_s", [1e-6, 0.1, 1.0])
@pytest.mark.parametrize("limit_m_s", [0.04, 0.05])
def test_logs_of_changes_have_no_late_rows_though_changes_come_evenly(
    longer_rows, limit_m_s, step_s
):
    changed = of_changes(longer_rows, limit_m_s)
    assert late_rows(stamped(changed, cut_off(changed.stamps_s, step_s))) is None


@pytest.mark.parametrize(
    ("rows_a_second", "share"), [(13.7, 0.0), (43.6, 0.0), (53.2, 0.0), (106.6, 0.0), (50.0, 0.3)]
)
def test_no_rate_moves_rows_of_whole_seconds_far_from_theirs(longer_rows, rows_a_second, share):
    """200 rows last no whole seconds: most of their periods are rounded to one side."""
    fast = stamped(longer_rows, np.arange(len(longer_rows)) / rows_a_second)
    few = lost(fast, share)
    late = late_rows(stamped(few, cut_off(few.stamps_s, 1.0)))
    assert late.period_s == pytest.approx(1 / rows_a_second / (1 - share), rel=0.01)
    assert np.abs(late.even_s - few.stamps_s).max() < 1.0 + share


def test_a_column_without_numbers_does_not_hide_that_rows_repeat(rows):
    again = twice(rows)
    again.columns["gyro_z"] = np.full(len(again), np.nan)
    assert late_rows(again) is None
