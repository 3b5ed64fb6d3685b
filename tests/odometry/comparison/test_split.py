"""What each fit may use: no row is evaluated with a model that was identified on it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.comparison.evaluation import evaluation_windows
from odometry.comparison.split import (
    Part,
    folds,
    halves,
    of_all,
    parts_by_terrain,
    splits,
    windows_of_parts,
)
from odometry.errors import RunFolderError, WindowError
from odometry.recording.run import Robot, Run
from odometry.recording.run_terrains import with_named_terrain
from odometry.tables.table import Table
from odometry.windows.config import WindowConfig

ROWS = "t,v_left,v_right,terrain\n0,1,1,\n1,1,1,ice\n2,3,3,ice\n3,0,0,unknown\n4,1,1,ice\n"
POSES = "t,x,y,yaw\n-1,0,0,0\n0,1,0,0\n1,2,0,0\n2.5,3,0,0\n4,4,0,0\n9,5,0,0\n"
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
        runs.append(with_named_terrain(run, None))
    return runs


def rows_of(parts):
    """(folder, row) of every row of parts."""
    return [(part.run.folder, row) for part in parts for row in np.flatnonzero(part.rows)]


@given(recordings())
def test_every_row_is_held_out_once_and_never_by_a_model_that_saw_it(runs):
    planned = splits(runs)
    held_out = [row for split in planned for row in rows_of(split.held_out)]
    assert sorted(held_out) == sorted((r.folder, i) for r in runs for i in range(len(r.odometry)))
    for split in planned:
        assert not set(rows_of(split.held_out)) & set(rows_of(split.training))
        keys = {
            (p.run.robot.name, p.run.robot.track_width) for p in (*split.held_out, *split.training)
        }
        assert len(keys) == 1
        assert {p.terrain for p in (*split.held_out, *split.training)} == {split.terrain}


@given(recordings(), recordings())
def test_with_training_runs_only_these_are_seen(runs, train):
    train = [replace(run, folder=Path("/train") / run.folder.name) for run in train]
    planned = splits(runs, train)
    for split in planned:
        assert {part.run.folder.parts[1] for part in split.training} <= {"train"}
        assert {part.run.folder.parts[1] for part in split.held_out} == {"runs"}
    held_out = [row for split in planned for row in rows_of(split.held_out)]
    assert sorted(held_out) == sorted((r.folder, i) for r in runs for i in range(len(r.odometry)))


@pytest.mark.parametrize("count", [1, 3])
def test_no_window_of_training_shares_a_moment_with_an_evaluated_one(grass, count):
    runs = [with_named_terrain(run, None) for run in grass[:count]]
    config = WindowConfig()
    for split in splits(runs):
        seen = windows_of_parts(split.training, config)
        (part,) = split.held_out
        evaluated = evaluation_windows(part, 2.0, config)
        for start, end in spans(evaluated):
            for other_start, other_end in spans(seen, part.name):
                assert end <= other_start or other_end <= start
        assert len(seen)
        assert len(evaluated)


def spans(windows, run=None):
    """First and last moment of every window, of one run."""
    for i in range(len(windows)):
        if run is None or windows.run[i] == run:
            steps = windows.steps_s[windows.first[i] : windows.last[i]]
            yield windows.start_s[i], windows.start_s[i] + steps.sum()


def test_words_name_what_is_seen(grass):
    runs = [with_named_terrain(run, None) for run in grass]
    assert [split.training_names for split in splits(runs)] == [
        "run_1, run_2",
        "run_0, run_2",
        "run_0, run_1",
    ]
    assert [split.training_names for split in splits(runs[:1])] == [
        "the second half of the run",
        "the first half of the run",
    ]
    (split,) = splits(runs[:2], runs[2:])
    assert split.training_names == "run_2"
    (split,) = splits(runs[:2], [with_named_terrain(replace(grass[2], settings={}), "ice")])
    assert split.training_names == "nothing"


def test_one_split_of_all_sees_everything(grass):
    runs = [with_named_terrain(run, None) for run in grass]
    (split,) = of_all(splits(runs))
    assert {part.name for part in split.training} == {"run_0", "run_1", "run_2"}
    (split,) = of_all(splits(runs[:1]))
    assert len(rows_of(split.training)) == len(runs[0].odometry)


def test_a_run_given_twice_is_refused(grass):
    run = with_named_terrain(grass[0], None)
    again = replace(run, folder=run.folder / ".." / run.folder.name)
    with pytest.raises(RunFolderError, match="run_0 is given twice"):
        splits([run], [again])


def test_a_part_holds_its_rows_and_the_poses_within_them(make_run):
    run = with_named_terrain(Run.read(make_run(odometry=ROWS, pose=POSES)), "sand")
    part = replace(parts_by_terrain(run, "a")["ice"], start=1, stop=4)
    assert part.rows.tolist() == [False, True, True, False, False]
    cut = part.cut()
    assert cut.odometry.stamps_s.tolist() == [1, 2, 3]
    assert cut.pose.stamps_s.tolist() == [1, 2.5]
    assert run.pose.stamps_s.tolist() == [-1, 0, 1, 2.5, 4, 9]  # untouched


def test_halves_share_the_wheel_travel_on_their_terrain(make_run):
    """On ice 1 m, then 3 m: half is reached in the row of 3 m/s. Sand does not count."""
    run = with_named_terrain(Run.read(make_run(odometry=ROWS, pose=POSES)), "sand")
    first, second = halves(parts_by_terrain(run, "a")["ice"])
    assert (first.start, first.stop, second.start, second.stop) == (0, 2, 2, 5)
    assert not (first.rows & second.rows).any()


def test_halves_share_the_wheel_travel_that_was_measured(make_run):
    """Poses of the last 4 m of 10: half of these is reached at 8 s."""
    rows = "".join(f"{t},1,1\n" for t in range(11))
    poses = "".join(f"{t},{t},0,0\n" for t in range(6, 11))
    run = Run.read(make_run(odometry=f"t,v_left,v_right\n{rows}", pose=f"t,x,y,yaw\n{poses}"))
    first, second = halves(parts_by_terrain(with_named_terrain(run, None), "a")["ground"])
    assert 7 <= first.stop == second.start <= 8


def test_halves_of_a_robot_that_stands_are_not_empty(make_run):
    run = with_named_terrain(Run.read(make_run(odometry="t,v_left,v_right\n0,0,0\n1,0,0\n")), None)
    first, second = halves(parts_by_terrain(run, "a")["ground"])
    assert (first.stop, second.start) == (1, 1)


def test_windows_keep_to_the_ground_of_the_part(bench, tmp_path):
    speeds = np.full((400, 2), 0.5)
    names = ["grass"] * 220 + ["ice"] * 180
    run = with_named_terrain(
        Run.read(bench.write(tmp_path / "r", speeds, terrain_column=names)), None
    )
    parts = parts_by_terrain(run, "r")
    config = WindowConfig(horizon_m=1.0)
    for ground, part in parts.items():
        windows = windows_of_parts([part], config)
        assert set(windows.terrain) == {ground}
        inside = (windows.start_s >= 11.0) == (ground == "ice")
        assert inside.all()
    with pytest.raises(WindowError, match="no window lies wholly on 'ice' in r"):
        windows_of_parts([parts["ice"]], WindowConfig(horizon_m=5.0, shortest=1.0))


@pytest.mark.parametrize(
    ("count", "sizes"), [(2, [1, 1]), (10, [1] * 10), (11, [2] + [1] * 9), (23, [3] * 3 + [2] * 7)]
)
def test_at_most_ten_groups_of_neighbours_are_held_out(count, sizes):
    """Every part is held out once, and the training parts are all the others in order."""
    run = Run(Path("/runs/0"), Robot(0.5, "a"), {}, table(t=np.arange(2.0)))
    parts = [Part(run, str(number), "ice", 0, 2) for number in range(count)]
    found = folds("a", "ice", parts)
    assert [len(split.held_out) for split in found] == sizes
    assert [part for split in found for part in split.held_out] == parts
    for split in found:
        assert list(split.training) == [part for part in parts if part not in split.held_out]
