"""Recordings that are there twice are refused; others that look alike are not."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import RunFolderError
from odometry.recording.independent_runs import check_no_run_twice
from odometry.recording.run import Run
from odometry.recording.run_span import Span, cut_run


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


def a_drive(rng, folder, robot_run, *, seconds=60.0):
    """Tread speeds with two decimals, a gyroscope with five, poses with four."""
    t = np.arange(0, seconds, 0.1)
    left = np.round(0.5 + 0.1 * np.sin(t / 3) + rng.normal(0, 0.01, len(t)), 2)
    gyro_z = np.round(0.2 * np.sin(t) + rng.normal(0, 0.02, len(t)), 5)
    odometry = {"t": t, "v_left": left, "v_right": left + 0.05, "gyro_z": gyro_z}
    poses = np.round(np.cumsum(rng.normal(0.05, 0.01, (len(t), 3)), axis=0), 4)
    pose = {"t": t, **dict(zip(("x", "y", "yaw"), poses.T, strict=True))}
    return replace(
        robot_run,
        folder=folder,
        odometry=replace(robot_run.odometry, columns=odometry, lines=np.arange(len(t))),
        pose=replace(robot_run.pose, columns=pose, lines=np.arange(len(t))),
    )


@pytest.fixture
def drives(make_run, tmp_path, rng):
    run = Run.read(make_run(pose=POSE_CSV))
    return [a_drive(rng, tmp_path / name, run) for name in ("one", "two")]


@pytest.mark.parametrize("without", [(), ("pose",)])
def test_parts_that_overlap_are_refused_whatever_their_stamps(drives, tmp_path, without):
    run = replace(drives[0], **dict.fromkeys(without))
    first, second = (cut_run(run, span) for span in (Span(0.0, 35.0), Span(30.0, 60.0)))
    columns = {**second.odometry.columns, "t": second.odometry["t"] + 1e6}
    second = replace(
        second, folder=tmp_path / "b", odometry=replace(second.odometry, columns=columns)
    )
    with pytest.raises(RunFolderError, match=r"/one and .* parts of one recording that overlap"):
        check_no_run_twice([first, drives[1], second])


def test_parts_one_after_the_other_and_other_drives_are_independent(drives, tmp_path):
    parts = [cut_run(drives[0], span) for span in (Span(0.0, 30.0), Span(30.0, 60.0))]
    check_no_run_twice([parts[0], replace(parts[1], folder=tmp_path / "b"), drives[1]])


def test_a_robot_that_stands_repeats_its_values_by_itself(drives, tmp_path):
    def standing(run):
        still = {name: np.zeros(len(run.odometry)) for name in ("v_left", "v_right", "gyro_z")}
        odometry = replace(run.odometry, columns={"t": run.odometry["t"], **still})
        return replace(run, odometry=odometry, pose=None)

    longer = standing(a_drive(np.random.default_rng(1), tmp_path / "b", drives[0], seconds=70.0))
    check_no_run_twice([standing(drives[0]), longer])
