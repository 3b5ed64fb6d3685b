"""`simulate`: the options reach the simulation, and the command says what comes next."""

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.errors import OdometryError
from odometry.installed import shipped_data
from odometry.recording.run import Run
from odometry.simulation.courses import COURSE_NAMES
from terrain.cli.verbs.simulate import VEHICLES, simulate

PIONEER = shipped_data() / "vehicles" / "pioneer_like.toml"


def invoke(out, *arguments):
    return CliRunner().invoke(simulate, ["--out", str(out), "--duration", "6", *arguments])


def test_the_run_can_be_read_and_holds_what_was_asked(tmp_path):
    out = tmp_path / "run"
    options = ["--vehicle", "j8", "--drive", "spin", "--slope", "4", "--slope-direction", "30"]
    more = ["--friction", "0.5", "--law", "coulomb", "--max-speed", "0.3", "--terrain", "concrete"]
    answer = invoke(out, *options, *more, "--seed", "3")
    assert answer.exit_code == 0, answer.output
    run = Run.read(out)
    assert (run.robot.name, run.terrain) == ("j8", "concrete")
    made = run.settings["simulation"]
    assert made["vehicle"]["law"]["kind"] == "Coulomb"
    assert np.mean(made["vehicle"]["friction"]) == pytest.approx(0.5)
    assert (made["drive"], made["max_speed_m_s"], made["seed"]) == ("spin", 0.3, 3)
    speeds = run.odometry.stack("v_left", "v_right")[150]
    np.testing.assert_allclose(speeds, [-0.3, 0.3], atol=0.01)
    tilt = run.odometry.stack("roll", "pitch")[:20].mean(axis=0)
    np.testing.assert_allclose(np.rad2deg(tilt), [2.0, -3.464], atol=0.2)  # 4 degrees, up to 30
    assert f"Wrote the run {out}: 6 s of j8" in answer.output
    command = f"Next: terrain-odometry identify {out} --model icr --out my_robot.toml"
    assert answer.output.splitlines()[-1] == command


def test_the_seed_changes_the_drive_and_the_same_one_repeats_it(tmp_path):
    files = []
    for name, seed in (("one", "1"), ("same", "1"), ("other", "2")):
        assert invoke(tmp_path / name, "--seed", seed).exit_code == 0
        files.append((tmp_path / name / "odometry.csv").read_bytes())
    assert files[0] == files[1] != files[2]


@pytest.mark.parametrize(
    "drive", ["excitation", "figure_eight", "tour", "skidpad", "clothoid", "sinusoid"]
)
def test_every_drive_can_be_driven(tmp_path, drive):
    answer = invoke(tmp_path / "run", "--drive", drive, "--slope", "5", "--duration", "12")
    assert answer.exit_code == 0, answer.output
    assert len(Run.read(tmp_path / "run").pose) > 30


def test_a_spiral_turns_left_or_right_by_the_seed(tmp_path):
    turned = []
    for seed in range(6):
        out = tmp_path / str(seed)
        answer = invoke(out, "--drive", "outward_spiral", "--seed", str(seed))
        assert answer.exit_code == 0, answer.output
        turned.append(np.sign(Run.read(out).truth["yaw"][-1]))
    assert set(turned) == {-1.0, 1.0}


def test_the_choice_of_drives_is_that_of_the_courses():
    options = {option.name: option for option in simulate.params}
    assert tuple(options["drive"].type.choices) == COURSE_NAMES


def test_the_vehicles_that_are_offered_are_those_that_can_be_simulated():
    files = sorted(shipped_data().glob("vehicles/*.toml"))
    assert tuple(f.stem for f in files if "[contact]" in f.read_text()) == VEHICLES


def test_a_vehicle_of_ones_own(tmp_path):
    (tmp_path / "mine.toml").write_text(
        "[robot]\ntrack_width = 0.5\nmass = 30.0\n[contact]\nyaw_inertia = 2.0\nx_cm = 0.0\n"
        "y_cm = 0.0\nheight = 0.2\nplaces = [-0.2, 0.2]\npatch_length = 0.1\nfriction = 0.5\n"
        "law = 'shear'\nsettling = 0.1\n"
    )
    answer = invoke(tmp_path / "run", "--vehicle", str(tmp_path / "mine.toml"))
    assert answer.exit_code == 0, answer.output
    assert Run.read(tmp_path / "run").robot.mass == 30.0


def test_a_wrong_vehicle_and_a_full_folder_are_named_before_anything_is_made(tmp_path):
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file").write_text("")
    for out, arguments, message in (
        (
            tmp_path / "run",
            ["--vehicle", "tank"],
            "neither a file nor one of auriga_alpha, husky_like",
        ),
        (tmp_path / "run", ["--vehicle", "husky"], "warthog_like; did you mean husky_like?"),
        (tmp_path / "run", ["--vehicle", "pioneer_like"], "neither a file nor one of"),
        (tmp_path / "run", ["--vehicle", str(PIONEER)], r"table \[contact\] is missing"),
        (tmp_path / "full", [], "not empty"),
    ):
        answer = invoke(out, *arguments)
        with pytest.raises(OdometryError, match=message):
            raise answer.exception
    assert not (tmp_path / "run").exists()


def test_traction_is_named_by_the_truth_and_by_run_toml_where_it_is_one(tmp_path):
    answer = invoke(tmp_path / "one", "--traction", "grass")
    assert answer.exit_code == 0, answer.output
    one = Run.read(tmp_path / "one")
    assert one.terrain == "grass"
    assert set(one.truth["terrain"]) == {"grass"}
    answer = invoke(tmp_path / "two", "--traction", "none", "--traction", "all@2.0")
    assert answer.exit_code == 0, answer.output
    first, second = answer.output.splitlines()[-2:]
    assert first.startswith("Next: terrain-odometry identify-modes RUN... --out modes.toml")
    assert f"terrain-odometry modes {tmp_path / 'two'} --models modes.toml" in second
    two = Run.read(tmp_path / "two")
    assert two.terrain is None
    assert (two.truth["terrain"] == np.where(two.truth.stamps_s < 2.0 - 1e-9, "none", "all")).all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--traction", "mud"], "--traction mud: expected one of asphalt, grass"),
        (["--traction", "all@soon"], "'soon' is no number of seconds"),
        (["--traction", "grass", "--friction", "0.3"], "leave out --friction and --law"),
    ],
)
def test_traction_that_cannot_be_is_reported(tmp_path, arguments, message):
    answer = invoke(tmp_path / "run", *arguments)
    assert answer.exit_code == 2
    assert message in " ".join(answer.output.split())
