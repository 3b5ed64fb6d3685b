"""Whole synthetic runs, small: what is written agrees with itself and can be read back."""

import csv
import hashlib
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.feel.recorded.signals import AXES
from odometry.feel.recorded.windows import feel_windows
from odometry.parameters import read_parameters
from odometry.recording.run import Run
from odometry.simulation.ground import GroundMap
from terrain.camera.camera import Camera
from terrain.classification.photographs.patches import find_photos
from terrain.cli.verbs.synthesise import synthesise as command
from terrain.errors import SynthesisError
from terrain.images import read_image
from terrain.synthesis.config import default_camera, default_robot, read_camera, read_robot
from terrain.synthetic import SynthesisConfig, synthesise

DATA = Path(__file__).parents[2] / "data"
CAMERA = Camera.from_mount(
    (160, 120), [[175, 0, 79.5], [0, 175, 59.5], [0, 0, 1]], [], [0.15, 0, 1, 0, 0.733, 0]
)
SMALL = SynthesisConfig(
    seed=5,
    zone_length_m=2.0,
    camera=CAMERA,
    metres_per_pixel=0.012,
    patch_size_px=32,
    patches_per_terrain=9,
    sigma_tread_m_s=0.005,
    icr_wander_m=(0.01, 0.01, 0.004),
)


def digest(folder):
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    content = b"".join(str(path.relative_to(folder)).encode() + path.read_bytes() for path in files)
    return hashlib.sha256(content).hexdigest()


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    return synthesise(tmp_path_factory.mktemp("synthetic") / "small", SMALL)


@pytest.fixture(scope="module")
def run(small):
    return Run.read(small)


def test_run_is_laid_out_as_asked(run):
    truth = run.truth
    terrains = [str(name) for name in truth["terrain"]]
    changes = [name for i, name in enumerate(terrains) if i == 0 or name != terrains[i - 1]]
    assert changes == ["gravel", "grass", "gravel"]
    assert 6.0 < truth["x"][-1] < 6.1
    assert np.diff(run.odometry.stamps_s) == pytest.approx(0.05)
    assert np.diff(run.pose.stamps_s) == pytest.approx(0.1)
    assert np.diff(run.images.stamps_s) == pytest.approx(0.25)
    assert run.settings["source"]["seed"] == 5
    assert run.settings["source"]["edges_m"] == [2.0, 4.0]
    assert run.settings["source"]["driver"]["weave_rad"] == SMALL.driver.weave_rad


def test_every_image_is_there_and_of_the_camera(run):
    camera = Camera.from_table(run.settings["camera"])
    for name in run.images["file"]:
        assert read_image(run.folder / str(name)).shape == camera.image_size[::-1]


def test_terrain_is_that_of_the_ground_in_source(run):
    """Edges and waves of [source] give back the terrain column, under the robot and in images."""
    source = run.settings["source"]
    ground = GroundMap(
        np.array(source["edges_m"]),
        tuple(source["strips"]),
        source["edge_wave_m"],
        tuple(source["edge_wave_phases_rad"]),
    )
    poses = run.truth.stack("x", "y", "yaw")
    under = [ground.terrains[i] for i in ground.strip_at(poses[:, :2])]
    assert under == [str(name) for name in run.truth["terrain"]]
    # the camera's axis meets the ground at 0.15 + 1 / tan(0.733) m
    ahead = 0.15 + 1 / np.tan(0.733)
    shown = poses[np.searchsorted(run.truth.stamps_s, run.images.stamps_s - 1e-6)]
    centre = shown[:, :2] + ahead * np.column_stack([np.cos(shown[:, 2]), np.sin(shown[:, 2])])
    seen = [ground.terrains[i] for i in ground.strip_at(centre)]
    assert seen == [str(name) for name in run.images["terrain"]]


