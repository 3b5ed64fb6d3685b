"""Poses that were computed from the treads are no reference; measured ones are, however good."""

from dataclasses import replace

import numpy as np
import pytest

from odometry import check_recording
from tests.odometry.checks.drives import winding
from tests.odometry.checks.faulty import put


def names(run):
    return [finding.name for finding in check_recording(run).findings]


def reckoned(run, rate, *, scale=1.0, base_m=0.0, noise_m=0.0):
    """Poses along the mean tread speed and a turn rate (N,), as a driver publishes them."""
    t, table = run.odometry.stamps_s, run.odometry
    steps = np.append(np.diff(t), 0.0)
    yaw = np.concatenate([[0.0], np.cumsum(rate * steps)[:-1]])
    way = scale * (table["v_left"] + table["v_right"]) / 2 * steps
    middle = yaw + rate * steps / 2
    x, y = (np.concatenate([[0.0], np.cumsum(way * of(middle))[:-1]]) for of in (np.cos, np.sin))
    at = {"x": x + base_m * np.cos(yaw), "y": y + base_m * np.sin(yaw), "yaw": yaw}
    rng = np.random.default_rng(1)
    moved = {n: np.interp(run.pose.stamps_s, t, v) for n, v in at.items()}
    moved |= {n: moved[n] + rng.normal(0, noise_m, len(run.pose)) for n in ("x", "y")}
    return put(run, "pose", **moved)


def by_gyroscope(run):
    return np.nan_to_num(run.odometry["gyro_z"])


def by_treads(run, width_m):
    return (run.odometry["v_right"] - run.odometry["v_left"]) / width_m


@pytest.mark.parametrize("base_m", [0.0, -0.3])
def test_a_filter_of_treads_and_gyroscope_is_no_reference(base_m):
    run = winding()
    report = check_recording(reckoned(run, by_gyroscope(run), base_m=base_m))
    (finding,) = (f for f in report.findings if f.name == "poses_are_wheel_odometry")
    assert "and the gyroscope" in finding.cause
    assert report.findings[0] is finding


def test_wheel_odometry_of_a_tuned_width_is_no_reference():
    run = winding()
    report = check_recording(reckoned(run, by_treads(run, 1.9)))
    assert report.findings[0].name == "poses_are_wheel_odometry"
    assert "a width of 1.9 m" in report.findings[0].seen


def test_positions_alone_are_enough():
    run = reckoned(winding(), by_gyroscope(winding()))
    without = put(run, "pose", yaw=np.full(len(run.pose), np.nan))
    assert names(without)[0] == "poses_are_wheel_odometry"


@pytest.mark.parametrize(("scale", "noise_m"), [(1.0, 0.01), (0.97, 0.0)])
def test_measured_poses_are_a_reference(scale, noise_m):
    """A centimetre of noise, or wheels that slip by three parts in a hundred."""
    run = winding()
    found = names(reckoned(run, by_gyroscope(run), scale=scale, noise_m=noise_m))
    assert "poses_are_wheel_odometry" not in found


def test_a_simulated_run_may_be_exact():
    run = reckoned(winding(), by_gyroscope(winding()))
    simulated = replace(run, truth=run.pose)
    assert "poses_are_wheel_odometry" not in names(simulated)


@pytest.mark.parametrize("delay_s", [-0.05, 0.1, 0.25])
def test_poses_that_come_later_or_belong_to_another_row_are_computed_all_the_same(delay_s):
    run = winding()
    found = put(reckoned(run, by_gyroscope(run)), "pose", t=run.pose.stamps_s + delay_s)
    assert names(found)[0] == "poses_are_wheel_odometry"


def test_a_program_that_filters_what_it_computes_is_no_reference():
    """A low pass of 0.1 s, on turns that are half of the gyroscope and half of the treads."""
    run = winding()
    t, tau_s = run.odometry.stamps_s, 0.1
    decay = np.exp(-np.diff(t) / tau_s)

    def filtered(values):
        slow = np.array(values, dtype=float)
        for row in range(1, len(slow)):
            slow[row] = decay[row - 1] * slow[row - 1] + (1 - decay[row - 1]) * values[row]
        return slow

    treads = {name: filtered(run.odometry[name]) for name in ("v_left", "v_right")}
    mixed = filtered((by_gyroscope(run) + by_treads(run, 1.9)) / 2)
    poses = reckoned(put(run, "odometry", **treads), mixed).pose
    assert names(replace(run, pose=poses))[0] == "poses_are_wheel_odometry"
