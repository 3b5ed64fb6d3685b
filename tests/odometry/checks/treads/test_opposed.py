"""One side that counts backwards, where only the treads were recorded."""

from dataclasses import replace

import pytest

from odometry.checks.recording import check_recording
from odometry.installed import shipped_data
from odometry.recording.run import Run

DEMO = Run.read(shipped_data() / "runs/demo")
TREADS = ("v_left", "v_right")


def treads_alone(left=1.0, right=1.0):
    columns = {"t": DEMO.odometry["t"], "v_left": left * DEMO.odometry["v_left"]}
    columns["v_right"] = right * DEMO.odometry["v_right"]
    odometry = replace(DEMO.odometry, columns=columns)
    return replace(DEMO, odometry=odometry, pose=None, imu=None, images=None)


def names(run):
    return {finding.name for finding in check_recording(run).findings}


@pytest.mark.parametrize("signs", [(-1, 1), (1, -1)])
def test_a_side_that_counts_backwards_is_doubted_without_other_sensors(signs):
    assert "treads_opposed" in names(treads_alone(*signs))


@pytest.mark.parametrize("signs", [(1, 1), (-1, -1)])
def test_a_robot_that_drives_on_is_not(signs):
    assert "treads_opposed" not in names(treads_alone(*signs))


def test_a_robot_whose_spins_a_gyroscope_confirms_is_not(rng):
    run = treads_alone(1, -1)
    turn = (run.odometry["v_right"] - run.odometry["v_left"]) / 1.4 / run.robot.track_width
    columns = {**run.odometry.columns, "gyro_z": turn + rng.normal(0, 0.05, len(turn))}
    assert "treads_opposed" not in names(
        replace(run, odometry=replace(run.odometry, columns=columns))
    )
