"""Runs of two robots or terrains under one name are told apart; those of one are not."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.identification.identify import identify
from odometry.identification.start import SolverConfig
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig

CONFIG = WindowConfig(position_sigma_m=0.01, yaw_sigma_rad=0.005)
WIDER = {"y_left": 0.6, "y_right": -0.55, "x_icr": 0.05, "alpha_left": 0.85, "alpha_right": 0.83}


@pytest.fixture(scope="module")
def drive(synthetic, tmp_path_factory):
    """Drive a run of 60 s whose poses have the stated noise."""
    folder = tmp_path_factory.mktemp("apart")

    def driven(name, seed, icrs=synthetic.icrs):
        rng = np.random.default_rng(seed)
        odometry = synthetic.commands(rng, 600)
        twist = synthetic.icr_twist(icrs)
        run = Run.read(synthetic.write(folder / name, odometry, np.arange(0, 59.5, 0.2), twist))
        return synthetic.noisy(run, rng, 0.01, 0.005)

    return driven


def found_in(*runs):
    found = identify(runs, "icr", window_config=CONFIG, solver_config=SolverConfig(starts=1))
    (of_terrain,) = found.terrains.values()
    return of_terrain


def test_runs_of_one_robot_agree(drive):
    found = found_in(*(drive(f"run_{seed}", seed) for seed in (1, 2, 3)))
    assert found.apart is None
    assert found.mixed == ""


def test_one_run_is_not_compared(drive):
    assert found_in(drive("run_1", 1)).apart is None


def test_two_that_differ_are_named_with_their_values(drive):
    found = found_in(drive("run_1", 1), drive("wide", 4, WIDER))
    assert found.apart.groups == (("run_1",), ("wide",))
    assert found.apart.farthest.worse > 5
    left = [found.apart.farthest.first.values["y_left"], WIDER["y_left"]]
    assert f"y_left {left[0]:.3g} and" in found.mixed
    assert "run_1 against wide" in found.mixed
    assert "[run] terrain" in found.mixed
    assert "batch" in found.mixed


def test_the_run_that_is_alone_is_named(drive):
    runs = (drive("run_1", 1), drive("wide", 4, WIDER), drive("run_2", 2))
    assert set(map(frozenset, found_in(*runs).apart.groups)) == {
        frozenset({"wide"}),
        frozenset({"run_1", "run_2"}),
    }


def test_two_groups_are_named(drive):
    runs = [drive(f"run_{seed}", seed) for seed in (1, 2)]
    runs += [drive(f"wide_{seed}", seed, WIDER) for seed in (4, 5)]
    assert set(map(frozenset, found_in(*runs).apart.groups)) == {
        frozenset({"run_1", "run_2"}),
        frozenset({"wide_4", "wide_5"}),
    }


def test_three_kinds_are_three_groups(drive, synthetic):
    slow = synthetic.icrs | {"alpha_left": 0.5, "alpha_right": 0.5}
    runs = (drive("run_1", 1), drive("wide", 4, WIDER), drive("slow", 6, slow))
    assert set(found_in(*runs).apart.groups) == {("run_1",), ("wide",), ("slow",)}


def test_a_run_that_determines_nothing_alone_is_in_no_group(drive):
    """Two seconds: too few windows for five parameters."""
    short = drive("short", 7)
    odometry = short.odometry.rows(np.flatnonzero(short.odometry.stamps_s < 2.0))
    found = found_in(drive("run_1", 1), drive("wide", 4, WIDER), replace(short, odometry=odometry))
    assert found.apart.groups == (("run_1",), ("wide",))
