"""The main job end to end, on runs whose ground and motion the tests made themselves."""

from itertools import pairwise

import numpy as np
import pytest

from odometry.estimation.config import IcrEkfConfig
from odometry.parameters import ParameterSet, TerrainParameters, write_parameters
from odometry.recording.run import Run
from terrain.config import Config
from terrain.main_job import run_odometry
from terrain.region.region import RegionConfig

SET = ParameterSet(
    {
        "boards": TerrainParameters("icr", {"y_left": 0.21, "y_right": -0.19, "x_icr": 0.01}),
        "gravel": TerrainParameters("icr", {"y_left": 0.31, "y_right": -0.27, "x_icr": -0.02}),
    }
)


def spans(result):
    """x of the robot where the terrain in force changed, and the new terrain; it drives along x."""
    pairs = pairwise(result.replay.estimates)
    return [(now.mean[0], now.terrain) for old, now in pairs if now.terrain != old.terrain]


def test_the_terrain_changes_where_the_robot_crosses_the_edges(across_result, world):
    """Within half a robot length: the region is of that size, and an image comes every 0.12 m."""
    (first, boards), (second, gravel) = spans(across_result)
    assert (boards, gravel) == ("boards", "gravel")
    half = world.robot["length"] / 2
    assert first == pytest.approx(world.edges_m[0], abs=half)
    assert second == pytest.approx(world.edges_m[1], abs=half)


def test_ground_that_fills_the_region_is_named_rightly(across_result, world):
    """The robot drives along x at constant speed, so a region's place in the world is known."""
    wrong = checked = 0
    for image_label in across_result.watcher.image_labels:
        start = world.speed_m_s * image_label.stamp_s
        box = image_label.region.rectangle
        low, high = start + box.x_min, start + box.x_max
        if all(high < edge or low > edge for edge in world.edges_m):
            true = "boards" if world.edges_m[0] < low < world.edges_m[1] else "gravel"
            wrong += image_label.label != true
            checked += 1
    assert checked > 15
    assert wrong <= 0.1 * checked


def test_every_image_of_the_run_was_looked_at(across_result, across_run):
    files = [line.split(",")[1] for line in (across_run / "images.csv").read_text().split()[1:]]
    assert [image_label.image for image_label in across_result.watcher.image_labels] == files
    assert len(across_result.watcher.in_force) == len(files)


@pytest.fixture(scope="module")
def by_set(across_run, classifier):
    """The same run with the parameters of SET."""
    return run_odometry(across_run, model=classifier, parameters=SET, terrain="gravel")


def test_a_change_of_terrain_brings_its_parameters(by_set):
    """A straight drive says nothing of the ICRs, so the filter holds those of the set."""
    (_, boards), (_, gravel) = spans(by_set)
    assert (boards, gravel) == ("boards", "gravel")
    whole = [estimate for estimate in by_set.replay.estimates if estimate.crossing is None]
    assert {estimate.terrain for estimate in whole} == {"gravel", "boards"}
    for estimate in whole:
        values = SET.terrains[estimate.terrain].values
        assert estimate.mean[5] == pytest.approx(values["x_icr"], abs=1e-6)
        assert estimate.mean[3] - estimate.mean[4] == pytest.approx(
            values["y_left"] - values["y_right"], abs=0.02
        )


def test_astride_an_edge_the_icrs_lie_between_those_of_the_terrains(by_set):
    x_icrs = [SET.terrains[name].values["x_icr"] for name in ("gravel", "boards")]
    astride = [estimate for estimate in by_set.replay.estimates if estimate.crossing is not None]
    assert len(astride) > 2
    for estimate in astride:
        assert min(x_icrs) < estimate.mean[5] < max(x_icrs)
        assert sum(estimate.crossing.shares.values()) == pytest.approx(1.0)


def test_per_tread_sees_a_robot_astride_an_edge(astride_run, classifier):
    per_tread = Config(region=RegionConfig(per_tread=True))
    result = run_odometry(astride_run, model=classifier, terrain="gravel", config=per_tread)
    seen = [(s.label, s.left, s.right) for s in result.watcher.image_labels]
    assert len(seen) > 5
    assert seen.count(("unknown", "gravel", "boards")) >= 0.9 * len(seen)
    assert set(result.replay.terrains) == {"gravel"}


