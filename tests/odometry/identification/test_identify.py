import re
from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import IdentificationError, ParameterError
from odometry.identification.fit import fit
from odometry.identification.identify import identify, robot_of
from odometry.identification.start import SolverConfig
from odometry.models.catalogue import MODELS
from odometry.models.icr import Icr
from odometry.parameters import read_parameters, write_parameters
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.windows import windows_of
from odometry.windows.window_errors import window_errors

ONE_START = SolverConfig(starts=1)
ICE = {"y_left": 0.7, "y_right": -0.6, "x_icr": -0.05, "alpha_left": 0.8, "alpha_right": 0.9}


@pytest.fixture(scope="module")
def gravel(winding):
    return winding


@pytest.fixture(scope="module")
def make(synthetic, tmp_path_factory):
    """A run of forty seconds without noise."""

    def make_run(name, truth=ICE, seed=0, **settings):
        odometry = synthetic.commands(np.random.default_rng(seed), 400)
        folder = tmp_path_factory.mktemp("made") / name
        pose_s, twist_of = np.arange(0, 39.5, 0.4), synthetic.icr_twist(truth)
        return Run.read(synthetic.write(folder, odometry, pose_s, twist_of, **settings))

    return make_run


@pytest.fixture(scope="module")
def ice(make):
    return make("ice_run", terrain="ice")


@pytest.fixture(scope="module")
def noisy_runs(gravel, ice, synthetic):
    return [synthetic.noisy(run, np.random.default_rng(1)) for run in (gravel, ice)]


def test_each_terrain_has_its_own_fit(gravel, ice, synthetic):
    found = identify([gravel, ice], "icr", solver_config=ONE_START)
    assert list(found.terrains) == ["gravel", "ice"]
    assert found.terrains["gravel"].fit.values == pytest.approx(synthetic.icrs, abs=1e-9)
    assert found.terrains["ice"].fit.values == pytest.approx(ICE, abs=1e-9)
    assert set(found.terrains["ice"].fit.windows.run) == {"ice_run"}
    found.require_determined()


def test_runs_of_one_terrain_are_fitted_together(make, ice):
    other = make("other", terrain="ice", seed=1)
    found = identify([ice, other], "icr", solver_config=ONE_START).terrains["ice"]
    assert set(found.fit.windows.run) == {"ice_run", "other"}
    assert found.fit.values == pytest.approx(ICE, abs=1e-9)


def test_a_run_over_two_terrains_is_parted(make):
    names = ["ice"] * 200 + ["sand"] * 200
    run = make("both", terrain_column=names)
    found = identify([run], "icr", solver_config=ONE_START)
    assert list(found.terrains) == ["ice", "sand"]
    starts_s = {name: ground.fit.windows.start_s for name, ground in found.terrains.items()}
    assert starts_s["ice"].max() < 20 <= starts_s["sand"].min()


@pytest.mark.parametrize(("terrain", "expected"), [(None, "ground"), ("mud", "mud")])
def test_a_terrain_without_name(make, ice, terrain, expected):
    """The given name is for the runs that have none."""
    nameless = make("nameless", seed=1)
    found = identify([nameless, ice], "icr", terrain=terrain, solver_config=ONE_START)
    assert list(found.terrains) == [expected, "ice"]


def test_runs_that_name_a_terrain_and_runs_given_to_be_on_it_are_one(make, ice):
    nameless = make("nameless", seed=1)
    found = identify([nameless, ice], "icr", terrain="ice", solver_config=ONE_START)
    assert set(found.terrains["ice"].fit.windows.run) == {"nameless", "ice_run"}


def test_held_out_errors_are_of_other_runs_and_of_the_halves_of_one(make, ice):
    """Two runs of unlike robots, though on one terrain: neither gives parameters of the other."""
    other = make("other", truth=ICE | {"y_left": 1.4}, terrain="ice", seed=1)
    halves = identify([ice], "icr", solver_config=ONE_START).terrains["ice"]
    assert np.all(halves.held_out.translation_per_m < 1e-9)
    crossed = identify([ice, other], "icr", solver_config=ONE_START).terrains["ice"]
    assert len(crossed.held_out.rotation_per_m) == len(crossed.fit.windows)
    assert crossed.held_out.rotation_per_m.mean() > 0.05


def test_without_enough_for_the_parts_there_is_no_held_out_error(ice):
    """Five windows determine five parameters; two or three would not determine nine numbers."""
    config = WindowConfig(horizon_m=20.0, shortest=0.9)
    found = identify([ice], "icr_symmetric", window_config=config, solver_config=ONE_START)
    assert len(found.terrains["ice"].fit.windows) == 1
    assert found.terrains["ice"].held_out is None


def test_the_ideal_drive_is_that_of_the_track_width(ice):
    """The treads themselves are the ICRs."""
    found = identify([ice], "icr", solver_config=ONE_START).terrains["ice"]
    ideal = np.array([0.25, -0.25, 0, 1, 1])
    expected = window_errors(Icr(), ideal, windows_of([ice], WindowConfig()))
    for name in ("translation_per_m", "rotation_per_m"):
        np.testing.assert_allclose(getattr(found.ideal, name), getattr(expected, name), atol=1e-12)


