"""The model of the calibration, by name or from a file."""

import pytest

from odometry.errors import GapError, ParameterError
from odometry.gap.prepare.uncertain_base import believed_model

ICRS = "y_left = 0.45\ny_right = -0.42\nx_icr = 0.02\n"
EFFECT = """[[terrain.{0}.effects]]
name = "lateral_skid"
form = "x_icr"
parameters = {{ x_shift = 0.1 }}
"""


@pytest.fixture
def runs(make_scene):
    def terrain(t):
        return t > 1e9  # labels stand in the column, not in the run's own table

    return [make_scene(1, duration_s=20.0).run, make_scene(2, duration_s=20.0, terrain=terrain).run]


@pytest.fixture
def set_of(tmp_path):
    def write(**grounds):
        file = tmp_path / "set.toml"
        file.write_text("".join(f"[terrain.{name}]\n{text}" for name, text in grounds.items()))
        return str(file)

    return write


def on(run, ground):
    run.settings["run"] = {"terrain": ground}
    return run


def test_a_name_is_a_model_to_identify(runs):
    model, given = believed_model("icr_symmetric", runs)
    assert (model.name, given) == ("icr_symmetric", None)


def test_an_unknown_name_is_refused_with_those_there_are():
    with pytest.raises(ParameterError, match=r"unicycle.*icr_symmetric"):
        believed_model("unicycle", [])


def test_a_set_of_one_terrain_is_taken_as_it_is(runs, set_of):
    model, given = believed_model(set_of(grass=ICRS), runs)
    assert model.name == "icr"
    assert {"y_left": 0.45, "y_right": -0.42, "x_icr": 0.02}.items() <= given.items()


def test_of_several_terrains_the_asked_one_or_that_of_the_runs(runs, set_of):
    file = set_of(grass=ICRS, sand=ICRS.replace("0.45", "0.6"))
    assert believed_model(file, runs, "sand")[1]["y_left"] == 0.6
    assert believed_model(file, [runs[0], on(runs[1], "sand")])[1]["y_left"] == 0.6
    assert believed_model(file, [on(runs[1], "sand")], "grass")[1]["y_left"] == 0.45


@pytest.mark.parametrize("terrain", [None, "stone"])
def test_a_terrain_that_is_not_there_is_refused_with_those_there_are(runs, set_of, terrain):
    with pytest.raises(GapError, match=r"set\.toml: no terrain.*grass, sand.*--terrain"):
        believed_model(set_of(grass=ICRS, sand=ICRS), runs, terrain)


def test_a_set_of_another_robot_is_refused(runs, set_of):
    width_m = runs[0].robot.track_width
    file = set_of(grass=ICRS + f"[vehicle]\ntrack_width = {1.05 * width_m}\n")
    assert believed_model(file, runs)[0].name == "icr"
    other = set_of(grass=ICRS + f"[vehicle]\ntrack_width = {1.2 * width_m}\n")
    with pytest.raises(GapError, match=r"of a robot of track width .*on the calibration runs"):
        believed_model(other, runs)


def test_effects_on_the_ground_taken_are_refused(runs, set_of):
    file = set_of(grass=ICRS + EFFECT.format("grass"), sand=ICRS)
    with pytest.raises(GapError, match=r"\[terrain\.grass\] has effects already"):
        believed_model(file, runs, "grass")
    assert believed_model(file, runs, "sand")[0].name == "icr"
