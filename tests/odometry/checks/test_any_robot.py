"""Clean drives of small, slow, wide and coarse robots: nothing in them is at fault."""

from pathlib import Path

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.poses.course_offsets import course_apart
from odometry.checks.recording import check_recording
from odometry.recording.run import Run
from tests.blind.any_robot import write_clean_run

# What is true of them, and no fault.
TRUE = {"coarse_speeds", "noisy_positions", "gyroscope_bias", "one_motion", "straight_drives"}


@pytest.mark.parametrize(
    ("seed", "was_said"),
    [
        (7, "one tread turns the robot less: a bias of the gyroscope"),
        (145, "it is blocked in turns: slow ones beside a bias"),
        (17, "the course does not keep to yaw: noise of a slow robot"),
        (31, "both columns hold one speed: it drives straight"),
        (34, "it is stuck: it drives round in a small circle"),
        (36, "poses part from treads: after the last row of these"),
        (96, "poses jump: between two of them the robot turns by 3 rad"),
        (101, "positions are scaled: noise is more than the circle"),
        (164, "the path is another one: many rounds at an unknown width"),
        (50124, "columns are a twist: it drives one circle"),
        (50097, "the sensor is far to the side: it drives one circle"),
        (258, "turns are beyond any slip: noise of the gyroscope"),
    ],
)
def test_nothing_is_found(tmp_path, seed, was_said):
    write_clean_run(tmp_path / "run", seed)
    found = {f.name: f.seen for f in check_recording(tmp_path / "run").findings}
    assert not found.keys() - TRUE, was_said


def _column(folder: Path, file: str, name: str, values) -> None:
    header, *rows = (folder / file).read_text("utf-8").splitlines()
    place = header.split(",").index(name)
    cells = [row.split(",") for row in rows]
    for row, value in zip(cells, values, strict=True):
        row[place] = f"{value:.6f}"
    (folder / file).write_text("\n".join([header, *map(",".join, cells)]) + "\n", "utf-8")


def test_a_bias_larger_than_all_turns_is_no_lost_sign(tmp_path):
    folder = tmp_path / "run"
    write_clean_run(folder, 2096)
    rates = Run.read(folder).odometry["gyro_z"]
    assert rates.min() > 0
    assert "gyroscope_unrelated" not in {f.name for f in check_recording(folder).findings}


def test_a_yaw_that_does_not_turn_is_not_the_course(tmp_path):
    folder = tmp_path / "run"
    write_clean_run(folder, 17)
    assert not course_apart(Evidence(Run.read(folder)))
    _column(folder, "pose.csv", "yaw", np.zeros(len(Run.read(folder).pose)))
    assert "does not keep to its yaw" in course_apart(Evidence(Run.read(folder)))
