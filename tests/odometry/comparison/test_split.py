"""Who may see what. The one claim that a comparison stands on: nothing is judged that was seen."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.comparison.judged import judged_windows
from odometry.comparison.parts import windows_of_parts
from odometry.comparison.split import of_all, robot_labels, splits
from odometry.errors import RunFolderError
from odometry.grounds import with_named_ground
from odometry.run import Robot, Run
from odometry.table import Table
from odometry.windows.config import WindowConfig

GROUNDS = st.lists(st.sampled_from(["ice", "mud", ""]), min_size=4, max_size=12)
ROBOTS = st.sampled_from([Robot(0.5, "a"), Robot(0.5, "b"), Robot(0.6, "a")])


def table(**columns):
    count = len(columns["t"])
    return Table(Path("a.csv"), columns, np.arange(count) + 2)


@st.composite
def recordings(draw):
    """A few runs of a few robots, each over a few grounds."""
    runs = []
    for number in range(draw(st.integers(1, 5))):
        grounds = draw(GROUNDS)
        t = np.arange(float(len(grounds)))
        speed = np.array(draw(st.lists(st.integers(0, 2), min_size=len(t), max_size=len(t))), float)
        odometry = table(t=t, v_left=speed, v_right=speed, terrain=np.array(grounds))
        run = Run(Path(f"/runs/{number}"), draw(ROBOTS), {"run": {"terrain": "mud"}}, odometry)
        runs.append(with_named_ground(run, None))
    return runs


def rows_of(parts):
    """(folder, row) of every row of parts."""
    return [(part.run.folder, row) for part in parts for row in np.flatnonzero(part.rows)]


@given(recordings())
def test_every_row_is_judged_once_and_never_by_a_model_that_saw_it(runs):
    planned = splits(runs)
    judged = [row for split in planned for row in rows_of(split.judged)]
    assert sorted(judged) == sorted((r.folder, i) for r in runs for i in range(len(r.odometry)))
    for split in planned:
        assert not set(rows_of(split.judged)) & set(rows_of(split.seen))
        keys = {(p.run.robot.name, p.run.robot.track_width) for p in (*split.judged, *split.seen)}
        assert len(keys) == 1
        assert {p.ground for p in (*split.judged, *split.seen)} == {split.ground}


@given(recordings(), recordings())
def test_with_training_runs_only_these_are_seen(runs, train):
    train = [replace(run, folder=Path("/train") / run.folder.name) for run in train]
    planned = splits(runs, train)
    for split in planned:
        assert {part.run.folder.parts[1] for part in split.seen} <= {"train"}
        assert {part.run.folder.parts[1] for part in split.judged} == {"runs"}
    judged = [row for split in planned for row in rows_of(split.judged)]
    assert sorted(judged) == sorted((r.folder, i) for r in runs for i in range(len(r.odometry)))


@pytest.mark.parametrize("count", [1, 3])
def test_no_window_of_training_shares_a_moment_with_a_judged_one(grass, count):
    runs = [with_named_ground(run, None) for run in grass[:count]]
    config = WindowConfig()
    for split in splits(runs):
        seen = windows_of_parts(split.seen, config)
        (part,) = split.judged
        judged = judged_windows(part, 2.0, config).windows
        for start, end in spans(judged):
            for other_start, other_end in spans(seen, part.name):
                assert end <= other_start or other_end <= start
        assert len(seen)
        assert len(judged)


def spans(windows, run=None):
    """First and last moment of every window, of one run."""
    for i in range(len(windows)):
        if run is None or windows.run[i] == run:
            steps = windows.steps_s[windows.first[i] : windows.last[i]]
            yield windows.start_s[i], windows.start_s[i] + steps.sum()


def test_words_name_what_is_seen(grass):
    runs = [with_named_ground(run, None) for run in grass]
    assert [split.words for split in splits(runs)] == [
        "run_1, run_2",
        "run_0, run_2",
        "run_0, run_1",
    ]
    assert [split.words for split in splits(runs[:1])] == [
        "the second half of the run",
        "the first half of the run",
    ]
    (split,) = splits(runs[:2], runs[2:])
    assert split.words == "run_2"
    (split,) = splits(runs[:2], [with_named_ground(replace(grass[2], settings={}), "ice")])
    assert split.words == "nothing"


def test_one_split_of_all_sees_everything(grass):
    runs = [with_named_ground(run, None) for run in grass]
    (split,) = of_all(splits(runs))
    assert {part.name for part in split.seen} == {"run_0", "run_1", "run_2"}
    (split,) = of_all(splits(runs[:1]))
    assert len(rows_of(split.seen)) == len(runs[0].odometry)


def test_a_run_given_twice_is_refused(grass):
    run = with_named_ground(grass[0], None)
    again = replace(run, folder=run.folder / ".." / run.folder.name)
    with pytest.raises(RunFolderError, match="run_0 is given twice"):
        splits([run], [again])


def test_robots_have_short_names_where_these_tell_them_apart():
    assert list(robot_labels([Robot(0.5, "A (new)"), Robot(0.6, "B (new)")]).values()) == ["A", "B"]
    alike = [Robot(0.5, "A (old)"), Robot(0.5, "A (new)"), Robot(0.5)]
    assert list(robot_labels(alike).values()) == ["A (old)", "A (new)", "robot 0.5 m wide"]
    same = [Robot(0.5, "A"), Robot(0.6, "A"), Robot(0.6, "A")]
    expected = ["A, track width 0.5 m", "A, track width 0.6 m"]
    assert list(robot_labels(same).values()) == expected
