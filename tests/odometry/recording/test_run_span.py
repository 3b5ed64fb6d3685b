"""A run cut by time: rows, what treads hold at the cuts, and what cannot be."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import RunFolderError
from odometry.recording.run import Robot, Run
from odometry.recording.run_span import Span, cut_run
from odometry.tables.table import Table

ODOMETRY = "t,v_left,v_right\n100,0.1,0.2\n101,0.3,0.4\n104,0.5,0.6\n105,0.7,0.8\n"
POSE = "t,x,y,yaw\n" + "".join(f"{100 + i / 2},{i},0,0\n" for i in range(11))


@pytest.fixture
def a_run(make_run):
    return Run.read(make_run(odometry=ODOMETRY, pose=POSE))


def test_treads_held_at_the_cuts_keep_their_value(a_run):
    part = cut_run(a_run, Span(0.5, 3.0))
    np.testing.assert_array_equal(part.odometry.stamps_s, [100.5, 101, 103])
    np.testing.assert_array_equal(part.odometry["v_left"], [0.1, 0.3, 0.3])
    np.testing.assert_array_equal(part.odometry.lines, [2, 3, 3])
    np.testing.assert_array_equal(part.pose.stamps_s, [100.5, 101, 101.5, 102, 102.5, 103])


def test_cuts_at_stamps_keep_these_rows_and_add_none(a_run):
    part = cut_run(a_run, Span(1.0, 4.0))
    np.testing.assert_array_equal(part.odometry.stamps_s, [101, 104])


def test_an_end_beyond_the_run_adds_nothing(a_run):
    part = cut_run(a_run, Span(1.0, 60.0))
    np.testing.assert_array_equal(part.odometry.stamps_s, [101, 104, 105])
    assert cut_run(a_run, Span()) is a_run


def test_a_table_without_a_row_is_left_out(a_run):
    assert cut_run(a_run, Span(2.1, 2.4)).pose is None


@given(
    st.lists(st.floats(0.01, 2.0), min_size=3, max_size=20),
    st.just(0.0) | st.floats(0.01, 0.9),
    st.floats(0.05, 1.0),
)
def test_wheel_travel_of_parts_adds_up(make_table_run, steps_s, share, length):
    """The travel of what lies before a cut and after it is that of the whole."""
    run = make_table_run(np.concatenate([[0.0], np.cumsum(steps_s)]))
    duration_s = run.odometry.stamps_s[-1]
    middle_s = share * duration_s
    end_s = middle_s + length * (duration_s - middle_s)
    spans = [Span(0.0, end_s), Span(middle_s, end_s)] + ([Span(0.0, middle_s)] if share else [])
    try:
        whole, after, *before = (cut_run(run, span).wheel_travel_m[-1] for span in spans)
    except RunFolderError:
        return
    assert whole == pytest.approx(after + sum(before), abs=1e-9)


@pytest.fixture(scope="module")
def make_table_run():
    def make(stamps_s):
        speeds = np.random.default_rng(1).uniform(-1, 1, (2, len(stamps_s)))
        columns = {"t": stamps_s, "v_left": speeds[0], "v_right": speeds[1]}
        table = Table(Path("odometry.csv"), columns, np.arange(len(stamps_s)) + 2)
        return Run(Path("run"), Robot(0.4), {}, table)

    return make


@pytest.mark.parametrize("span", [Span(5.0, 9.0), Span(60.0), Span(0.0, 1e-300)])
def test_nothing_left_says_how_long_the_run_is(a_run, span):
    with pytest.raises(RunFolderError, match=r"a_run: nothing lies from .* the run lasts 5\.000 s"):
        cut_run(a_run, span)


@pytest.mark.parametrize(
    ("from_s", "to_s"), [(-1.0, 2.0), (2.0, 2.0), (math.nan, 3.0), (0.0, math.nan), (math.inf,) * 2]
)
def test_a_span_that_is_none_is_an_error(from_s, to_s):
    with pytest.raises(RunFolderError, match="expected a start of 0 or more"):
        Span(from_s, to_s)


def test_dropped_lines_outside_of_the_span_are_left_out(make_run):
    """Lines 3, 5 and 8 repeat rows at 100, 101 and 105 s; the row at 100 s is held at the cut."""
    lines = ODOMETRY.splitlines()
    repeated = [lines[0], *(line for row in lines[1:] for line in (row, row))]
    del repeated[6]  # the row at 104 s once
    pose = POSE.replace("101.0,2,0,0\n", "101.0,2,0,0\n101.0,2,0,0\n")
    run = Run.read(make_run(odometry="\n".join(repeated) + "\n", pose=pose))
    assert run.odometry.repeated_lines.tolist() == [3, 5, 8]
    part = cut_run(run, Span(0.5, 4.5))
    assert part.odometry.lines.tolist() == [2, 4, 6, 6]
    assert part.odometry.repeated_lines.tolist() == [5]
    assert part.pose.repeated_lines.tolist() == [5]
    assert cut_run(run, Span(3.0, 4.5)).pose.repeated_lines.tolist() == []
