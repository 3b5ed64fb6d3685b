"""Identifying the models of a parameter set anew, with their effects held."""

import math
from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.tables import effects_of
from odometry.errors import ParameterError
from odometry.identification.fitters import model_on_terrain
from odometry.identification.identify import identify
from odometry.identification.start import SolverConfig
from odometry.models.catalogue import MODELS
from odometry.parameters import (
    ParameterSet,
    TerrainParameters,
    read_parameters,
    write_parameters,
)
from odometry.recording.run import Robot, Run
from odometry.windows.config import WindowConfig

ONE_START = SolverConfig(starts=1)
OLD = {"y_left": 0.6, "y_right": -0.6, "x_icr": 0.0}


def effect(name, form, **parameters):
    return {"name": name, "form": form, "parameters": parameters}


SCALE = effect("wheel_scale", "factors", c_l=0.8, c_r=1.1)
ARM = effect("lever_arm", "constant", x_arm=0.4, y_arm=-0.2)
LATE = effect("time_offset", "constant", offset=0.3)


def set_of(*effects, model="icr", values=None, ground="gravel"):
    table = TerrainParameters(model, values or OLD, effects=tuple(effects))
    return ParameterSet({ground: table})


def identified(run, wanted, **more):
    return identify([run], wanted, solver_config=ONE_START, **more)


def test_effects_on_commands_are_held(winding, synthetic, tmp_path):
    """Slip factors are what is left of the true ones; the set that comes out has the effect."""
    found = identified(winding, set_of(SCALE))
    write_parameters(tmp_path / "set.toml", found.to_parameter_set())
    table = read_parameters(tmp_path / "set.toml").terrains["gravel"]
    assert table.model == "icr"
    assert table.effects == (SCALE,)
    expected = synthetic.icrs | {
        "alpha_left": synthetic.icrs["alpha_left"] / 0.8,
        "alpha_right": synthetic.icrs["alpha_right"] / 1.1,
    }
    assert table.values == pytest.approx(expected, abs=1e-4)
    assert table.covariance_order == tuple(synthetic.icrs)
    assert found.terrains["gravel"].held_out.translation_per_m.mean() < 1e-4


def test_effects_on_the_measurement_are_undone(winding, synthetic):
    """A sensor off-centre whose stamps are late: the ICRs are those of the robot."""
    x, y, yaw = winding.pose.stack("x", "y", "yaw").T
    columns = {
        "t": winding.pose.stamps_s + 0.3,
        "x": x + 0.4 * np.cos(yaw) + 0.2 * np.sin(yaw),
        "y": y + 0.4 * np.sin(yaw) - 0.2 * np.cos(yaw),
        "yaw": yaw,
    }
    seen = replace(winding, pose=replace(winding.pose, columns=columns))
    found = identified(seen, set_of(ARM, LATE)).to_parameter_set().terrains["gravel"]
    assert found.values == pytest.approx(synthetic.icrs, abs=1e-4)
    assert found.effects == (ARM, LATE)
    without = identified(seen, "icr").terrains["gravel"].fit.values
    assert abs(without["x_icr"] - synthetic.icrs["x_icr"]) > 0.2


def test_lagging_treads_between_uneven_stamps(synthetic, tmp_path):
    """Poses lie between the stamps of odometry; the robot drives means of the lagged speeds."""
    odometry = synthetic.commands(np.random.default_rng(3), 900)
    step_s, lag = odometry[1, 0] - odometry[0, 0], 0.25
    share, driven, reached = 1 - math.exp(-step_s / lag), odometry.copy(), odometry[0, 1:]
    for row in driven:
        command = row[1:].copy()
        row[1:] = command + (reached - command) * lag / step_s * share
        reached = reached + share * (command - reached)
    stamps_s = np.arange(0.0, odometry[-1, 0], 3 * step_s)
    folder = synthetic.write(tmp_path / "r", driven, stamps_s, synthetic.icr_twist(synthetic.icrs))
    run = Run.read(folder)
    columns = dict(run.odometry.columns)
    columns |= {"v_left": odometry[:, 1], "v_right": odometry[:, 2]}
    run = replace(run, odometry=replace(run.odometry, columns=columns))
    follows = effect("actuator_lag", "first_order", lag=lag)
    found = identified(run, set_of(follows, ground="ground")).terrains["ground"].fit.values
    assert found == pytest.approx(synthetic.icrs, abs=1e-3)


def test_a_set_without_effects_is_its_model(winding):
    by_set, by_name = identified(winding, set_of()), identified(winding, "icr")
    assert by_set.terrains["gravel"].fit.model is MODELS["icr"]
    assert by_set.terrains["gravel"].fit.values == by_name.terrains["gravel"].fit.values


def test_what_the_set_knows_of_the_robot_is_held(winding):
    """The width of Baril's law is known: that of the set, of --fix before it, or set free."""
    values = {"alpha": 1.0, "beta_1": 1.0, "beta_2": 1.0, "track_width": 0.55}
    wanted = set_of(model="radius_of_curvature", values=values)
    found = identified(winding, wanted).terrains["gravel"]
    assert found.given == {"track_width": 0.55}
    assert found.fit.values["track_width"] == 0.55
    fixed = identified(winding, wanted, fixed={"track_width": 0.45, "beta_2": 0.5})
    assert fixed.terrains["gravel"].given == {"track_width": 0.45, "beta_2": 0.5}
    freed = identified(winding, wanted, released=("track_width",), fixed={"beta_2": 0.5})
    assert "track_width" in freed.terrains["gravel"].fit.names


def test_each_terrain_has_the_model_of_its_table(synthetic, tmp_path):
    odometry = synthetic.commands(np.random.default_rng(5), 1200)
    names = ["sand"] * 600 + ["ice"] * 600
    folder = synthetic.write(
        tmp_path / "r",
        odometry,
        np.arange(0.0, odometry[-1, 0], 0.4),
        synthetic.icr_twist(synthetic.icrs),
        terrain_column=names,
    )
    tables = {
        "sand": TerrainParameters("icr", OLD, effects=(SCALE,)),
        "ice": TerrainParameters("icr_symmetric", {"alpha": 1.0, "b_hat": 0.8}),
    }
    found = identified(Run.read(folder), ParameterSet(tables), window_config=WindowConfig())
    assert found.terrains["ice"].fit.model is MODELS["icr_symmetric"]
    assert [a.effect.name for a in effects_of(found.terrains["sand"].fit.model)] == ["wheel_scale"]
    written = found.to_parameter_set().terrains
    assert {name: (t.model, t.effects) for name, t in written.items()} == {
        "sand": ("icr", (SCALE,)),
        "ice": ("icr_symmetric", ()),
    }


def test_the_only_table_of_a_set_is_for_every_terrain():
    asked = model_on_terrain("anywhere", set_of(SCALE), Robot(0.5))
    assert effects_of(asked.model)[0].by_name == SCALE["parameters"]
    tables = {"a": TerrainParameters("icr", OLD), "b": TerrainParameters("icr", OLD)}
    with pytest.raises(ParameterError, match="no terrain 'c'; it has a, b"):
        model_on_terrain("c", ParameterSet(tables), Robot(0.5))
