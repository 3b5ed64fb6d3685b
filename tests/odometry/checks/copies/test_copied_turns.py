"""A gyroscope and treads of which one was computed from the other are no two sensors."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from odometry import check_recording
from odometry.checks.copies.repetition import repetition
from tests.odometry.checks.drives import table, winding
from tests.odometry.checks.faulty import gyroscope, put


def names(run):
    return [finding.name for finding in check_recording(run).findings]


def by_treads(run, width_m=0.6):
    rate = (run.odometry["v_right"] - run.odometry["v_left"]) / width_m
    return gyroscope(run, lambda _: rate)


def by_gyroscope(run, width_m=0.6):
    mean = (run.odometry["v_left"] + run.odometry["v_right"]) / 2
    half = run.odometry["gyro_z"] * width_m / 2
    return put(run, "odometry", v_left=mean - half, v_right=mean + half)


def low_pass(run, tau_s):
    """Row by row, in place of the gyroscope."""
    slow = run.odometry["gyro_z"].copy()
    kept = np.exp(-np.diff(run.odometry.stamps_s) / tau_s)
    for row in range(1, len(slow)):
        slow[row] = kept[row - 1] * slow[row - 1] + (1 - kept[row - 1]) * slow[row]
    return gyroscope(run, lambda _: slow)


def test_the_twist_of_an_odometry_topic_is_no_gyroscope():
    report = check_recording(by_treads(winding()))
    assert [finding.name for finding in report.findings] == ["gyroscope_is_treads"]
    assert "(v_right - v_left) / 0.6 m (the track_width)" in report.findings[0].seen
    assert "simulated without noise" in report.findings[0].cause


@pytest.mark.parametrize(
    "change",
    [
        lambda run: gyroscope(run, np.negative),
        lambda run: gyroscope(run, lambda rate: np.round(rate, 3)),
        lambda run: gyroscope(run, lambda rate: np.r_[rate[0], rate[:-1]]),
        lambda run: gyroscope(
            run, lambda rate: np.interp(run.odometry["t"] - 0.12, run.odometry["t"], rate)
        ),
        lambda run: low_pass(run, 0.1),
        lambda run: low_pass(run, 0.3),
    ],
    ids=["negated", "rounded", "next row", "late", "low pass", "slow low pass"],
)
def test_a_copy_is_one_whatever_a_program_does_to_it(change):
    found = check_recording(change(by_treads(winding(), 1.4))).findings
    assert found[0].name == "gyroscope_is_treads"


def test_the_time_of_the_low_pass_is_said():
    found = check_recording(low_pass(by_treads(winding()), 0.3)).findings
    assert "through a low pass of 0.3 s" in found[0].seen


def test_treads_through_a_low_pass_of_the_gyroscope_were_computed():
    raw = winding()
    slow = by_gyroscope(low_pass(raw, 0.1), 0.9)
    found = check_recording(gyroscope(slow, lambda _: raw.odometry["gyro_z"])).findings
    assert found[0].name == "treads_are_gyroscope"


@pytest.mark.parametrize("width_m", [0.6, 0.9])
def test_where_both_turn_as_measured_either_may_be_the_copy(width_m):
    (finding,) = check_recording(by_gyroscope(winding(), width_m)).findings
    assert finding.name == "turns_recorded_once"
    assert "cannot be distinguished" in finding.cause


def test_a_copy_confirms_no_other_fault():
    """Treads and their copy are not two against one: poses are not mirrored, treads are swapped."""
    run = winding()
    left, right = run.odometry["v_left"], run.odometry["v_right"]
    found = names(by_treads(put(run, "odometry", v_left=right, v_right=left), 0.9))
    assert found[0] in {"gyroscope_is_treads", "turns_recorded_once"}
    report = check_recording(by_treads(put(run, "odometry", v_left=right, v_right=left), 0.9))
    assert "treads are swapped" in report.findings[1].cause


def test_a_copy_in_imu_csv_at_a_rate_of_its_own():
    run = winding()
    t, rate = run.odometry.stamps_s, by_treads(run).odometry["gyro_z"]
    at_s = np.arange(t[0], t[-1], 0.01)
    rows = np.searchsorted(t, at_s, side="right") - 1
    copied = replace(run, imu=table("imu.csv", t=at_s, gyro_z=rate[rows]))
    found = check_recording(copied).findings
    assert found[0].name == "gyroscope_is_treads"
    assert "gyro_z of imu.csv" in found[0].seen


def test_sensors_of_a_tenth_of_the_noise_are_two():
    run, rng = winding(), np.random.default_rng(3)
    at_s = run.odometry.stamps_s
    rate = 0.5 * np.sin(at_s / 3) + 0.2 * np.sin(at_s / 1.3)
    left, right = (
        1 + 0.3 * np.sin(at_s / 7) + side * rate * 0.45 + rng.normal(0, 0.001, len(at_s))
        for side in (-1, 1)
    )
    gyro_z = rate + rng.normal(0, 0.0003, len(at_s))
    assert names(put(run, "odometry", v_left=left, v_right=right, gyro_z=gyro_z)) == []


@pytest.mark.parametrize("fastest_rad_s", [2.0, 6.0])
def test_a_quiet_gyroscope_over_exact_treads_is_a_sensor(fastest_rad_s):
    """In a lively drive little of the changes is noise; what is left is that of a gyroscope."""
    run, rng = winding(), np.random.default_rng(5)
    at_s = run.odometry.stamps_s
    rate = 0.5 * np.sin(fastest_rad_s * at_s) + 0.3 * np.sin(at_s / 3)
    left, right = (1 + 0.3 * np.sin(at_s / 7) + side * rate * 0.45 for side in (-1, 1))
    gyro_z = rate + rng.normal(0, 0.003, len(at_s))
    found = names(put(run, "odometry", v_left=left, v_right=right, gyro_z=gyro_z))
    assert not {"gyroscope_is_treads", "treads_are_gyroscope", "turns_recorded_once"} & set(found)


def test_an_average_of_rows_is_a_copy():
    run = by_treads(winding())
    averaged = gyroscope(run, lambda rate: np.convolve(rate, np.ones(5) / 5, "same"))
    assert findings_first(averaged).name == "gyroscope_is_treads"
    assert "neighbouring rows" in findings_first(averaged).seen


def findings_first(run):
    return check_recording(run).findings[0]


def test_rows_stamped_at_arrival_need_no_more_memory_than_others():
    """Most of them within a microsecond: the search for a delay was of millions of rows."""
    run = winding(300)
    stamps_s = run.odometry.stamps_s
    arrived_s = np.floor(stamps_s / 0.25) * 0.25 + 1e-7 * np.arange(len(stamps_s))
    rates = run.odometry["gyro_z"]
    tracemalloc.start()
    repetition(arrived_s, rates, arrived_s, rates[:, None] + 0.1)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 5e6
