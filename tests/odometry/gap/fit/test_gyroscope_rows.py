"""What a gyroscope adds: it distinguishes late commands from late stamps; its bias is no gap."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.commands.late_treads import CommandDelay
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitter
from odometry.gap.prepare.calibration import calibrated
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.scenes import alike
from odometry.gap.prepare.simulate import all_residuals
from odometry.models.icr import Icr
from odometry.windows.dense.averaged import averaged_windows
from odometry.windows.dense.dense import dense_windows_of

CONFIG = GapConfig()
BIAS_RAD_S, DELAY_STEPS, PERIOD_S = 0.013, 3, 0.05


@pytest.fixture(scope="module")
def recorded(make_scene):
    """Windows of a run whose gyroscope feels the true motion, with a bias and noise."""

    def make(seed, *, late_commands=False, late_stamps=False, bias_rad_s=BIAS_RAD_S):
        felt = {}

        def driven(_, twist):
            delayed = np.roll(twist, DELAY_STEPS, axis=0) if late_commands else twist
            felt["omega"] = delayed[:, 2]
            return delayed

        run = make_scene(seed, driven, duration_s=100.0).run
        noise = np.random.default_rng(seed).normal(0.0, 0.003, len(run.odometry))
        flat = {name: np.zeros(len(run.odometry)) for name in ("roll", "pitch")}
        gyro = {"gyro_z": felt["omega"] + bias_rad_s + noise}
        columns = {**run.odometry.columns, **flat, **gyro}
        late_s = DELAY_STEPS * PERIOD_S * late_stamps
        pose = replace(run.pose, columns={**run.pose.columns, "t": run.pose["t"] + late_s})
        odometry = replace(run.odometry, columns=columns)
        run = replace(run, odometry=odometry, pose=pose)
        return averaged_windows(dense_windows_of(run, CONFIG.horizon_s))

    return make


@pytest.fixture(scope="module")
def with_gyroscope(recorded):
    scenes = [recorded(seed) for seed in (700, 701)]
    return calibrated(scenes, Icr(), scenes[0].run.robot, CONFIG)


def test_the_noise_is_found(with_gyroscope):
    assert with_gyroscope.base.gyro_latency_s == pytest.approx(0.0, abs=0.04)
    own_rad = with_gyroscope.noise.gyro_rad * np.sqrt(with_gyroscope.gyro_expected)
    assert own_rad == pytest.approx(0.003 * np.sqrt(PERIOD_S), rel=0.5)
    assert with_gyroscope.noise.gyro_rad >= with_gyroscope.noise.yaw_rad


def test_chi_squared_is_that_of_noise_with_the_gyroscope(with_gyroscope, recorded):
    scene = recorded(702)
    measured = measured_of([scene], with_gyroscope, CONFIG)
    rows = measured.rows(with_gyroscope.base, ())
    assert len(rows) == 4 * len(scene) * (scene.windows.shape[1] - 1)
    assert np.sum(rows**2) == pytest.approx(measured.expected, rel=0.12)


@pytest.mark.parametrize("late", ["late_commands", "late_stamps"])
def test_late_commands_are_distinguished_from_late_stamps(with_gyroscope, recorded, late):
    scene = recorded(703, **{late: True})
    fitter = Fitter(with_gyroscope, measured_of([scene], with_gyroscope, CONFIG))
    commands, stamps = (fitter.fit([effect]) for effect in (CommandDelay(), TimeOffset()))
    right, wrong = (commands, stamps) if late == "late_commands" else (stamps, commands)
    assert wrong.cost - right.cost > 100.0
    assert right.effects[0].values[0] == pytest.approx(DELAY_STEPS * PERIOD_S, abs=0.02)


def test_another_bias_in_each_run_is_no_gap(with_gyroscope, recorded):
    scenes = [recorded(704, bias_rad_s=BIAS_RAD_S - 0.02), recorded(707)]
    fitter = Fitter(with_gyroscope, measured_of(scenes, with_gyroscope, CONFIG))
    start = fitter.fit([])
    assert fitter.spread(start) == pytest.approx(1.0, abs=0.15)
    assert start.base_alone < 12.0


def test_where_one_run_has_none_no_run_has(recorded):
    scene = recorded(705)
    (without,), (other,) = alike([scene], [scene.without_gyroscope()])
    assert without.reported_turns is None
    assert other.rows_per_window == 3 * (scene.windows.shape[1] - 1)
    ((kept,),) = alike([scene])
    assert kept.reported_turns is not None


def test_turns_are_those_of_the_robot(with_gyroscope, recorded):
    scene = recorded(706)
    count = scene.windows.shape[1] - 1
    turned = all_residuals(with_gyroscope.base, (), scene)[:, 3 * count :]
    assert np.abs(turned).max() < 0.01
