"""Identification of `icr` on one hour of 20 Hz data, against a loop over samples.

Both do the same work: the same windows, the same searches and reweightings by the same solver,
the same exact arcs and analytic gradients, each point computed once. Only the residuals and their
derivative are found sample by sample in plain Python in the one, and with arrays in the other.
"""

import math
import time
from dataclasses import dataclass

import numpy as np
import pytest

from odometry.dead_reckoning import dead_reckon
from odometry.identification.problem import Problem
from odometry.identification.solve import solve
from odometry.identification.start import SolverConfig
from odometry.io.run_folder import write_run_folder
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.noise import pose_variances
from odometry.windows.travel.windows import windows_of

HOUR_S, RATE_HZ = 3600.0, 20.0
TRUE = {"y_left": 0.45, "y_right": -0.38, "x_icr": 0.04, "alpha_left": 0.96, "alpha_right": 0.93}


@dataclass(frozen=True)
class LoopProblem(Problem):
    """The same loss, sample by sample."""

    def _linearised(self, chosen):
        speeds = self.windows.inputs.tread_speeds_m_s.tolist()
        steps_s = self.windows.steps_s.tolist()
        errors, slopes = [], []
        for first, last, measured in zip(
            self.windows.first, self.windows.last, self.windows.measured, strict=True
        ):
            end, slope = walk(chosen.tolist(), speeds[first:last], steps_s[first:last])
            turn = math.remainder(end[2] - measured[2], 2 * math.pi)
            errors.append([end[0] - measured[0], end[1] - measured[1], turn])
            slopes.append(slope)
        return np.array(errors), np.array(slopes)


def walk(values, speeds, steps_s):
    """End of one window (3,), and its derivative (3, 5), by exact arcs."""
    y_left, y_right, x_icr, alpha_left, alpha_right = values
    width = y_left - y_right
    x = y = yaw = 0.0
    x_by, y_by, yaw_by = [0.0] * 5, [0.0] * 5, [0.0] * 5
    for (left, right), step_s in zip(speeds, steps_s, strict=True):
        fast_left, fast_right = alpha_left * left, alpha_right * right
        omega = (fast_right - fast_left) / width
        v_x = (fast_right * y_left - fast_left * y_right) / width
        v_y = -x_icr * omega
        rate = omega / width
        omega_by = (-rate, rate, 0.0, -left / width, right / width)
        v_x_by = (
            -y_right * rate, y_left * rate, 0.0, -y_right * left / width, y_left * right / width
        )  # fmt: skip
        v_y_by = (
            x_icr * rate, -x_icr * rate, -omega, x_icr * left / width, -x_icr * right / width
        )  # fmt: skip
        angle = omega * step_s
        if abs(angle) < 1e-4:
            s, c = 1 - angle * angle / 6, angle / 2
            s_by, c_by = -angle / 3, 0.5 - angle * angle / 8
        else:
            s, c = math.sin(angle) / angle, (1 - math.cos(angle)) / angle
            s_by, c_by = (math.cos(angle) - s) / angle, (math.sin(angle) - c) / angle
        along, across = (s * v_x - c * v_y) * step_s, (c * v_x + s * v_y) * step_s
        cosine, sine = math.cos(yaw), math.sin(yaw)
        dx, dy = cosine * along - sine * across, sine * along + cosine * across
        along_angle = (s_by * v_x - c_by * v_y) * step_s
        across_angle = (c_by * v_x + s_by * v_y) * step_s
        for p in range(5):
            turn = omega_by[p] * step_s
            a = (s * v_x_by[p] - c * v_y_by[p]) * step_s + along_angle * turn
            b = (c * v_x_by[p] + s * v_y_by[p]) * step_s + across_angle * turn
            x_by[p] += cosine * a - sine * b - dy * yaw_by[p]
            y_by[p] += sine * a + cosine * b + dx * yaw_by[p]
            yaw_by[p] += turn
        x, y, yaw = x + dx, y + dy, yaw + angle
    return (x, y, yaw), (x_by, y_by, yaw_by)


@pytest.fixture(scope="module")
def hour(tmp_path_factory):
    """An hour of random commands under the true parameters, poses at 10 Hz."""
    rng = np.random.default_rng(0)
    stamps_s = np.arange(round(HOUR_S * RATE_HZ)) / RATE_HZ
    knots_s = np.arange(0.0, HOUR_S + 4, 2.0)
    speeds = np.column_stack(
        [np.interp(stamps_s, knots_s, rng.uniform(-1, 1, len(knots_s))) for _ in range(2)]
    )
    model = MODELS["icr"]
    path = dead_reckon(stamps_s, model.twist(model.pack(TRUE), Inputs(speeds)), np.zeros(3))
    poses = path.poses[::2] + rng.standard_normal((len(stamps_s[::2]), 3)) * [0.01, 0.01, 0.005]
    folder = tmp_path_factory.mktemp("hour") / "run"
    odometry = {"t": stamps_s, "v_left": speeds[:, 0], "v_right": speeds[:, 1]}
    pose = dict(zip(("x", "y", "yaw"), poses.T, strict=True))
    tables = {"odometry": odometry, "pose": {"t": stamps_s[::2]} | pose}
    write_run_folder(folder, {"robot": {"track_width": 0.5}}, tables)
    return windows_of([Run.read(folder)], WindowConfig()), Run.read(folder).robot


@pytest.mark.benchmark(group="one hour of 20 Hz data")
def test_identification_against_a_loop(benchmark, hour):
    windows, robot = hour
    model = MODELS["icr"]
    guess = model.pack(model.guess(robot))
    settings = (model, windows, guess, np.ones(5, dtype=bool), pose_variances(WindowConfig()))
    sizes, config = model.ordinary_sizes(robot), SolverConfig(starts=1)
    ours = benchmark.pedantic(
        solve, (Problem(*settings), guess, sizes, config), rounds=3, warmup_rounds=1
    )
    started = time.perf_counter()
    theirs = solve(LoopProblem(*settings), guess, sizes, config)
    loop_s = time.perf_counter() - started
    np.testing.assert_allclose(ours.chosen, theirs.chosen, rtol=1e-7)
    benchmark.extra_info["loop_s"] = loop_s
    benchmark.extra_info["figure"] = loop_s / benchmark.stats.stats.median
