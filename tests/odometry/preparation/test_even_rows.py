"""Rows with stamps of arrival, as the filter takes them."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.estimation.config import IcrEkfConfig
from odometry.preparation.even_rows import EARLY_S, with_even_rows
from odometry.preparation.prepared import prepared_run
from terrain.main_job import run_odometry
from tests.odometry.arrivals import after_stalls, by_chance, cut_off, with_arrival
from tests.odometry.checks.drives import PERIOD_S, table, winding
from tests.odometry.checks.faulty import pose_stamps, without_yaw


@pytest.fixture(scope="module")
def driven():
    return winding()


def test_late_rows_are_taken_at_even_stamps(driven):
    late = with_arrival(driven)
    taken, (event,) = with_even_rows(late, IcrEkfConfig())
    assert event.kind == "late_rows"
    before, after = (
        np.std(run.odometry.stamps_s - driven.odometry.stamps_s) for run in (late, taken)
    )
    assert after < 0.3 * before
    assert event.values[0] == pytest.approx(before, rel=0.2)
    assert prepared_run(late, IcrEkfConfig(), ())[2][0] == event


def test_rows_that_share_a_coarse_stamp_are_there_again(driven):
    coarse = with_arrival(driven, lambda stamps_s: cut_off(stamps_s, 1.0))
    assert len(coarse.odometry) < len(driven.odometry) / 19
    taken, (event,) = with_even_rows(coarse, IcrEkfConfig())
    assert taken.odometry["v_left"].tolist() == driven.odometry["v_left"].tolist()
    assert np.abs(taken.odometry.stamps_s - driven.odometry.stamps_s).max() < 0.1
    assert "steps of 1 s, which 20 rows share" in event.text
    assert taken.odometry.repeated is None


def test_stamps_that_were_rounded_are_put_right_by_the_yaw_of_poses(driven):
    """To the nearest second: half of one later than stamps of which the rest was cut off."""
    coarse = with_arrival(driven, lambda stamps_s: cut_off(stamps_s + 0.5, 1.0))
    taken, (event,) = with_even_rows(coarse, IcrEkfConfig())
    assert "by the yaw of poses" in event.text
    assert np.mean(taken.odometry.stamps_s - driven.odometry.stamps_s) == pytest.approx(0, abs=0.06)


@pytest.mark.parametrize("of_all_s", [0.2, 0.4])
def test_what_all_rows_are_late_by_is_that_of_the_poses(driven, of_all_s):
    """These poses are a row early, as usual ones are."""
    late = with_arrival(driven, lambda stamps_s: of_all_s + by_chance(stamps_s, 0.2))
    taken, (event,) = with_even_rows(late, IcrEkfConfig())
    assert "by the yaw of poses" in event.text
    left_s = taken.odometry.stamps_s - driven.odometry.stamps_s
    assert np.mean(left_s) == pytest.approx(EARLY_S - PERIOD_S, abs=0.03)


@pytest.mark.parametrize(
    ("change", "settings"),
    [
        (without_yaw, {}),
        (lambda run: pose_stamps(run, lambda stamps_s: stamps_s + 0.5), {}),
        (lambda run: pose_stamps(run, lambda stamps_s: stamps_s - 3), {}),
        (lambda run: run, {"pose_delay_s": 0.1}),
    ],
    ids=["no yaw", "late poses", "poses far too early", "a given delay"],
)
def test_what_all_rows_are_late_by_is_not_known_otherwise(driven, change, settings):
    late = change(with_arrival(driven, lambda stamps_s: 0.2 + by_chance(stamps_s, 0.2)))
    taken, (event,) = with_even_rows(late, IcrEkfConfig(**settings))
    assert event.text.endswith("what all of them are late by is not known")
    assert event.values[1] == 0.0
    assert np.mean(taken.odometry.stamps_s - driven.odometry.stamps_s) > 0.2


def test_rows_of_an_imu_are_as_well(driven):
    late = with_arrival(driven).odometry
    imu = table("imu.csv", t=late.stamps_s, gyro_z=driven.odometry["gyro_z"])
    taken, (event,) = with_even_rows(replace(driven, imu=imu), IcrEkfConfig())
    assert "rows of imu.csv" in event.text
    assert taken.odometry is driven.odometry


def test_even_rows_stay_as_they_are(driven):
    assert with_even_rows(driven, IcrEkfConfig()) == (driven, ())


@pytest.mark.parametrize("settings", [{"causal": True}, {"watch_sensors": False}])
def test_a_filter_that_does_not_look_takes_them_as_they_are(driven, settings):
    late = with_arrival(driven)
    assert with_even_rows(late, IcrEkfConfig(**settings)) == (late, ())


def test_rows_that_came_at_once_turn_the_odometer_as_if_on_time():
    """0.18 degrees per m with even stamps, 0.46 with those of arrival."""
    stalled = with_arrival(winding(1000), after_stalls)
    scores = run_odometry(stalled, vision=False).scores
    assert scores["odometer"].mean_rotation_deg_per_m < 0.25
