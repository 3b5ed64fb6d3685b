"""Feel in the live main job against `run` with `[filter] causal`: the same answers and bytes."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.errors import ConfigError, RunFolderError
from odometry.estimation.config import IcrEkfConfig
from odometry.feel.identify_feel import identify_feel
from odometry.feel.labels.live_run import follow_feel_live
from odometry.parameters import ParameterSet
from odometry.recording.run import UNKNOWN, Robot, Run
from odometry.replays.pipeline import ConstantTerrain
from odometry.tables.table import Table
from terrain.camera.camera import Camera
from terrain.classification.classifier import TerrainClassifier
from terrain.config import Config
from terrain.live.live_odometry import LiveOdometry
from terrain.main_job import run_odometry
from terrain.switch.switch import SwitchConfig
from tests.odometry.feel.feel_drives import drive, drives, with_imu
from tests.terrain.conftest import METRES_PER_PIXEL
from tests.terrain.sources.test_sources import table_of
from tests.terrain.switch.test_feel_labels import joined

CAUSAL = Config(filter=IcrEkfConfig(causal=True))
TOLERANCE = {"rtol": 1e-12, "atol": 1e-13}


STRAIGHT = {"turning": 0.0}
BOARDS = {"run": {"terrain": "boards"}, **STRAIGHT}  # which shake like snow


@pytest.fixture(scope="module")
def model():
    boards = [drive("snow", 200 + seed, **BOARDS) for seed in range(3)]
    return identify_feel([*boards, *drives(["tiles", "gravel"], count=3, **STRAIGHT)])


def fed(run, note="", **settings):
    """Steps of frames, each with the rows of the IMU and of currents up to its stamp before it."""
    live = LiveOdometry(run.robot, at_pose=run.pose is not None, **settings)
    steps, row = [], 0
    currents = run.odometry.stack("current_left", "current_right")
    for frame in run.frames():
        while row < len(run.imu) and run.imu.stamps_s[row] <= frame.stamp_s:
            gyro, accel = (
                [run.imu[f"{kind}_{axis}"][row] for axis in "xyz"] for kind in ("gyro", "accel")
            )
            live.imu(run.imu.stamps_s[row], gyro=gyro, accel=accel)
            row += 1
        if frame.odometry_row >= 0:
            stamp_s = run.odometry.stamps_s[frame.odometry_row]
            live.currents(stamp_s, *currents[frame.odometry_row])
        steps.append(live.step(frame))
        if steps[-1] is not None and np.isnan(frame.tread_speeds_m_s).any():
            break
    assert note in live.feel_note if note else not live.feel_note
    return [step for step in steps if step is not None]


def assert_same(steps, run, result, model):
    """Estimates to the last bit; an answer by feel at the frame from which it is known."""
    means = np.array([step.estimate.mean for step in steps])
    assert means.tobytes() == result.replay.means.tobytes()
    assert [step.terrain for step in steps] == list(result.replay.terrains)
    felt = follow_feel_live(run, model)
    answers = [step.felt for step in steps if step.felt is not None]
    stamps_s = np.array([answer.stamp_s for answer in answers])
    rows = np.searchsorted(felt.stamps_s, stamps_s - 1e-9)
    np.testing.assert_allclose(felt.stamps_s[rows], stamps_s, **TOLERANCE)
    assert len(rows) > 0.8 * len(felt.windows)
    given = np.array([list(answer.probabilities.values()) for answer in answers])
    np.testing.assert_allclose(given, felt.lasting_probabilities[rows], **TOLERANCE)
    assert [answer.label for answer in answers] == felt.lasting_answers[rows].tolist()


def told(contradictions):
    return [(one.begin_s, one.end_s, one.camera, one.feel) for one in contradictions]


def of_steps(steps):
    """Each contradiction when it was longest."""
    found = {}
    for step in steps:
        one = step.contradiction
        if one is not None:
            found[one.begin_s, one.camera, one.feel] = one
    return list(found.values())


@pytest.mark.slow
def test_feel_alone_is_the_source_of_run_and_what_it_never_felt_contradicts(model):
    run, _ = joined(drive("gravel", 60, **STRAIGHT), drive("grates", 61, **STRAIGHT))
    steps = fed(run, feel=model, terrain="boards")
    result = run_odometry(run, feel=model, terrain="boards", config=CAUSAL)
    assert_same(steps, run, result, model)
    assert {step.terrain for step in steps} == {"boards", "gravel"}
    assert told(of_steps(steps)) == told(result.contradictions)
    assert any(one.is_new for one in result.contradictions)


@pytest.mark.slow
def test_feel_alone_that_nobody_named_begins_as_unknown(model):
    """The first table of the set is another terrain."""
    run, _ = joined(drive("gravel", 60, **STRAIGHT), drive("snow", 61, **STRAIGHT))
    tar = ParameterSet({"tar": table_of(0.8)})
    for parameters in (None, tar):
        steps = fed(run, feel=model, parameters=parameters)
        result = run_odometry(run, feel=model, parameters=parameters, config=CAUSAL)
        assert_same(steps, run, result, model)
        assert (result.initial_terrain, steps[0].terrain) == (UNKNOWN, UNKNOWN)
        assert [change.terrain for change in result.changes] == ["gravel", "boards"]


def shaken(run, seed):
    """A run with images that shakes like boards in its first part, then like gravel."""
    odometry = run.odometry
    t = odometry.stamps_s
    half_s = float(t[0] + t[-1]) / 2
    parts = [
        drive(name, seed, seconds=float(t[-1] - t[0]) + 1.0, **STRAIGHT)
        for name in ("snow", "gravel")
    ]
    at = parts[0].imu.stamps_s + t[0]
    columns = {
        name: np.where(at < half_s, *(part.imu[name] for part in parts))
        for name in parts[0].imu.columns
    }
    columns["t"] = at
    amperes = {
        name: np.interp(t, parts[0].odometry.stamps_s + t[0], parts[0].odometry[name])
        for name in ("current_left", "current_right")
    }
    odometry = replace(odometry, columns={**odometry.columns, **amperes})
    imu = Table(Path("made/imu.csv"), columns, np.arange(2, 2 + len(at)))
    return replace(run, odometry=odometry, imu=imu)


def test_camera_and_feel_are_weighed_as_in_run_with_the_same_contradictions(
    model, across_run, training_patches
):
    """By the plain classifier of Chen 2023: where the camera is sure, feel changes nothing."""
    classifier = TerrainClassifier(preset="chen2023", metres_per_pixel=METRES_PER_PIXEL)
    classifier.fit(*training_patches)
    run = shaken(Run.read(across_run), 70)
    wide = replace(model, track_width_m=run.robot.track_width)
    camera = Camera.from_table(run.settings["camera"])
    settings = {"model": classifier, "feel": wide, "terrain": "gravel"}
    steps = fed(run, camera=camera, **settings)
    result = run_odometry(run, config=CAUSAL, **settings)
    assert_same(steps, run, result, wide)
    by_camera = run_odometry(run, model=classifier, terrain="gravel", config=CAUSAL)
    assert list(by_camera.replay.terrains) != list(result.replay.terrains)  # feel weighs in
    assert told(of_steps(steps)) == told(result.contradictions)


def test_what_cannot_be_felt_is_noted_and_the_odometry_goes_on(model):
    def in_g(columns):
        scaled = {name: of / 9.81 for name, of in columns.items() if name.startswith("accel")}
        return {**columns, **scaled}

    run = with_imu(drive("gravel", 71), in_g)
    steps = fed(run, "in g or mg", feel=model, terrain="boards")
    assert {step.terrain for step in steps} == {"boards"}
    assert not any(step.felt for step in steps)


def test_feel_that_cannot_be_used_is_an_error(model, classifier, across_run):
    camera = Camera.from_table(Run.read(across_run).settings["camera"])
    with pytest.raises(RunFolderError, match="track width"):
        LiveOdometry(Robot(1.2), feel=model)
    with pytest.raises(ConfigError, match="a source of your own"):
        LiveOdometry(Robot(0.5), feel=model, source=ConstantTerrain("gravel"))
    config = replace(Config(), switch=SwitchConfig(labels_in_row=2))
    with pytest.raises(ConfigError, match="labels_in_row"):
        LiveOdometry(Robot(0.5), camera=camera, model=classifier, feel=model, config=config)
