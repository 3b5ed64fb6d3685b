"""Slow speeds that read zero, and an encoder that is lost at any speed."""

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import WIDTH_M, drive
from tests.odometry.checks.faulty import SENSORS, held, limited, put


def slow_for_a_while():
    """Speeds of 0.6 m/s and less for 20 s, and of up to 1.4 m/s elsewhere."""
    at_s = 0.05 * np.arange(3200)
    speed = np.where((at_s > 60) & (at_s < 80), 0.4, 1.0) * (1 + 0.4 * np.sin(at_s / 3))
    return drive(speed, 0.9 * speed * np.sin(at_s / 1.7))


@pytest.mark.parametrize(
    ("sensors", "name"), list(zip(SENSORS, ("v_left", "v_right", "v_left"), strict=True))
)
def test_a_tread_that_reads_no_slow_speed_is_not_lost(name, sensors):
    run = SENSORS[sensors](slow_for_a_while())
    run = limited(run, name, lambda v: np.where(np.abs(v) < 0.7, 0.0, v))
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "slow_speeds_zero"
    assert found.seen.startswith(f"{name} reads zero from")
    assert "it reads none between 0 and 0.7" in found.cause
    assert "or its encoder was stuck or lost" in found.cause


@pytest.mark.parametrize("sensors", SENSORS)
def test_a_tread_that_reads_no_slow_speed_and_is_lost_at_high_speed_is_lost(sensors):
    run = SENSORS[sensors](slow_for_a_while())
    run = limited(run, "v_left", lambda v: np.where(np.abs(v) < 0.2, 0.0, v))
    found = check_recording(held(run, "v_left", 100, 125, 0.0)).findings[0]
    assert found.name == "stuck_encoder"
    assert "slow speeds" not in found.cause


@pytest.mark.parametrize("sensors", SENSORS)
def test_a_gap_below_all_speeds_of_a_steady_drive_is_no_least_reading(sensors):
    """Where the tread is never slow, its slowest reading says nothing of slower ones."""
    at_s = 0.05 * np.arange(3200)
    run = drive(1 + 0.05 * np.sin(at_s / 7), 0.3 * np.sin(at_s / 2))
    found = check_recording(held(SENSORS[sensors](run), "v_left", 60, 90, 0.0)).findings[0]
    assert found.name == "stuck_encoder"


@pytest.mark.parametrize("sensors", SENSORS)
def test_an_encoder_that_is_lost_amid_many_stops_is_not_slow(sensors):
    at_s = 0.05 * np.arange(3200)
    moves = (at_s % 25 > 20).astype(float)
    run = drive(1.2 * moves * (1 + 0.3 * np.sin(at_s)), 0.4 * np.sin(2 * at_s) * moves)
    found = check_recording(held(SENSORS[sensors](run), "v_left", 60, 140, 0.0)).findings[0]
    assert found.name == "stuck_encoder"


def slower_for_a_while():
    """Speeds of 0.3 m/s for 20 s, and of all sizes elsewhere."""
    at_s = 0.05 * np.arange(3200)
    speed = np.where((at_s > 60) & (at_s < 80), 0.3, 1 + 0.9 * np.sin(at_s / 3))
    return drive(speed, 0.3 * np.sin(at_s / 1.7))


def seldom_slow():
    """Speeds of 0.35 m/s for 20 s, and of 2 m/s elsewhere but for a moment every 20 s."""
    at_s = 0.05 * np.arange(3200)
    dips = 1.6 * np.exp(-(((at_s % 20 - 10) / 0.5) ** 2))
    return drive(np.where((at_s > 60) & (at_s < 80), 0.35, 2 - dips), 0.3 * np.sin(at_s / 1.7))


@pytest.mark.parametrize(
    ("sensors", "driven"),
    list(zip(SENSORS, (slower_for_a_while, seldom_slow, slower_for_a_while), strict=True)),
)
def test_an_encoder_that_is_lost_while_slow_by_chance_may_be_either(driven, sensors):
    """It reads slow speeds elsewhere, or is seldom slow."""
    found = check_recording(held(SENSORS[sensors](driven()), "v_left", 60, 80, 0.0)).findings[0]
    assert found.name == "stuck_encoder"
    assert found.cause.startswith("Either the encoder of the left tread is stuck or was lost; or")
    assert "slow speeds read zero" in found.cause


def never_slow():
    """Speeds between 0.4 and 1.4 m/s, of which the left tread reads none slower."""
    at_s = 0.05 * np.arange(3200)
    return drive(0.9 + 0.5 * np.sin(at_s), 0.1 * np.sin(at_s / 1.7))


def with_zeros(run, slow):
    """Twelve single zeros in v_left, beside its slowest speeds, or beside any."""
    speed = run.odometry["v_left"].copy()
    rows = np.flatnonzero(speed < np.quantile(speed, 0.1)) if slow else np.arange(50, 3150)
    speed[rows[:: len(rows) // 12]] = 0.0
    return put(run, "odometry", v_left=speed)


@pytest.mark.parametrize(
    ("sensors", "slow", "begin"),
    [
        ("gyroscope and poses", True, "Either slow speeds"),
        ("gyroscope", True, "Either slow speeds"),
        ("poses", True, "Either slow speeds"),
        ("gyroscope", False, "Samples drop"),
    ],
)
def test_zeros_beside_the_slowest_speed_that_is_read_may_be_slow(slow, begin, sensors):
    run = with_zeros(SENSORS[sensors](never_slow()), slow)
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "dropped_speeds"
    assert found.cause.startswith(begin)


@pytest.mark.parametrize(("value", "begin"), [(0.45, "Either it is the slowest"), (1.7, "A place")])
def test_a_value_amid_zeros_may_be_the_slowest_that_is_read(value, begin):
    run = held(never_slow(), "v_left", 60, 62, 0.0)
    speed = run.odometry["v_left"].copy()
    speed[1201:1240:4] = value
    (found,) = (
        f
        for f in check_recording(put(run, "odometry", v_left=speed)).findings
        if f.name == "placeholder_speeds"
    )
    assert found.cause.startswith(begin)


def test_an_encoder_whose_tread_may_stand_is_not_surely_lost():
    """Where the other tread alone explains the turns of that time."""
    at_s = 0.05 * np.arange(3200)
    arc, right = (at_s > 60) & (at_s < 75), 1 + 0.5 * np.sin(2 * at_s)
    speed = np.where(arc, 0.675 * right, 0.6 + 0.5 * np.sin(at_s / 3))
    run = drive(speed, np.where(arc, 0.65 / WIDTH_M * right, 0.5 * np.sin(at_s / 1.7)))
    (found,) = check_recording(held(run, "v_left", 60, 75, 0.0)).at(Level.WARNING)
    assert found.name == "stuck_encoder"
    assert "this tread is stationary or slow" in found.cause


@pytest.mark.parametrize("sensors", SENSORS)
def test_an_encoder_that_is_lost_near_the_slowest_speed_that_it_reads_may_be_slow(sensors):
    """At 0.5 m/s, of a tread that reads none below 0.4 m/s anywhere."""
    at_s = 0.05 * np.arange(3200)
    steady = (at_s > 60) & (at_s < 75)
    run = drive(np.where(steady, 0.5, 0.95 + 0.5 * np.sin(at_s)), 0.1 * np.sin(at_s / 1.7))
    (found,) = check_recording(held(SENSORS[sensors](run), "v_left", 60, 75, 0.0)).at(Level.WARNING)
    assert found.name == "stuck_encoder"
    assert "it reads none between 0 and 0.4" in found.cause
