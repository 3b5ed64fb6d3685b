"""Halves with different parameters are noted; those with the same are not."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.identification.fit_pair import BY_CHANCE
from odometry.identification.halves import Halves
from odometry.identification.identify import identify
from odometry.identification.start import SolverConfig
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig


@pytest.fixture(scope="module")
def recorded(synthetic, tmp_path_factory):
    """A run of 80 s with the noise of stated poses."""
    rng = np.random.default_rng(3)
    odometry = synthetic.commands(rng, 800)
    folder = tmp_path_factory.mktemp("halves") / "run"
    twist = synthetic.icr_twist(synthetic.icrs)
    run = Run.read(synthetic.write(folder, odometry, np.arange(0, 79.5, 0.2), twist))
    return synthetic.noisy(run, rng, 0.01, 0.005)


def with_faster_second_half(run, factor):
    """What the encoders say grows by a factor half-way: slip factors shrink by as much."""
    t = run.odometry.stamps_s
    factors = np.where(t < t.mean(), 1.0, factor)
    speeds = {name: run.odometry[name] * factors for name in ("v_left", "v_right")}
    return replace(run, odometry=replace(run.odometry, columns={**run.odometry.columns, **speeds}))


def found_in(runs, model="icr"):
    config = WindowConfig(position_sigma_m=0.01, yaw_sigma_rad=0.005)
    found = identify(runs, model, window_config=config, solver_config=SolverConfig(starts=1))
    (of_terrain,) = found.terrains.values()
    return of_terrain


def test_parameters_that_stay_are_not_noted(recorded):
    halves = found_in([recorded]).halves
    assert halves.names == ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right")
    assert halves.by_chance > 0.001
    assert halves.note() is None


def test_a_change_half_way_is_noted_with_both_values(recorded):
    halves = found_in([with_faster_second_half(recorded, 1.1)]).halves
    assert halves.by_chance < BY_CHANCE
    assert halves.second.values["alpha_left"] == pytest.approx(
        halves.first.values["alpha_left"] / 1.1, rel=0.02
    )
    first, second = halves.first.values["alpha_left"], halves.second.values["alpha_left"]
    assert f"alpha_left {first:.3g} and {second:.3g}" in halves.note()
    assert "--from" in halves.note()


def test_the_error_held_out_by_halves_is_that_of_the_other_half(recorded):
    found = found_in([with_faster_second_half(recorded, 1.1)])
    swapped = Halves(found.halves.second, found.halves.first)
    assert found.held_out_by == "halves"
    assert found.halves.worse == pytest.approx(swapped.worse)
    assert found.held_out.translation_per_m.mean() > 0.03  # a tenth of the way, less the noise


def test_a_difference_that_hardly_moves_the_robot_is_not_noted(recorded):
    """By precise poses everything differs; half a percent is no other terrain."""
    halves = found_in([with_faster_second_half(recorded, 1.001)]).halves
    assert halves.note() is None


def test_only_parameters_that_both_halves_determine_are_compared(recorded):
    halves = found_in([recorded]).halves
    open_in_one = replace(halves.first, at_bound=("x_icr",))
    rest = ("y_left", "y_right", "alpha_left", "alpha_right")
    assert Halves(open_in_one, halves.second).names == rest
    assert Halves(halves.second, open_in_one).names == rest
