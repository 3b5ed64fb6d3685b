from dataclasses import replace

import pytest

from odometry.errors import RunFolderError
from odometry.run import Robot, Run, check_no_run_twice, robot_labels, run_names


def test_runs_of_one_name_are_distinguished_by_their_folders(make_run, tmp_path):
    folders = [tmp_path / "a" / "run", tmp_path / "b" / "run", tmp_path / "other"]
    run = Run.read(make_run())
    runs = [replace(run, folder=folder) for folder in folders]
    assert run_names(runs) == [str(folders[0]), str(folders[1]), "other"]


def test_parts_of_one_run_keep_its_name(make_run):
    run = Run.read(make_run())
    assert run_names([run, run]) == ["a_run", "a_run"]


def test_no_folder_is_there_twice_however_it_is_written(make_run):
    run = Run.read(make_run())
    again = replace(run, folder=run.folder / ".." / "a_run")
    check_no_run_twice([run])
    with pytest.raises(RunFolderError, match="a_run is given twice"):
        check_no_run_twice([run, again])


POSE_CSV = "t,x,y,yaw\n0,0,0,0\n0.1,0.05,0,0.1\n"


def test_copies_of_a_recording_are_one_whatever_their_stamps(make_run, tmp_path):
    run = Run.read(make_run(pose=POSE_CSV))

    def later(table):
        return replace(table, columns={**table.columns, "t": table["t"] + 1.7e9})

    copied = replace(
        run, folder=tmp_path / "copy", odometry=later(run.odometry), pose=later(run.pose)
    )
    with pytest.raises(RunFolderError, match=r"a_run and .*copy hold the same recording"):
        check_no_run_twice([run, copied])
    moved = replace(run.pose, columns={**run.pose.columns, "x": run.pose["x"] + 0.01})
    check_no_run_twice([run, replace(copied, pose=moved)])
    check_no_run_twice([replace(run, pose=None), replace(copied, pose=None)])  # commands


def test_robots_have_short_names_where_these_distinguish_them():
    assert list(robot_labels([Robot(0.5, "A (new)"), Robot(0.6, "B (new)")]).values()) == ["A", "B"]
    alike = [Robot(0.5, "A (old)"), Robot(0.5, "A (new)"), Robot(0.5)]
    assert list(robot_labels(alike).values()) == ["A (old)", "A (new)", "robot 0.5 m wide"]
    same = [Robot(0.5, "A"), Robot(0.6, "A"), Robot(0.6, "A")]
    expected = ["A, track width 0.5 m", "A, track width 0.6 m"]
    assert list(robot_labels(same).values()) == expected
