"""Runs of a robot whose ICRs are known, made in memory by code of their own, and their gaps."""

from pathlib import Path

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.sensor_mount import LeverArm
from odometry.effects.unknown.residual import Residual
from odometry.gap.answer.result import Closing, Equivalent, GapResult, NamedEffect, Rival
from odometry.gap.config import GapConfig
from odometry.gap.locate.locate import locate
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.statistic import floor_of, gap_of
from odometry.gap.prepare.uncertain_base import Uncertain
from odometry.models.icr import Icr
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from odometry.windows.dense.dense import dense_windows_of
from odometry.windows.dense.dense_noise import Noise

ROBOT = Robot(track_width=0.55, name="R", wheel_radius=0.165)
Y_LEFT, Y_RIGHT, X_ICR = 0.45, -0.42, 0.02
PERIOD_S = 0.05
PART_S = GapConfig().part_s


def drive(seed, effect=None, *, duration_s=160.0, top_m_s=1.0, name="run", terrain=None):
    """A run over gentle hills; `effect(columns, twist)` changes the true twist (N, 3)."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, duration_s, PERIOD_S)
    commands = rng.uniform(-0.3 * top_m_s, top_m_s, (int(duration_s / 4) + 2, 2))
    left, right = (np.interp(t, 4.0 * np.arange(len(commands)), c) for c in commands.T)
    roll = 0.1 * np.sin(2 * np.pi * t / 37.0 + rng.uniform(0, 6))
    pitch = 0.1 * np.sin(2 * np.pi * t / 23.0 + rng.uniform(0, 6))
    columns = {"t": t, "v_left": left, "v_right": right, "roll": roll, "pitch": pitch}
    if terrain is not None:
        columns["terrain"] = terrain(t)
    omega = (right - left) / (Y_LEFT - Y_RIGHT)
    forward = (right * Y_LEFT - left * Y_RIGHT) / (Y_LEFT - Y_RIGHT)
    twist = np.column_stack([forward, -X_ICR * omega, omega])
    if effect is not None:
        twist = effect({**columns, "omega": omega}, twist)
    every = slice(None, None, 4)
    noise = rng.normal(size=(len(t[every]), 3)) * [0.01, 0.01, 0.004]
    x, y, yaw = (integrated(twist)[every] + noise).T
    pose = {"t": t[every], "x": x, "y": y, "yaw": yaw}
    flat = {name: np.zeros_like(t) for name in ("roll", "pitch")} if effect is None else {}
    return Run(Path(name), ROBOT, {}, table({**columns, **flat}), table(pose))


def integrated(twist):
    """Poses before each step along exact arcs; the hills are too gentle to matter."""
    forward, aside, omega = twist[:-1].T
    half = omega * PERIOD_S / 2
    yaw = np.concatenate([[0.0], np.cumsum(2 * half)])
    chord = np.sinc(half / np.pi) * PERIOD_S
    c, s = np.cos(yaw[:-1] + half), np.sin(yaw[:-1] + half)
    steps = chord * np.array([c * forward - s * aside, s * forward + c * aside])
    return np.column_stack([*np.pad(np.cumsum(steps, axis=1), ((0, 0), (1, 0))), yaw])


def table(columns):
    return Table(Path("table.csv"), columns, np.arange(len(columns["t"])) + 2)


def scene(seed, effect=None, **settings):
    return dense_windows_of(drive(seed, effect, **settings), GapConfig().horizon_s)


def scaled(columns, twist):  # noqa: ARG001 - of the face of effects
    """Both wheels move 20 % less than recorded."""
    return 0.8 * twist


@pytest.fixture(scope="session")
def make_scene():
    return scene


@pytest.fixture(scope="session")
def known():
    """A calibration that holds the truth."""
    model = Icr()
    values = {"y_left": Y_LEFT, "y_right": Y_RIGHT, "x_icr": X_ICR}
    base = Base(model, model.pack({**values, "alpha_left": 1.0, "alpha_right": 1.0}), ROBOT)
    noise = Noise(0.01, 0.004, 1e-4, 1e-5)
    kept = tuple((base, scene(seed, duration_s=60.0)) for seed in (900, 901))
    sure = Uncertain(base, np.zeros(5, dtype=bool), latency_is_free=False)
    return Calibration(sure, np.empty((0, 0)), noise, kept)


def result_of(known, effects, equivalent, planted):
    """What a search would return, with effects as they are given."""
    measured = (scene(1, planted, name="meadow <1>"),)
    held = (scene(2, planted, name="$hill^ & dale"),)
    floor = floor_of(known.held_back, PART_S)
    added = tuple(effect.added for effect in effects)
    closings = [
        Closing(
            gap_of(known.base, (), scenes, PART_S), gap_of(known.base, added, scenes, PART_S), floor
        )
        for scenes in (measured, held)
    ]
    return GapResult(
        verdict=effects[0].added.effect.name if effects else "none",
        effects=effects,
        equivalent=equivalent,
        location=locate(known.base, (), measured, floor.value, GapConfig(), calibration=known),
        measured=closings[0],
        holdout=closings[1],
        rivals=(
            Rival("wheel_scale", "factors", 812.0, 0.02),
            Rival("time_offset", "constant", -7.5, 0.21),
        ),
        calibration=known,
        base=known.base,
        measured_scenes=measured,
        holdout_scenes=held,
        horizon_s=2.0,
    )


def named(effect, values, evidence):
    values = np.array(values)
    return NamedEffect(Added(effect, values), values - 0.01, values + 0.02, 0.2, 0.03, evidence)


@pytest.fixture(scope="session")
def scaled_result(known):
    """Wheel scale, which was there, and a lever arm of next to nothing."""
    effects = (named(WheelScale(), [0.8, 0.8], 812.0), named(LeverArm(), [0.001, 0.0], 13.0))
    equivalent = (Equivalent("traction_loss", "wheel_scale", "a free wheel"),)
    return result_of(known, effects, equivalent, scaled)


@pytest.fixture(scope="session")
def none_result(known):
    """Nothing was there, and nothing is named."""
    return result_of(known, (), (), None)


@pytest.fixture(scope="session")
def unknown_result(known):
    """Wheels that slip, of which a function of the heading explains next to nothing."""
    terms = (("v_x", 0), ("v_y", 1))
    effects = (named(Residual("heading", terms), [0.001, 0.0], 20.0),)
    return result_of(known, effects, (), scaled)
