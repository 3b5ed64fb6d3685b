"""Parameter sets with effects beside sets that say the same without, on runs of known truth."""

import math
from dataclasses import replace

import numpy as np
import pytest

from odometry.comparison.compare import compare
from odometry.parameters import ParameterSet, TerrainParameters, write_parameters
from odometry.recording.run import Run

ARM = (0.4, -0.25)


def effect(name, form, **parameters):
    return {"name": name, "form": form, "parameters": parameters}


LEVER_ARM = effect("lever_arm", "constant", x_arm=ARM[0], y_arm=ARM[1])
LATE = effect("time_offset", "constant", offset=0.2)


def sets(folder, terrain="grass", **tables):
    """Files of one table each: values, and effects."""
    files = []
    for name, (values, *effects) in tables.items():
        table = TerrainParameters("icr", values, effects=tuple(effects))
        write_parameters(folder / f"{name}.toml", ParameterSet({terrain: table}))
        files.append(str(folder / f"{name}.toml"))
    return files


def changed(run, table, **columns):
    """The run with some columns of one of its tables replaced."""
    old = getattr(run, table)
    return replace(run, **{table: replace(old, columns={**old.columns, **columns})})


def of_model(comparison, model):
    """Translation and rotation errors per metre over all evaluated windows."""
    errors = [evaluation.errors[model] for evaluation in comparison.evaluations]
    return np.concatenate([[e.translation_per_m, e.rotation_per_m] for e in errors], axis=1)


def fitness_of(comparison, model):
    return np.array([f.fitness.mean for f in comparison.fitness if f.model == model])


@pytest.fixture
def skewed(bench, tmp_path):
    """Two runs of a robot with skewed ICRs."""
    return [
        Run.read(
            bench.write(
                tmp_path / f"run_{seed}",
                bench.varied(np.random.default_rng(seed), 40.0),
                seed=seed,
                icrs=bench.skewed,
            )
        )
        for seed in range(2)
    ]


def test_on_commands_wheel_scale_is_another_slip_factor(skewed, bench, quick, tmp_path):
    values = bench.skewed | {"alpha_left": 0.5, "alpha_right": 1.0}
    scale = effect("wheel_scale", "factors", c_l=1.9, c_r=0.9)
    files = sets(tmp_path, scaled=(values, scale), plain=(bench.skewed,), without=(values,))
    comparison = compare(skewed, files, config=quick)
    np.testing.assert_allclose(
        of_model(comparison, "scaled"), of_model(comparison, "plain"), atol=1e-9
    )
    np.testing.assert_allclose(
        fitness_of(comparison, "scaled"), fitness_of(comparison, "plain"), rtol=1e-6
    )
    assert of_model(comparison, "without")[0].mean() > 0.2
    assert "scaled" in comparison.split_models[0].predictors
    assert comparison.split_models[0].predictors["scaled"].to_parameters().effects == (scale,)


def test_a_lever_arm_is_evaluated_as_the_icrs_that_look_like_it(skewed, bench, quick, tmp_path):
    """FACTS: x_icr less x_arm, both lateral ICRs less y_arm, turns of more than pi included."""
    runs = []
    for run in skewed:
        x, y, yaw = (run.pose[name] for name in ("x", "y", "yaw"))
        seen_x = x + np.cos(yaw) * ARM[0] - np.sin(yaw) * ARM[1]
        seen_y = y + np.sin(yaw) * ARM[0] + np.cos(yaw) * ARM[1]
        runs.append(changed(run, "pose", x=seen_x, y=seen_y))
    shifted = bench.skewed | {
        "y_left": bench.skewed["y_left"] - ARM[1],
        "y_right": bench.skewed["y_right"] - ARM[1],
        "x_icr": bench.skewed["x_icr"] - ARM[0],
    }
    files = sets(tmp_path, arm=(bench.skewed, LEVER_ARM), shifted=(shifted,))
    comparison = compare(runs, files, config=quick)
    turned = [np.abs(j.windows.measured[:, 2]).max() for j in comparison.evaluations]
    assert max(turned) > math.pi
    np.testing.assert_allclose(
        of_model(comparison, "arm"), of_model(comparison, "shifted"), atol=1e-9
    )
    assert of_model(comparison, "arm")[0].mean() < 0.03
    plain = compare(skewed, sets(tmp_path, plain=(bench.skewed,)), config=quick)
    np.testing.assert_allclose(fitness_of(comparison, "arm"), fitness_of(plain, "plain"), rtol=1e-9)


