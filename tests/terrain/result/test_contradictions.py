"""Where camera, feel and motion differ for long, and what is unknown to all of them."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.feel.identify_feel import identify_feel
from odometry.feel.labels.follow import follow_feel
from odometry.parameters import ParameterSet, read_parameters
from odometry.recording.run import UNKNOWN, Run
from odometry.replays.terrain_sources import NamedTerrain
from odometry.tables.table import Table
from odometry.trajectory import Trajectory
from terrain.image_labels.image_label import ImageLabel
from terrain.main_job import run_odometry
from terrain.region.region import Rectangle, Region
from terrain.report.page import write_report
from terrain.result.contradictions import Beneath, contradictions, labels_beneath, moments_of
from terrain.result.contradictions_so_far import LASTS_S
from terrain.result.new_terrain import contradiction_lines, new_name
from terrain.results import write_results
from tests.odometry.feel.feel_drives import drive, drives, model_of_three
from tests.terrain.switch.test_feel_labels import joined


@pytest.fixture(scope="module")
def model():
    return model_of_three()


@pytest.fixture(scope="module")
def felt(model):
    return follow_feel(drive("snow", 80), model)


def beneath(felt, name, from_s=-np.inf, to_s=np.inf):
    """A camera that says snow, but something else within a span."""
    moments_s = moments_of(felt)
    inside = (moments_s >= from_s) & (moments_s <= to_s)
    return Beneath(np.where(inside, name, "snow"), np.full(len(moments_s), 0.8))


def test_sources_that_agree_are_not_mentioned(felt):
    assert contradictions(felt) == ()
    assert contradictions(felt, beneath(felt, "snow")) == ()
    assert contradictions(felt, beneath(felt, UNKNOWN)) == ()
    motion = NamedTerrain("", np.array([0.0]), np.array(["snow"], dtype=object))
    assert contradictions(felt, None, motion) == ()


def test_what_lasts_is_reported_and_what_does_not_is_not(felt):
    (one,) = contradictions(felt, beneath(felt, "tiles", 10.0, 18.0))
    assert (one.camera, one.feel, one.motion) == ("tiles", "snow", "")
    assert one.camera_probability == pytest.approx(0.8)
    assert one.feel_probability > 0.6
    assert one.begin_s == pytest.approx(10.0, abs=1.0)
    assert one.end_s == pytest.approx(18.0, abs=1.0)
    assert contradictions(felt, beneath(felt, "tiles", 10.0, 10.0 + LASTS_S - 1.5)) == ()


def test_motion_is_heard_as_well(felt):
    motion = NamedTerrain("", np.array([15.0]), np.array(["gravel"], dtype=object))
    (one,) = contradictions(felt, None, motion)
    assert one.motion == "gravel"
    assert one.begin_s >= 14.9


def test_what_neither_knows_is_new(model):
    never = follow_feel(drive("grates", 81), model)
    found = contradictions(never, beneath(never, UNKNOWN))
    known = [one for one in contradictions(never, beneath(never, "tiles")) if one.is_new]
    assert all(one.is_new for one in found)
    assert sum(one.end_s - one.begin_s for one in found) > 20.0
    assert not known


def test_the_camera_speaks_of_the_places_that_the_robot_comes_to(felt):
    """A straight drive at 1 m/s; every image shows what lies 2 m ahead."""
    stamps_s = np.arange(0.0, 31.0, 0.5)
    way = Trajectory(stamps_s, np.column_stack([stamps_s, 0 * stamps_s, 0 * stamps_s]))
    region = Region((Rectangle(1.7, 2.3, -0.3, 0.3),), 2.0, 2.0, np.array([2.0, 0.0, 0.0]))
    sightings = [
        ImageLabel(float(t), "", "tiles" if t + 2.0 >= 15.0 else "snow", 0.7, region)
        for t in stamps_s
    ]
    below = labels_beneath(felt, sightings, way, 0.4)
    moments_s = moments_of(felt)
    late = moments_s >= 15.5
    early = (moments_s >= 2.5) & (moments_s < 14.5)
    assert set(below.names[late]) == {"tiles"}
    assert set(below.names[early]) == {"snow"}
    assert not any(below.names[moments_s < 1.4])
    np.testing.assert_allclose(below.probabilities[late], 0.7)


def test_a_name_is_new():
    assert new_name(("grass", UNKNOWN)) == "unknown 1"
    assert new_name(("unknown 1", "unknown 2")) == "unknown 3"


def with_poses(run):
    """The run with poses of a robot whose tread ICRs lie 1.4 times as far apart as its treads."""
    t = run.odometry.stamps_s
    left, right = run.odometry.stack("v_left", "v_right").T
    yaw_rate, speed = (right - left) / (1.4 * run.robot.track_width), (left + right) / 2
    step_s = np.diff(t, prepend=t[0])
    yaw = np.cumsum(np.append(0.0, yaw_rate[:-1]) * step_s)
    x = np.cumsum(np.append(0.0, speed[:-1]) * np.cos(yaw) * step_s)
    y = np.cumsum(np.append(0.0, speed[:-1]) * np.sin(yaw) * step_s)
    columns = {"t": t, "x": x, "y": y, "yaw": yaw}
    pose = Table(run.folder / "pose.csv", columns, np.arange(2, 2 + len(t)))
    gyro = np.interp(run.imu.stamps_s, t, yaw_rate)
    imu = replace(run.imu, columns={**run.imu.columns, "gyro_z": gyro})
    return Run(run.folder, run.robot, run.settings, run.odometry, imu=imu, pose=pose)


@pytest.mark.slow
def test_icrs_of_a_new_terrain_are_learned_apart_and_all_is_written(tmp_path):
    def without_yaw_rate(run):
        columns = {name: of for name, of in run.imu.columns.items() if name != "gyro_z"}
        return replace(run, imu=replace(run.imu, columns=columns))

    training = drives(["tiles", "gravel", "snow"], count=3, turning=0.3)
    model = identify_feel([without_yaw_rate(run) for run in training])
    run, begin_s = joined(
        drive("snow", 82, turning=0.3), drive("grates", 83, turning=0.3, seconds=40.0)
    )
    run = with_poses(run)
    result = run_odometry(run, feel=model, terrain="snow")
    assert all(one.begin_s > begin_s - 3.0 for one in result.contradictions if one.is_new)
    assert "unknown 1" in result.learned.terrains
    assert "unknown 1" not in result.replay.terrains
    icrs = result.learned.terrains["unknown 1"].values
    assert icrs["y_left"] - icrs["y_right"] == pytest.approx(1.4 * 0.5, rel=0.1)
    (line,) = contradiction_lines(result)
    assert "unknown 1; its ICRs are in learned.toml" in line
    assert "--span" in line
    write_results(result, tmp_path)
    write_report(result, tmp_path)
    assert "unknown 1" in read_parameters(tmp_path / "learned.toml").terrains
    assert (
        (tmp_path / "contradictions.csv")
        .read_text()
        .startswith("t,until,camera,camera_probability,feel,feel_probability,motion")
    )
    assert "Where the sources differ" in (tmp_path / "report.html").read_text()
    plain = run_odometry(run, parameters=ParameterSet(), vision=False, terrain="snow")
    write_results(plain, tmp_path)
    assert not (tmp_path / "contradictions.csv").exists()