def test_without_vision_one_terrain_stays_and_no_model_is_opened(across_run):
    result = run_odometry(across_run, model="no such model", vision=False, terrain="mud")
    assert set(result.replay.terrains) == {"mud"}
    assert result.watcher is None


def test_without_a_model_one_terrain_stays(across_run):
    result = run_odometry(across_run)
    assert set(result.replay.terrains) == {result.initial_terrain}
    assert result.watcher is None


def test_a_run_and_a_model_may_be_given_as_objects_or_paths(astride_run, model_file, classifier):
    expected = run_odometry(astride_run, model=classifier, terrain="gravel")
    labels = [
        (s.label, s.confidence) for s in expected.watcher.image_labels if s.region is not None
    ]
    assert len(labels) > 5
    for run, model in ((Run.read(astride_run), model_file), (str(astride_run), str(model_file))):
        result = run_odometry(run, model=model, terrain="gravel")
        np.testing.assert_array_equal(result.replay.means, expected.replay.means)
        seen = [
            (s.label, s.confidence) for s in result.watcher.image_labels if s.region is not None
        ]
        assert seen == labels


def test_what_there_is_to_judge_by_decides_what_is_judged(tmp_path, world, curvy_run):
    """The filter used pose.csv, so only truth.csv or poses withheld from it may evaluate it."""
    by_pose = run_odometry(curvy_run)
    assert by_pose.reference_name == "pose"
    assert set(by_pose.scores) == {"odometer", "differential_drive", "estimate"}
    assert by_pose.evaluated["estimate"].against == "withheld pose"
    by_truth = run_odometry(world.drive_curves(tmp_path / "truth", truth=True))
    assert by_truth.reference_name == "truth"
    assert set(by_truth.scores) == {"odometer", "differential_drive", "estimate"}
    by_nothing = run_odometry(world.drive_curves(tmp_path / "nothing", pose=False))
    assert (by_nothing.reference_name, by_nothing.reference) == ("", None)
    assert by_nothing.scores == {}


def with_gyroscope(folder, bias=0.0):
    """The winding drive with the yaw rate that its ICRs give it, and a bias."""
    header, *rows = (folder / "odometry.csv").read_text().split()
    lines = [f"{header},gyro_z"]
    for row in rows:
        _, left, right = (float(cell) for cell in row.split(","))
        lines.append(f"{row},{(right - left) / (0.26 + 0.24) + bias:.9g}")
    (folder / "odometry.csv").write_text("\n".join(lines) + "\n")
    return folder


def test_a_gyroscope_adds_its_rows_and_they_stand_side_by_side(tmp_path, world):
    result = run_odometry(with_gyroscope(world.drive_curves(tmp_path / "run", truth=True)))
    assert list(result.scores) == [
        "differential_drive",
        "gyroscope",
        "odometer_without_gyroscope",
        "odometer",
        "estimate",
    ]
    truth = result.run.truth.stack("x", "y", "yaw")
    by_gyroscope = result.evaluated["gyroscope"].trajectory.poses
    turned = np.exp(1j * by_gyroscope[:, 2])  # held from row to row, where it is interpolated
    np.testing.assert_allclose(turned, np.exp(1j * truth[:, 2]), atol=0.06)
    # mean wheel speed does not depend on x_icr nor of the middle between the treads' ICRs
    assert result.scores["gyroscope"].final_position_m > 0.02
    assert (
        result.scores["odometer"].final_position_m
        < result.scores["differential_drive"].final_position_m
    )


def test_a_filter_that_may_not_use_the_gyroscope_has_one_odometer(tmp_path, world):
    folder = with_gyroscope(world.drive_curves(tmp_path / "run", truth=True))
    config = Config(filter=IcrEkfConfig(use_gyroscope=False))
    result = run_odometry(folder, config=config)
    assert list(result.scores) == ["differential_drive", "gyroscope", "odometer", "estimate"]