def test_late_stamps_are_undone(skewed, bench, quick, tmp_path):
    """Poses stamped 0.2 s late: as good as those stamped in time, and paired with other models."""
    late = [changed(run, "pose", t=run.pose["t"] + 0.2) for run in skewed]
    files = sets(tmp_path, late=(bench.skewed, LATE), plain=(bench.skewed,))
    comparison = compare(late, files, config=quick)
    in_time = of_model(compare(skewed, files[1:], config=quick), "plain").mean(axis=1)
    found, without = (of_model(comparison, name).mean(axis=1) for name in ("late", "plain"))
    np.testing.assert_allclose(found, in_time, rtol=0.15)
    assert (without > 3 * found).all()
    assert comparison.differences


def test_the_moment_of_a_loss_is_run_time_in_both_halves(bench, quick, tmp_path):
    """One run, evaluated half by half; traction is lost in the second one."""
    driven = bench.varied(np.random.default_rng(6), 60.0)
    lost = bench.step_s * np.arange(len(driven)) >= 45.0
    run = Run.read(bench.write(tmp_path / "r", driven))
    recorded = np.where(lost[:, None], driven / 0.6, driven)
    run = changed(run, "odometry", v_left=recorded[:, 0], v_right=recorded[:, 1])
    loss = effect("traction_loss", "k_m", k=0.6, m=0.6, moment=45.0)
    files = sets(tmp_path, loss=(bench.symmetric, loss), plain=(bench.symmetric,))
    comparison = compare([run], files, config=quick)
    assert len(comparison.split_models) == 2
    assert of_model(comparison, "loss")[0].max() < 0.1
    assert of_model(comparison, "plain")[0].max() > 0.35
    loss_j, plain_j = (fitness_of(comparison, name).item() for name in ("loss", "plain"))
    assert loss_j < 0.05 * plain_j


def test_lagging_treads_are_followed_over_the_whole_run(bench, quick, tmp_path):
    """The robot drives the means of a first-order response, stepped from sample to sample."""
    recorded = bench.varied(np.random.default_rng(7), 60.0)
    lag, share = 0.3, 1 - math.exp(-bench.step_s / 0.3)
    driven, reached = [], recorded[0]
    for command in recorded:
        driven.append(command + (reached - command) * lag / bench.step_s * share)
        reached = reached + share * (command - reached)
    run = Run.read(bench.write(tmp_path / "r", np.array(driven)))
    run = changed(run, "odometry", v_left=recorded[:, 0], v_right=recorded[:, 1])
    follows = effect("actuator_lag", "first_order", lag=lag)
    files = sets(tmp_path, follows=(bench.symmetric, follows), plain=(bench.symmetric,))
    comparison = compare([run], files, config=quick)
    assert of_model(comparison, "follows")[0].max() < 0.1
    assert of_model(comparison, "plain")[0].max() > 0.2


def test_sensors_that_differ_by_terrain_have_no_fitness(bench, quick, tmp_path):
    speeds = bench.varied(np.random.default_rng(4), 20.0)
    names = ["grass"] * 200 + ["ice"] * 200
    run = Run.read(bench.write(tmp_path / "r", speeds, terrain_column=names))
    tables = {
        "grass": TerrainParameters("icr", bench.symmetric, effects=(LEVER_ARM,)),
        "ice": TerrainParameters("icr", bench.symmetric),
    }
    write_parameters(tmp_path / "set.toml", ParameterSet(tables))
    comparison = compare([run], [str(tmp_path / "set.toml"), "icr_symmetric"], config=quick)
    assert {f.model for f in comparison.fitness} == {"icr_symmetric"}
    assert all("set" in evaluation.errors for evaluation in comparison.evaluations)
