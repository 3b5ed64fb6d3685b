"""What result.json and the commands say of the filter."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.estimation.filter_event import FilterEvent
from terrain.main_job import run_odometry
from terrain.result.evaluation_notes import event_line, filter_table, misleading

YAW = FilterEvent("initial_yaw", 0.0, 6.5, "initial yaw 12.0 degrees", (0.2, 0.01))
ANEW = FilterEvent("reinitialised", 8.0, 8.0, "it started anew")


@pytest.fixture(scope="module")
def noticed(curvy_run):
    """A replay in which two things were noticed."""
    result = run_odometry(curvy_run)
    first, *between, last = result.replay.estimates
    estimates = (replace(first, events=(YAW,)), *between, replace(last, events=(ANEW,)))
    return replace(result, replay=replace(result.replay, estimates=estimates))


def test_events_are_listed_in_order_and_the_initial_yaw_in_numbers(noticed):
    table = filter_table(noticed.replay)
    assert [event["kind"] for event in table["events"]] == ["initial_yaw", "reinitialised"]
    assert table["events"][0] == {
        "kind": "initial_yaw",
        "begin_s": 0.0,
        "end_s": 6.5,
        "text": "initial yaw 12.0 degrees",
    }
    assert table["initial_yaw"] == {"yaw_rad": 0.2, "sigma_rad": 0.01}
    assert table["gyro_bias_rad_s"] is None


def test_the_bias_of_a_gyroscope_is_printed_with_its_deviation(tmp_path, world):
    folder = world.drive_curves(tmp_path / "run")
    header, *rows = (folder / "odometry.csv").read_text().split()
    rates = [np.diff([float(cell) for cell in row.split(",")[1:]])[0] / 0.5 for row in rows]
    lines = [f"{row},{rate + 0.02:.9g}" for row, rate in zip(rows, rates, strict=True)]
    (folder / "odometry.csv").write_text("\n".join([f"{header},gyro_z", *lines]) + "\n")
    table = filter_table(run_odometry(folder).replay)
    assert table["gyro_bias_rad_s"] == pytest.approx(0.02, abs=0.01)
    assert 0 < table["sigma_gyro_bias_rad_s"] < 0.02


def test_an_initial_yaw_found_misleads_nobody_a_new_start_does(noticed):
    assert misleading(noticed.replay) == [ANEW]


@pytest.mark.parametrize(
    ("kind", "misleads"),
    [("heading_found", False), ("gyroscope_drift_followed", False), ("gyroscope_drift", True)],
)
def test_a_drift_misleads_only_where_it_was_not_followed(noticed, kind, misleads):
    first, *others = noticed.replay.estimates
    estimates = (replace(first, events=(FilterEvent(kind, 0.0, 9.0, kind),)), *others[:-1])
    assert bool(misleading(replace(noticed.replay, estimates=estimates))) == misleads


def test_an_event_is_one_line_with_its_time():
    assert event_line(YAW, 0.0) == "0.0 to 6.5 s: initial yaw 12.0 degrees"
    assert event_line(ANEW, 5.0) == "3.0 s: it started anew"
