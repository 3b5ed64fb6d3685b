"""Frames that come one by one give the bytes of a run with `[filter] causal`."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.errors import ConfigError, EstimationError, ParameterError
from odometry.estimation.config import IcrEkfConfig
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.frames import Frame
from odometry.recording.run import Robot, Run
from odometry.replays.estimates import Replay
from terrain.camera.camera import Camera
from terrain.config import Config
from terrain.images import decode_image
from terrain.live.live_odometry import LiveOdometry
from terrain.main_job import run_odometry
from terrain.results import write_results

CAUSAL = Config(filter=IcrEkfConfig(causal=True))
SET = ParameterSet(
    {
        "boards": TerrainParameters("icr", {"y_left": 0.21, "y_right": -0.19, "x_icr": 0.01}),
        "gravel": TerrainParameters("icr", {"y_left": 0.31, "y_right": -0.27, "x_icr": -0.02}),
    }
)


def fed(run, **settings):
    """Steps of the frames of a run, fed one by one to the end of its odometry."""
    live = LiveOdometry(run.robot, at_pose=run.pose is not None, **settings)
    steps = []
    for frame in run.frames():
        steps.append(live.step(frame))
        if steps[-1] is not None and np.isnan(frame.tread_speeds_m_s).any():
            break
    return [step for step in steps if step is not None]


def written(result, folder):
    write_results(result, folder)
    names = ("odometer.csv", "estimate.csv", "terrain.csv")
    return {name: (folder / name).read_bytes() for name in names if (folder / name).exists()}


def with_steps(result, steps):
    """A result whose estimates, image labels and switches are those of live steps."""
    seen = [step for step in steps if step.image_label is not None]
    folder = result.run.folder
    image_labels = [
        replace(s.image_label, image=Path(s.image_label.image).relative_to(folder).as_posix())
        for s in seen
    ]
    watcher = SimpleNamespace(
        classifier=result.watcher.classifier if result.watcher else None,
        image_labels=image_labels,
        in_force=[step.terrain for step in seen],
        events=[step.switch for step in steps if step.switch is not None],
        seen=result.watcher.seen if result.watcher else SimpleNamespace(likeness=None),
    )
    estimates = tuple(step.estimate for step in steps)
    return replace(result, replay=Replay(estimates), watcher=watcher)


def test_frames_fed_one_by_one_give_the_bytes_of_a_run(across_run, classifier, tmp_path):
    run = Run.read(across_run)
    steps = fed(
        run,
        camera=Camera.from_table(run.settings["camera"]),
        model=classifier,
        parameters=SET,
        terrain="gravel",
    )
    result = run_odometry(run, model=classifier, parameters=SET, terrain="gravel", config=CAUSAL)
    expected = written(result, tmp_path / "run")
    assert set(expected) == {"odometer.csv", "estimate.csv", "terrain.csv"}
    assert [step.switch.terrain for step in steps if step.switch] == ["boards", "gravel"]
    assert written(with_steps(result, steps), tmp_path / "live") == expected
    poses = np.array([step.odometer for step in steps])
    np.testing.assert_array_equal(poses, result.replay.odometer().poses)


@pytest.fixture
def hard_run(make_run, rng):
    """Poses of an antenna, late and at first without yaw; a gyroscope; odometry that is lost."""
    t = np.arange(0.0, 24.0, 0.05)
    left, right = 0.5 + 0.2 * np.sin(t / 2), 0.5 - 0.2 * np.sin(t / 2)
    omega = (right - left) / 0.6
    yaw = np.concatenate([[0.0], np.cumsum(omega[:-1] * 0.05)])
    steps = 0.5 * 0.05 * np.stack([np.cos(yaw), np.sin(yaw)])
    x, y = np.concatenate([np.zeros((2, 1)), np.cumsum(steps[:, :-1], axis=1)], axis=1)
    kept = (t < 12.0) | (t > 14.5)
    odometry = np.column_stack([t, left, right])[kept]
    imu = np.column_stack([t + 0.01, omega + 0.01 + 0.002 * rng.normal(size=len(t))])
    pose = np.column_stack([t + 0.3, x + 0.4 * np.cos(yaw), y + 0.4 * np.sin(yaw), yaw])[3::4]
    rows = {
        "odometry": ("t,v_left,v_right", odometry),
        "imu": ("t,gyro_z", imu),
        "pose": ("t,x,y,yaw", pose),
    }
    files = {
        name: f"{header}\n" + "".join(",".join(map(repr, row)) + "\n" for row in of.tolist())
        for name, (header, of) in rows.items()
    }
    lines = files["pose"].splitlines()
    lines[1:4] = [line.rsplit(",", 1)[0] + "," for line in lines[1:4]]
    settings = "[robot]\ntrack_width = 0.5\n[sensors]\npose = [0.4, 0.0, 0.3]\n"
    folder = make_run(settings, files["odometry"], imu=files["imu"], pose="\n".join(lines) + "\n")
    return Run.read(folder)


def test_a_hard_run_is_the_same_live_and_only_with_the_causal_setting(hard_run, tmp_path):
    steps = fed(hard_run, lever_m=(0.4, 0.0))
    result = run_odometry(hard_run, config=CAUSAL)
    expected = written(result, tmp_path / "run")
    live = with_steps(result, steps)
    assert written(replace(live, watcher=None), tmp_path / "live") == expected
    poses = np.array([step.odometer for step in steps])
    np.testing.assert_array_equal(poses, result.replay.odometer().poses)
    twists = np.array([step.twist for step in steps])
    assert not twists[0].any()
    np.testing.assert_array_equal(twists[1:], result.replay.odometer_twists()[:-1])
    kinds = {event.kind for step in steps for event in step.estimate.events}
    assert {"initial_yaw", "odometry_gap"} <= kinds
    knowing = written(run_odometry(hard_run), tmp_path / "knowing")
    assert knowing["estimate.csv"] != expected["estimate.csv"]
    assert knowing["odometer.csv"] != expected["odometer.csv"]


def test_the_covariance_of_the_odometer_without_poses_is_that_of_a_whole_run(hard_run):
    """Over turns, lost odometry and a bias that is learned.

    A run adds errors up in the middle of each step, live has the exact derivative: they differ
    in the step of 2.5 s without odometry.
    """
    bare = replace(hard_run, pose=None)
    for run in (bare, replace(bare, imu=None)):
        steps = fed(run, parameters=SET, terrain="boards")
        settings = {"parameters": SET, "terrain": "boards"}
        expected = run_odometry(run, config=CAUSAL, **settings).uncertainty.covariances
        found = np.array([step.odometer_covariance for step in steps])
        sizes = np.sqrt(np.einsum("nii,njj->nij", expected, expected))
        off = np.abs(found - expected) / sizes
        after_gap = np.array([step.estimate.stamp_s > 12.0 for step in steps])
        assert off[~after_gap].max() < 1e-4
        assert off[after_gap].max() < 0.03


def test_nothing_starts_before_speeds_are_known_and_a_pose_where_one_is_wanted():
    unknown, known = np.full(2, np.nan), np.array([0.5, 0.5])
    pose = np.array([3.0, 4.0, 0.1])
    frames = [
        Frame(0.0, unknown, -1, None, None),
        Frame(0.1, known, 0, None, None),
        Frame(0.2, known, 1, pose, None),
    ]
    anywhere, at_pose = LiveOdometry(Robot(0.5)), LiveOdometry(Robot(0.5), at_pose=True)
    assert [anywhere.step(frame) is None for frame in frames] == [True, False, False]
    assert [at_pose.step(frame) is None for frame in frames] == [True, True, False]
    odometer = at_pose.step(Frame(0.2, known, 1, None, None)).odometer
    np.testing.assert_allclose(odometer, pose, rtol=1e-12)


def test_memory_does_not_grow_with_the_frames(across_run, classifier):
    run = Run.read(across_run)
    camera = Camera.from_table(run.settings["camera"])
    live = LiveOdometry(run.robot, camera=camera, model=classifier)
    seen = 0
    for frame in run.frames():
        step = live.step(frame)
        seen += step.image_label is not None
        watcher = live._watcher
        assert max(map(len, (watcher.image_labels, watcher.in_force, watcher.events))) <= 1
    assert seen > 15


def test_pixels_are_read_as_a_file_is(across_run, classifier):
    run = Run.read(across_run)
    camera = Camera.from_table(run.settings["camera"])
    of_files = fed(run, camera=camera, model=classifier)
    live = LiveOdometry(run.robot, camera=camera, model=classifier, at_pose=True)
    frames = [
        frame
        if frame.image is None
        else replace(frame, image=decode_image(frame.image.read_bytes()))
        for frame in run.frames()
    ]
    of_pixels = [step for frame in frames if (step := live.step(frame)) is not None]
    said = [
        [(s.image_label.label, s.image_label.confidence) for s in steps if s.image_label]
        for steps in (of_files, of_pixels)
    ]
    assert said[0] == said[1]
    assert len(said[0]) > 15
    assert {step.image_label.image for step in of_pixels if step.image_label} == {""}


def test_a_frame_out_of_order_is_refused_and_changes_nothing(across_run, classifier):
    run = Run.read(across_run)
    camera = Camera.from_table(run.settings["camera"])
    expected = fed(run, camera=camera, model=classifier)[-1]
    live = LiveOdometry(run.robot, camera=camera, model=classifier, at_pose=True)
    frames = list(run.frames())
    for number, frame in enumerate(frames):
        step = live.step(frame)
        for odd in (replace(frame, stamp_s=frame.stamp_s - 1.0), replace(frame, stamp_s=np.nan)):
            if number % 10 == 9:
                with pytest.raises(EstimationError, match="expected frames in order of time"):
                    live.step(odd)
    np.testing.assert_array_equal(step.estimate.mean, expected.estimate.mean)
    np.testing.assert_array_equal(step.odometer, expected.odometer)
    assert step.terrain == expected.terrain


def test_what_is_requested_in_vain_is_an_error(classifier):
    with pytest.raises(ConfigError, match="no camera"):
        LiveOdometry(Robot(0.5), model=classifier)
    with pytest.raises(ParameterError, match="'unknown' is reserved"):
        LiveOdometry(Robot(0.5), terrain="unknown")
    effects = ({"name": "scale", "form": "wheel_scale", "parameters": {}},)
    table = TerrainParameters("icr", SET.terrains["boards"].values, effects=effects)
    with pytest.raises(ParameterError, match=r"\[terrain.boards\]: effects were given"):
        LiveOdometry(Robot(0.5), parameters=ParameterSet({"boards": table}))
