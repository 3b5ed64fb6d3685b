"""Slow speeds that read zero, and an encoder that is lost at any speed."""

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from tests.odometry.checks.test_other_robots import drive
from tests.odometry.checks.test_stuck_encoders import SENSORS, held, limited


def slow_for_a_while():
    """Speeds of 0.6 m/s and less for 20 s, and of up to 1.4 m/s elsewhere."""
    at_s = 0.05 * np.arange(3200)
    speed = np.where((at_s > 60) & (at_s < 80), 0.4, 1.0) * (1 + 0.4 * np.sin(at_s / 3))
    return drive(speed, 0.9 * speed * np.sin(at_s / 1.7))


@pytest.mark.parametrize("sensors", SENSORS)
@pytest.mark.parametrize("name", ["v_left", "v_right"])
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


@pytest.mark.parametrize("sensors", SENSORS)
@pytest.mark.parametrize("driven", [slower_for_a_while, seldom_slow])
def test_an_encoder_that_is_lost_while_slow_by_chance_may_be_either(driven, sensors):
    """It reads slow speeds elsewhere, or is seldom slow."""
    found = check_recording(held(SENSORS[sensors](driven()), "v_left", 60, 80, 0.0)).findings[0]
    assert found.name == "stuck_encoder"
    assert found.cause.startswith("Either the encoder of the left tread is stuck or was lost; or")
    assert "slow speeds read zero" in found.cause