def test_the_second_replay_sees_the_withheld_poses_no_more_than_the_first_saw_a_truth(
    across_result,
):
    """Its terrains are those of the first, and no image is looked at for it."""
    result = across_result
    assert result.second.replay.terrains == result.replay.terrains
    assert len(result.watcher.image_labels) == len(result.run.images)
    kept = np.isfinite(result.second.withheld.run.pose["x"])
    assert kept.sum() + result.second.withheld.poses == len(result.run.pose)
    assert result.run.pose["x"][~kept] == pytest.approx(world_x(result, ~kept))


def world_x(result, rows):
    """The run itself keeps its poses."""
    return 0.5 * result.run.pose.stamps_s[rows]


def test_truth_is_for_scoring_alone(tmp_path, world):
    """With and without truth.csv the estimates are the same."""
    plain = run_odometry(world.drive_curves(tmp_path / "plain"))
    told = run_odometry(world.drive_curves(tmp_path / "told", truth=True))
    np.testing.assert_array_equal(plain.replay.means, told.replay.means)


def test_the_filter_finds_the_icrs_of_the_drive_and_the_next_run_starts_there(tmp_path, curvy_run):
    """The drive was made with y_left 0.26, y_right -0.24, x_icr 0.03."""
    first = run_odometry(curvy_run, terrain="sand")
    learned = first.learned.terrains["sand"].values
    found = [learned[name] for name in ("y_left", "y_right", "x_icr")]
    np.testing.assert_allclose(found, [0.26, -0.24, 0.03], atol=0.02)
    write_parameters(tmp_path / "set.toml", first.learned)
    second = run_odometry(curvy_run, parameters=tmp_path / "set.toml")
    assert second.initial_terrain == "sand"
    np.testing.assert_allclose(second.replay.means[0, 3:6], found, atol=1e-12)
    belief = first.replay.estimates[-1].covariance[3:6, 3:6]
    np.testing.assert_allclose(second.replay.estimates[0].covariance[3:6, 3:6], belief, atol=1e-12)


def test_terrains_not_visited_keep_their_tables(curvy_run):
    result = run_odometry(curvy_run, parameters=SET, terrain="sand")
    assert list(result.learned.terrains) == ["boards", "gravel", "sand"]
    assert result.learned.terrains["boards"] == SET.terrains["boards"]


def test_poses_of_an_antenna_are_compared_with_the_antenna(tmp_path, world):
    """The same drive, its poses of the robot, or of a place 0.4 m ahead and 0.2 m left of it."""
    plain = world.drive_curves(tmp_path / "plain")
    moved = world.drive_curves(tmp_path / "moved")
    world.write_toml(moved / "run.toml", robot=world.robot, sensors={"pose": [0.4, 0.2, 1.0]})
    header, *rows = (plain / "pose.csv").read_text().split()
    lines = [header]
    for row in rows:
        t, x, y, yaw = (float(cell) for cell in row.split(","))
        place = complex(x, y) + complex(0.4, 0.2) * np.exp(1j * yaw)
        lines.append(f"{t},{place.real:.12f},{place.imag:.12f},{yaw:.12f}")
    (moved / "pose.csv").write_text("\n".join(lines) + "\n")
    of_robot, of_antenna = run_odometry(plain), run_odometry(moved)
    for name, score in of_robot.scores.items():
        found = of_antenna.scores[name].final_position_m
        assert found == pytest.approx(score.final_position_m, abs=0.05), name
    assert of_antenna.off_at_the_end_m["estimate"] < 0.05
    without_yaw = [",".join([*line.split(",")[:3], ""]) for line in lines[1:]]
    (moved / "pose.csv").write_text("\n".join([header, *without_yaw]) + "\n")
    of_positions = run_odometry(moved)
    assert of_positions.off_at_the_end_m["estimate"] < 0.05
    end = of_robot.replay.means[-1, :2] - of_positions.replay.means[-1, :2]
    assert np.hypot(*end) < 0.1
