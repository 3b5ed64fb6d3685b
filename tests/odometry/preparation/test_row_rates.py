"""Yaw rates of slow rows: means over a row, or samples at its stamp."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.estimation.config import IcrEkfConfig
from odometry.preparation.row_rates import with_row_rates
from odometry.recording.sensors import gyroscope_of
from tests.odometry.checks.drives import PERIOD_S, drive
from tests.odometry.checks.faulty import put, without_yaw

SLOW = 10  # rows of 0.05 s in one


def slow_rows(*, means, every=SLOW):
    """Means of the treads over rows of half a second, and means or samples of the gyroscope."""
    at_s = PERIOD_S * np.arange(4000)
    run = drive(0.7 + 0.6 * np.sin(at_s / 2), 0.5 * np.sin(at_s / 1.5))
    rows = {name: run.odometry[name].reshape(-1, every) for name in ("v_left", "v_right", "gyro_z")}
    columns = {name: values.mean(axis=1) for name, values in rows.items()}
    if not means:
        columns["gyro_z"] = rows["gyro_z"][:, 0]
    table = replace(run.odometry, columns={"t": at_s[::every], **columns})
    return run, replace(run, odometry=table)


def test_means_over_a_row_belong_to_its_middle():
    whole, rows = slow_rows(means=True)
    taken, (event,) = with_row_rates(rows, IcrEkfConfig())
    assert event.kind == "row_rates"
    assert event.values == pytest.approx((SLOW * PERIOD_S,))
    at_s = whole.odometry.stamps_s[20:-20]
    true_rad = gyroscope_of(whole.yaw_rate).between(at_s[0], at_s)[0]
    off = [
        np.std(gyroscope_of(run.yaw_rate).between(at_s[0], at_s)[0] - true_rad)
        for run in (rows, taken)
    ]
    assert off[1] < 0.3 * off[0]


def test_samples_stay_at_their_stamps():
    _, rows = slow_rows(means=False)
    assert with_row_rates(rows, IcrEkfConfig()) == (rows, ())


def test_fast_rows_stay_as_they_are():
    _, rows = slow_rows(means=True, every=2)
    assert with_row_rates(rows, IcrEkfConfig()) == (rows, ())


@pytest.mark.parametrize("settings", [{"causal": True}, {"watch_sensors": False}])
def test_a_filter_that_does_not_look_takes_them_as_they_are(settings):
    _, rows = slow_rows(means=True)
    assert with_row_rates(rows, IcrEkfConfig(**settings)) == (rows, ())


def with_slipping_treads(run, seed=0):
    """The run with treads whose difference says little of its turns."""
    slip = np.random.default_rng(seed).normal(0, 0.3, len(run.odometry))
    return put(
        run,
        "odometry",
        v_left=run.odometry["v_left"] + slip,
        v_right=run.odometry["v_right"] - slip,
    )


@pytest.mark.parametrize("of", [lambda run: run, without_yaw], ids=["yaw", "positions alone"])
@pytest.mark.parametrize("means", [True, False])
def test_poses_decide_where_treads_do_not(of, means):
    _, rows = slow_rows(means=means)
    slipping = with_slipping_treads(rows)
    assert with_row_rates(replace(slipping, pose=None), IcrEkfConfig())[1] == ()
    _, events = with_row_rates(of(slipping), IcrEkfConfig())
    assert len(events) == means
    assert all("goes with the poses" in event.text for event in events)


def test_samples_of_treads_and_gyroscope_are_no_means_beside_poses():
    whole, rows = slow_rows(means=False)
    picked = {name: whole.odometry[name][::SLOW] for name in ("v_left", "v_right")}
    picked = put(rows, "odometry", **picked)
    assert len(with_row_rates(replace(picked, pose=None), IcrEkfConfig())[1]) == 1
    assert with_row_rates(picked, IcrEkfConfig()) == (picked, ())