def test_sensors_are_the_truth_plus_the_stated_noise(run):
    """Tread speeds and true ICRs give the true motion (closed form); poses and gyro scatter."""
    truth = run.truth
    icr, poses = truth.stack("y_left", "y_right", "x_icr"), truth.stack("x", "y", "yaw")
    treads = run.odometry.stack("v_left", "v_right")
    width = icr[:, 0] - icr[:, 1]
    omega = (treads[:, 1] - treads[:, 0]) / width
    turned = np.diff(poses[:, 2])
    np.testing.assert_allclose(
        (omega[:-1] * 0.05 - turned).std(), 0.05 * 0.005 * 1.41 / 0.7, rtol=0.5
    )
    assert (run.odometry["gyro_z"][:-1] - turned / 0.05).std() < 0.03
    error = run.pose.stack("x", "y", "yaw") - poses[::2]
    np.testing.assert_allclose(error.std(axis=0), [0.02, 0.02, np.radians(0.5)], rtol=0.25)
    assert (np.abs(error.mean(axis=0)) < 4 * error.std(axis=0) / np.sqrt(len(error))).all()


def test_true_icrs_wander_about_their_terrains_values(run):
    names = run.truth["terrain"].astype(str)
    x = run.truth["x"]
    for terrain, icr in run.settings["source"]["icrs_y_left_y_right_x_icr_m"].items():
        inside = (names == terrain) & (np.abs(x - 2.0) > 0.6) & (np.abs(x - 4.0) > 0.6)
        if inside.any():
            error = run.truth.stack("y_left", "y_right", "x_icr")[inside] - icr
            assert (np.abs(error) < [0.05, 0.05, 0.02]).all()
            assert (np.ptp(error, axis=0) > 1e-3).all()


def test_parameters_are_near_the_truth_but_not_the_truth(small, run):
    parameters = read_parameters(small / "parameters.toml")
    assert list(parameters.terrains) == ["gravel", "grass", "brick"]
    truth = run.settings["source"]["icrs_y_left_y_right_x_icr_m"]
    errors = np.array(
        [
            [
                own.values[key] - value
                for key, value in zip(own.covariance_order, truth[name], strict=True)
            ]
            for name, own in parameters.terrains.items()
        ]
    )
    in_sigmas = errors / SMALL.sigma_parameters_m
    assert (np.abs(in_sigmas) < 4).all()
    assert 0.4 < np.sqrt((in_sigmas**2).mean()) < 1.8
    first = parameters.terrains["gravel"]
    np.testing.assert_allclose(np.sqrt(np.diag(first.covariance)), [0.02, 0.02, 0.01])


def test_patches_are_labelled_grouped_and_scaled(small):
    photos = find_photos(small / "patches")
    assert {photo.label for photo in photos} == {"brick", "grass", "gravel"}
    assert len(photos) == 48
    assert len({photo.group for photo in photos}) == 24
    assert {read_image(photo.path).shape for photo in photos} == {(32, 32)}
    with (small / "patches" / "manifest.csv").open() as stream:
        assert {row["metres_per_pixel"] for row in csv.DictReader(stream)} == {"0.012"}


def test_same_seed_same_bytes_other_seed_other_bytes(small, tmp_path):
    assert digest(synthesise(tmp_path / "again", SMALL)) == digest(small)
    other = synthesise(tmp_path / "other", replace(SMALL, seed=6))
    assert (other / "images/000003.jpg").read_bytes() != (small / "images/000003.jpg").read_bytes()
    assert (other / "odometry.csv").read_bytes() != (small / "odometry.csv").read_bytes()


def test_vibration_changes_nothing_but_imu_and_the_labels(small, tmp_path):
    with_imu = synthesise(tmp_path / "imu", replace(SMALL, has_imu=True))
    files = [path.relative_to(with_imu) for path in with_imu.rglob("*") if path.is_file()]
    assert {
        path.name
        for path in files
        if not (small / path).is_file()
        or (small / path).read_bytes() != (with_imu / path).read_bytes()
    } == {"imu.csv", "odometry.csv", "run.toml"}
    run = Run.read(with_imu)
    assert run.odometry["terrain"].tolist() == run.truth["terrain"].tolist()
    assert feel_windows(run).axes == AXES


def test_nothing_is_overwritten(small):
    with pytest.raises(SynthesisError, match="not an empty folder"):
        synthesise(small, SMALL)


def test_unknown_zone(tmp_path):
    with pytest.raises(SynthesisError, match="of 'mud'; there are of: brick, grass, gravel"):
        synthesise(tmp_path / "run", replace(SMALL, zones=("grass", "mud")))


