"""The terrain in force before the first switch: named, of the run, of the set, or unknown."""

from dataclasses import replace

import pytest

from odometry.errors import ParameterError
from odometry.parameters import ParameterSet
from odometry.recording.run import Run
from terrain.main_job import run_odometry
from terrain.result.run_notes import run_notes
from tests.terrain.test_run_odometry import SET


def test_the_first_terrain_is_the_one_named_else_the_sets_only_one_else_the_runs(
    tmp_path, world, curvy_run
):
    folder = world.drive_curves(tmp_path / "run")
    world.write_toml(folder / "run.toml", robot=world.robot, run={"terrain": "sand"})
    assert run_odometry(folder, parameters=SET, terrain="mud").initial_terrain == "mud"
    only = ParameterSet(dict(list(SET.terrains.items())[:1]))
    of_another = run_odometry(folder, parameters=only)
    assert of_another.initial_terrain == "boards"
    (note,) = (note for note in run_notes(of_another) if "'sand'" in note)
    assert "the parameter set has 'boards' alone: this is in force" in note
    own = run_odometry(folder, parameters=SET)
    assert own.initial_terrain == "sand"
    assert not any("run.toml names" in note for note in run_notes(own))
    assert run_odometry(folder).initial_terrain == "sand"
    assert run_odometry(curvy_run).initial_terrain == "ground"


def test_without_a_source_no_table_of_several_is_in_force(curvy_run):
    result = run_odometry(curvy_run, parameters=SET)
    assert set(result.replay.terrains) == {result.initial_terrain} == {"unknown"}
    assert result.learned.terrains == SET.terrains


def test_with_images_a_start_that_nobody_named_is_unknown(across_run, classifier):
    """The first table of the set would be boards; the robot begins on gravel."""
    result = run_odometry(across_run, model=classifier, parameters=SET)
    assert list(dict.fromkeys(result.replay.terrains)) == ["unknown", "gravel", "boards"]
    run = Run.read(across_run)
    of_run = replace(run, settings={**run.settings, "run": {"terrain": "gravel"}})
    stated = run_odometry(of_run, model=classifier, parameters=SET)
    assert stated.initial_terrain == "gravel"


def test_the_reserved_name_is_never_in_force(tmp_path, world, curvy_run):
    """No parameter set may hold it, so what is learned there could not be handed on."""
    with pytest.raises(ParameterError, match="'unknown' is reserved"):
        run_odometry(curvy_run, terrain="unknown")
    folder = world.drive_curves(tmp_path / "run")
    world.write_toml(folder / "run.toml", robot=world.robot, run={"terrain": "unknown"})
    assert run_odometry(folder).initial_terrain == "ground"
