"""The stated model of vibration: size with speed, band by terrain, gravity and yaw rate."""

import numpy as np
import pytest

from odometry.simulation.drive import Drive
from terrain.synthesis.records import BAND, GRAVITY_M_S2, RATE_HZ, imu_table, vibration_bands

TERRAINS = ("brick", "grass", "gravel")


def driven(speed_m_s, terrain, seconds=60.0, yaw_rate_rad_s=0.2):
    stamps_s = np.arange(0.0, seconds, 0.05)
    count = len(stamps_s)
    twists = np.tile([speed_m_s, 0.0, yaw_rate_rad_s], (count, 1))
    treads = np.full((count, 2), speed_m_s)
    nothing = np.zeros((count, 3))
    return Drive(stamps_s, nothing, treads, twists, nothing, (terrain,) * count)


def shaken(speed_m_s, terrain, seed=0):
    return imu_table(driven(speed_m_s, terrain), TERRAINS, np.random.default_rng(seed))


def test_gravity_and_yaw_rate_are_there():
    table = shaken(0.5, "grass")
    assert np.diff(table["t"]) == pytest.approx(1 / RATE_HZ)
    assert table["accel_z"].mean() == pytest.approx(GRAVITY_M_S2, abs=0.05)
    assert table["gyro_z"].mean() == pytest.approx(0.2, abs=0.01)
    assert table["accel_y"].mean() == pytest.approx(0.1, abs=0.05)


def test_it_grows_with_speed_and_a_robot_that_stands_has_noise_alone():
    sizes = [shaken(speed, "gravel")["accel_x"].std() for speed in (0.0, 0.5, 1.0)]
    assert sizes[0] == pytest.approx(0.05, rel=0.1)
    assert sizes[2] == pytest.approx(2 * sizes[1], rel=0.05)


@pytest.mark.parametrize("terrain", TERRAINS)
def test_its_power_lies_in_the_terrain_s_band(terrain):
    centre_hz, _ = vibration_bands(TERRAINS)[terrain]
    signal = shaken(1.0, terrain)["accel_x"]
    power = np.abs(np.fft.rfft(signal - signal.mean())) ** 2
    hz = np.fft.rfftfreq(len(signal), 1 / RATE_HZ)
    spread = 1.4  # from run to run, and slopes of the filter
    inside = (hz > centre_hz / BAND / spread) & (hz < centre_hz * BAND * spread)
    assert power[inside].sum() > 0.8 * power.sum()


def test_runs_differ_and_a_seed_makes_the_same_again():
    first, same, other = shaken(1.0, "brick"), shaken(1.0, "brick"), shaken(1.0, "brick", 1)
    np.testing.assert_array_equal(first["accel_x"], same["accel_x"])
    assert abs(np.log(first["accel_x"].std() / other["accel_x"].std())) > 0.01


def test_terrains_without_a_band_of_their_own_are_spread():
    bands = vibration_bands(("mud", "grass", "tar", "sand"))
    centres = [bands[name][0] for name in ("mud", "tar", "sand")]
    assert np.diff(centres).min() > 1.0