def test_robots_of_different_width_are_refused(ice, make):
    wide = make("wide", track_width=0.6)
    with pytest.raises(
        IdentificationError, match=r"wide: \[robot\] track_width = 0\.6, .*ice_run has 0\.5"
    ):
        identify([ice, wide], "icr")
    assert robot_of([ice, ice]) == ice.robot
    light, loaded = (replace(ice, robot=replace(ice.robot, mass=mass)) for mass in (50.0, 80.0))
    with pytest.raises(IdentificationError, match="its own mass also where it carries a load"):
        robot_of([light, loaded])


def test_no_run_is_refused():
    with pytest.raises(IdentificationError, match="no run"):
        identify([], "icr")


def test_an_unknown_model_is_reported_with_the_known_ones(ice):
    with pytest.raises(ParameterError, match=r"'icrs'; known: .*icr_symmetric"):
        identify([ice], "icrs")


def test_a_model_that_needs_accelerations_says_so(ice):
    with pytest.raises(ParameterError, match="accel_x"):
        identify([ice], "icr_inertia_measured")


def test_fixed_and_released_reach_the_fit(ice):
    found = identify(
        [ice], "traction_mode", fixed={"m": 1.0}, released=["track_width"], solver_config=ONE_START
    )
    assert found.terrains["ice"].fit.names == ("k", "track_width")
    assert found.terrains["ice"].fit.values["m"] == 1.0


def test_what_the_runs_leave_open_is_refused_with_numbers(make, synthetic, stated):
    """Half a millimetre forward a second: slip and width are nearly indistinguishable."""
    odometry = np.column_stack([np.arange(0, 60, 0.1), np.full(600, -0.4), np.full(600, 0.401)])
    run = make("spin", terrain="ice")
    poses, _ = synthetic.walk(odometry, run.pose.stamps_s, synthetic.icr_twist(ICE))
    columns = {"t": run.pose.stamps_s, **dict(zip(["x", "y", "yaw"], poses.T, strict=True))}
    table = dict(zip(["t", "v_left", "v_right"], odometry.T, strict=True))
    run = replace(
        run,
        pose=replace(run.pose, columns=columns),
        odometry=replace(run.odometry, columns=table),
    )
    run = synthetic.noisy(run, np.random.default_rng(1))
    found = identify([run], "icr_symmetric", window_config=stated, solver_config=ONE_START)
    (open_,) = found.terrains["ice"].fit.undetermined
    with pytest.raises(IdentificationError) as caught:
        found.require_determined()
    message = str(caught.value)
    assert "[ice]" in message
    assert "alpha" in message
    assert "b_hat" in message
    number = re.search(r"deviation ([0-9.e+]+) of its ordinary size", message)[1]
    assert float(number) == pytest.approx(open_.deviation, rel=0.06)
    held = identify([run], "icr_symmetric", fixed={"alpha": 0.85}, solver_config=ONE_START)
    held.require_determined()


@pytest.mark.parametrize("model", ["icr", "traction_mode", "full_linear"])
def test_a_parameter_set_comes_back_from_its_file(noisy_runs, model, stated, tmp_path):
    found = identify(noisy_runs, model, window_config=stated, solver_config=ONE_START)
    file = tmp_path / "set.toml"
    write_parameters(file, found.to_parameter_set())
    read = read_parameters(file)
    assert list(read.terrains) == ["gravel", "ice"]
    for name, ground in found.terrains.items():
        table = read.terrains[name]
        assert table.model == model
        assert table.values == ground.fit.values
        assert table.covariance_order == ground.fit.names
        np.testing.assert_array_equal(table.covariance, ground.fit.normal_covariance)
        assert f"{len(ground.fit.windows)} windows" in table.source
        assert ground.fit.windows.run[0] in table.source


def test_a_parameter_set_names_the_runs_of_both_stages(gravel, make, synthetic):
    base = {"v_max": 1.2, "half_width": 0.25, "half_length": 0.35}
    tilted = make("tilted", terrain="gravel", attitude_of=synthetic.plane(0.15))
    found = identify([gravel, tilted], "icr_slope", fixed=base, solver_config=ONE_START)
    source = found.to_parameter_set().terrains["gravel"].source
    assert "winding" in source
    assert "tilted" in source


def test_the_same_input_gives_the_same_file(gravel, synthetic, stated, tmp_path):
    run = synthetic.noisy(gravel, np.random.default_rng(1))
    contents = []
    for name in ("one", "two"):
        found = identify([run], "icr", window_config=stated)
        write_parameters(tmp_path / name, found.to_parameter_set())
        contents.append((tmp_path / name).read_bytes())
    assert contents[0] == contents[1]


def test_slopes_are_fitted_in_two_stages_and_nothing_else_is(gravel):
    """On flat ground alone the second stage has nothing; a plain fit would not complain."""
    with pytest.raises(IdentificationError, match="tilted more than"):
        identify([gravel], "icr_slope", solver_config=ONE_START)
    fitted = fit(
        MODELS["icr"],
        windows_of([gravel], WindowConfig()),
        gravel.robot,
        fixed={},
        window_config=WindowConfig(),
        solver_config=ONE_START,
    )
    found = identify([gravel], "icr", solver_config=ONE_START).terrains["gravel"].fit
    np.testing.assert_allclose(found.packed, fitted.packed, rtol=1e-12)