def test_camera_too_narrow_for_the_patches(tmp_path):
    with pytest.raises(SynthesisError, match=r"no square of 3\.00 m"):
        synthesise(tmp_path / "run", replace(SMALL, patch_size_px=250))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"zones": ()}, "at least one zone"),
        ({"zone_length_m": 0.0}, "zone_length_m must be above zero"),
        ({"jpeg_quality": 0}, "in 1 to 100"),
        ({"image_rate_hz": 3.0}, "whole multiple of image_rate_hz = 3"),
        ({"pose_rate_hz": 40.0}, "whole multiple of pose_rate_hz = 40"),
        ({"robot": {"track_width": 0.4}}, "needs length, width"),
    ],
)
def test_wrong_settings(change, message):
    with pytest.raises(SynthesisError, match=message):
        replace(SMALL, **change)


def test_icrs_scale_with_the_robot_and_spread_over_new_terrains():
    wide = replace(SMALL, robot=default_robot() | {"track_width": 0.8})
    icrs, doubled = (c.true_icrs_m(("asphalt", "mud", "sand")) for c in (SMALL, wide))
    widths = [icr[0] - icr[1] for icr in icrs.values()]
    np.testing.assert_allclose(widths, [0.55, 0.75, 0.95])
    np.testing.assert_allclose(list(doubled.values()), 2 * np.array(list(icrs.values())))
    own = replace(SMALL, icrs_m={"mud": (0.5, -0.4, 0.0)})
    np.testing.assert_allclose(own.true_icrs_m(("mud",))["mud"], [0.5, -0.4, 0.0])
    with pytest.raises(SynthesisError, match="lacks 'sand'"):
        own.true_icrs_m(("mud", "sand"))


def test_shipped_camera_and_vehicle_are_the_defaults():
    shipped = read_camera(DATA / "cameras" / "mast.toml").to_table()
    default = default_camera().to_table()
    assert shipped.keys() == default.keys()
    for key, values in default.items():
        np.testing.assert_allclose(shipped[key], values, err_msg=key)
    assert read_robot(DATA / "vehicles" / "pioneer_like.toml") == default_robot()


def test_description_files_without_their_table(tmp_path):
    file = tmp_path / "camera.toml"
    file.write_text("[lens]\n")
    with pytest.raises(SynthesisError, match=r"\[camera\] is missing; found: \['lens'\]"):
        read_camera(file)
    file.write_text("[lens")
    with pytest.raises(SynthesisError, match="cannot be read as TOML"):
        read_robot(file)


def test_command(tmp_path):
    camera = tmp_path / "camera.toml"
    rows = "\n".join(f"{key} = {value}" for key, value in CAMERA.to_table().items())
    camera.write_text(f"[camera]\n{rows}\n")
    out = tmp_path / "run"
    asked = ["--out", out, "--zone", "brick", "--zone-length", "1.5", "--image-rate", "1"]
    asked += ["--camera", camera, "--metres-per-pixel", "0.004", "--seed", "3"]
    result = CliRunner().invoke(command, [str(word) for word in asked], catch_exceptions=False)
    assert result.exit_code == 0
    assert f"terrain-odometry train {out / 'patches'}" in result.stdout
    assert f"terrain-odometry run {out} " in result.stdout
    settings = tomllib.loads((out / "run.toml").read_text())
    assert settings["run"] == {"terrain": "brick"}  # all of it
    assert settings["source"]["zones"] == ["brick"]
    assert settings["source"]["metres_per_pixel"] == 0.004


def test_help_keeps_the_lines_of_its_example():
    result = CliRunner().invoke(command, ["--help"])
    assert "\n    terrain-odometry synthesise --out my_run --seed 3\n" in result.stdout


def test_shipped_demo():
    """The shipped run and patches are small, whole, and of one making."""
    run = Run.read(DATA / "runs" / "demo")
    size = sum(path.stat().st_size for path in run.folder.rglob("*") if path.is_file())
    assert size < 6e6
    assert 90 <= len(run.images.stamps_s) <= 130
    assert run.wheel_travel_m[-1] >= 30.0
    photos = find_photos(DATA / "patches")
    assert {photo.label for photo in photos} == set(
        read_parameters(run.folder / "parameters.toml").terrains
    )
