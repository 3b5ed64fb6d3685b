from dataclasses import replace

from odometry.recording.run import Robot, Run, robot_labels, run_names


def test_runs_of_one_name_are_distinguished_by_their_folders(make_run, tmp_path):
    folders = [tmp_path / "a" / "run", tmp_path / "b" / "run", tmp_path / "other"]
    run = Run.read(make_run())
    runs = [replace(run, folder=folder) for folder in folders]
    assert run_names(runs) == [str(folders[0]), str(folders[1]), "other"]


def test_parts_of_one_run_keep_its_name(make_run):
    run = Run.read(make_run())
    assert run_names([run, run]) == ["a_run", "a_run"]


def test_robots_have_short_names_where_these_distinguish_them():
    assert list(robot_labels([Robot(0.5, "A (new)"), Robot(0.6, "B (new)")]).values()) == ["A", "B"]
    alike = [Robot(0.5, "A (old)"), Robot(0.5, "A (new)"), Robot(0.5)]
    assert list(robot_labels(alike).values()) == ["A (old)", "A (new)", "robot 0.5 m wide"]
    same = [Robot(0.5, "A"), Robot(0.6, "A"), Robot(0.6, "A")]
    expected = ["A, track width 0.5 m", "A, track width 0.6 m"]
    assert list(robot_labels(same).values()) == expected
