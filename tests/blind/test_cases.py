"""The blind cases are what they say: the same each time, readable, and of effects that show."""

import numpy as np
import pytest

from odometry.recording.run import Run
from tests.blind.cases import FORMULA, KINDS, NAMES, NONE, PAIRS, UNKNOWN, make_case
from tests.blind.formula_cases import draw_formula_case
from tests.blind.robot import Icrs
from tests.blind.sizes import NOISE_FLOOR_M, size_m

RUNS = ("calibration", "measured", "holdout")


def contents(folder):
    return {
        str(file.relative_to(folder)): file.read_bytes()
        for file in sorted(folder.rglob("*"))
        if file.is_file()
    }


def draw(kind, seed):
    return draw_formula_case(kind, np.random.default_rng([seed, *kind.encode()]))


@pytest.mark.parametrize("kind", ["wheel_scale+time_offset", "terrain", "none"])
def test_a_seed_gives_the_same_bytes_and_another_seed_others(tmp_path, kind):
    first = make_case(kind, 3, tmp_path / "a")
    again = make_case(kind, 3, tmp_path / "b")
    other = make_case(kind, 4, tmp_path / "c")
    assert contents(tmp_path / "a") == contents(tmp_path / "b")
    assert first.truth == again.truth != other.truth
    assert not contents(tmp_path / "a").items() & contents(tmp_path / "c").items()


def test_the_noise_level_changes_the_noise_of_poses_alone(tmp_path):
    quiet = make_case("lever_arm", 1, tmp_path / "a", noise=0.0)
    loud = make_case("lever_arm", 1, tmp_path / "b", noise=2.0)
    assert quiet.truth == loud.truth
    for name in RUNS:
        a, b = (Run.read(tmp_path / folder / name) for folder in "ab")
        assert contents(a.folder)["odometry.csv"] == contents(b.folder)["odometry.csv"]
        error = b.pose.stack("x", "y", "yaw") - a.pose.stack("x", "y", "yaw")
        error[:, 2] = np.angle(np.exp(1j * error[:, 2]))
        assert error.std(axis=0) == pytest.approx([0.02, 0.02, np.deg2rad(0.46)], rel=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["slope_sliding", "terrain", "lever_arm", *UNKNOWN[:1], *NONE])
def test_the_folders_have_the_shape_of_a_case(tmp_path, kind):
    case = make_case(kind, 0, tmp_path)
    for name, length_s in zip(RUNS, (120.0, 160.0, 160.0), strict=True):
        run = Run.read(getattr(case, name))
        assert run.odometry.stamps_s[[0, -1]] @ [-1, 1] == pytest.approx(length_s)
        np.testing.assert_allclose(np.diff(run.odometry.stamps_s), 0.02, rtol=1e-6)
        np.testing.assert_allclose(np.diff(run.pose.stamps_s), 0.1, rtol=1e-6)
        assert {"roll", "pitch", "gyro_z"} <= set(run.odometry.columns)
        assert ("terrain" in run.odometry.columns) == (kind == "terrain")
        fastest = np.abs(run.odometry.stack("v_left", "v_right")).max()
        assert fastest < 0.52 if name == "calibration" else 0.7 < fastest < 1.52
        tilted = np.abs(run.odometry.stack("roll", "pitch")).max()
        assert (tilted > 0.03) == (kind == "slope_sliding" and name != "calibration")


def test_terrain_is_calibrated_on_the_first_label(tmp_path):
    case = make_case("terrain", 0, tmp_path)
    grounds = case.truth["terrain"]
    first = next(iter(grounds))
    assert grounds[first] == case.truth["base"]
    assert set(Run.read(case.calibration).odometry["terrain"]) == {first}
    for folder in (case.measured, case.holdout):
        assert set(Run.read(folder).odometry["terrain"]) == set(grounds)


@pytest.mark.parametrize("kind", [*FORMULA, *UNKNOWN, *PAIRS])
def test_every_effect_shows_by_itself(kind):
    drawn = draw(kind, 0)
    icrs = Icrs(**drawn.truth["base"])
    sizes = {
        name: size_m(motion, icrs, effects) for name, (motion, effects) in drawn.motions.items()
    }
    assert sizes["calibration"] < 0.02 * NOISE_FLOOR_M
    assert sizes["measured"] > 1.5 * NOISE_FLOOR_M  # two at once may cancel in part
    assert sizes["holdout"] > NOISE_FLOOR_M


def test_without_an_effect_the_base_model_is_exact():
    drawn = draw("none", 0)
    icrs = Icrs(**drawn.truth["base"])
    for motion, effects in drawn.motions.values():
        assert effects == {}
        assert size_m(motion, icrs, effects) < 1e-5


def test_every_kind_is_listed_once():
    assert len(NAMES) == len(set(NAMES))
    assert {"formula", "contact", "unknown", "none", "pairs"} < set(KINDS)
    assert {part for pair in PAIRS for part in pair.split("+")} <= set(FORMULA)
