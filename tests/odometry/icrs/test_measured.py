"""ICRs of recordings: synthetic drives by a plain loop, and a real robot."""

import numpy as np
import pytest

from odometry.icrs.measured import HALF_TURN_RAD, icr_medians, measured_icrs
from odometry.identification.identify import identify
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from tests.odometry.window_drives import ICRS, commands, icr_twist, write

TRUE_ICRS = np.array([ICRS["y_left"], ICRS["y_right"], ICRS["x_icr"]])
ALPHAS = (ICRS["alpha_left"], ICRS["alpha_right"])
CONFIG = WindowConfig(horizon_s=1.0, position_sigma_m=0.005, yaw_sigma_rad=0.002)


def drive(folder, odometry, **options):
    """A run with poses at 10 Hz."""
    pose_s = np.arange(0.0, odometry[-1, 0], 0.1)
    return Run.read(write(folder, odometry, pose_s, icr_twist(ICRS), **options))


def held(*speeds):
    """Rows of odometry: each pair of speeds for 5 s."""
    speeds = np.repeat(np.array(speeds), 50, axis=0)
    return np.column_stack([np.arange(len(speeds)) / 10, speeds])


def noisy(run, seed):
    rng = np.random.default_rng(seed)
    for name, sigma in (("x", 0.005), ("y", 0.005), ("yaw", 0.002)):
        column = run.pose.columns[name]
        column += sigma * rng.normal(size=len(column))
    return run


def test_icrs_are_exact_where_speeds_hold(tmp_path):
    run = drive(tmp_path / "run", held((-0.4, 0.5), (0.2, 1.0), (0.9, 0.1)))
    measured = measured_icrs([run], CONFIG, alphas=ALPHAS)
    assert len(measured) >= 13
    steady = np.abs(measured.start_s % 5 - 2) < 1.9
    np.testing.assert_allclose(
        measured.icrs[steady], np.tile(TRUE_ICRS, (steady.sum(), 1)), atol=1e-9
    )
    np.testing.assert_allclose(measured.duration_s, 1.0)
    assert set(measured.side[measured.start_s < 9]) == {"left"}
    assert set(measured.side[measured.start_s > 10]) == {"right"}
    first = measured.twists[0]
    assert measured.turn_radius_m[0] == pytest.approx(first[0] / first[2])


def test_straights_and_large_turns_are_left_out(tmp_path):
    equal = 0.8 * np.array([1 / ALPHAS[0], 1 / ALPHAS[1]])
    run = drive(tmp_path / "run", held(equal, (-2.2, 2.2), (-0.4, 0.4)))
    measured = measured_icrs([run], CONFIG, alphas=ALPHAS)
    assert (np.abs(measured.twists[:, 2] * measured.duration_s) < HALF_TURN_RAD).all()
    assert (measured.start_s > 9).all()
    assert len(measured) > 3


def test_medians_of_random_commands_are_true_and_slip_parts_the_sides(tmp_path):
    run = drive(tmp_path / "run", commands(np.random.default_rng(1), 6000, held=40))
    left, right = icr_medians(measured_icrs([run], CONFIG, alphas=ALPHAS))
    for median in (left, right):
        np.testing.assert_allclose(median.icrs, TRUE_ICRS, atol=5e-3)
    left, right = icr_medians(measured_icrs([run], CONFIG))
    assert left.icrs[1] < TRUE_ICRS[1] - 0.01  # a tread that slips seems to lie farther out
    assert right.icrs[0] > TRUE_ICRS[0] + 0.003


@pytest.mark.parametrize("speeds", [(0.1, 0.7), (-0.9, 1.1)], ids=["curves", "spins"])
def test_standard_deviations_are_those_of_noise(tmp_path, speeds):
    """Poses with noise, steady speeds: 95 % of the errors lie within 1.96 standard deviations."""
    run = noisy(drive(tmp_path / "run", held(*[speeds, speeds[::-1]] * 30)), seed=2)
    measured = measured_icrs([run], CONFIG, alphas=ALPHAS)
    steady = np.abs(measured.start_s % 5 - 2) < 1.9
    off = (measured.icrs - TRUE_ICRS)[steady, 2] / measured.sigmas_m[steady, 2]
    assert len(off) == 180
    assert np.std(off) == pytest.approx(1, abs=0.12)
    assert np.mean(np.abs(off) < 1.96) == pytest.approx(0.95, abs=0.03)


def test_a_husky_on_tile(shared_data):
    """Medians agree with the fit: x_icr -0.146 m, within the 95 % intervals of both together."""
    run = Run.read(shared_data / "motion" / "husky_tile_20231212_1616_s00")
    fit = identify([run], "icr").terrains["ground"].fit
    sigmas = np.array([fit.sigmas[name] for name in ("y_left", "y_right", "x_icr")])
    medians = icr_medians(measured_icrs([run], alphas=fit.packed[3:]))
    assert [median.side for median in medians] == ["left", "right"]
    for median in medians:
        half_m = np.hypot((median.high - median.low) / 2, 1.96 * sigmas)
        assert (np.abs(median.icrs - fit.packed[:3]) < half_m).all()
        assert median.icrs[2] == pytest.approx(-0.146, abs=0.005)
