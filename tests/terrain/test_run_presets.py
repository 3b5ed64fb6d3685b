"""The paper's own system on a run, and what contradicts it."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import ConfigError
from odometry.parameters import ParameterSet, TerrainParameters
from terrain.classification.classifier import TerrainClassifier
from terrain.cli.verbs import run as run_verb
from terrain.config import Config
from terrain.main_job import run_odometry
from terrain.run_presets import RUN_PRESETS, run_preset

SET = ParameterSet({"gravel": TerrainParameters("icr", {"y_left": 0.2, "y_right": -0.2})})
PAPER = run_preset("chen2023").config


@pytest.fixture(scope="module")
def paper(training_patches, world):
    return TerrainClassifier("chen2023", metres_per_pixel=world.metres_per_pixel).fit(
        *training_patches
    )


@pytest.fixture(scope="module")
def result(across_run, paper):
    return run_odometry(across_run, model=paper, terrain="gravel", preset="chen2023")


def test_the_look_ahead_is_one_time_for_all_images(result):
    """The robot drives straight at one speed: what fits is what our own search finds."""
    times_s = {s.region.ahead_s for s in result.watcher.image_labels if s.region is not None}
    assert times_s == {result.config.region.ahead_s}
    ours = run_odometry(
        result.run, model=result.watcher.classifier._classifier, terrain="gravel"
    ).watcher.image_labels[3]
    assert times_s.pop() == pytest.approx(ours.region.ahead_s, rel=0.05)
    assert len(result.watcher.image_labels) > 30


def test_two_labels_in_a_row_switch_at_once(result):
    labels = [image_label.label for image_label in result.watcher.image_labels]
    assert set(labels) == {"boards", "gravel"}
    for event in result.watcher.events:
        seen_s = [s.stamp_s for s in result.watcher.image_labels]
        second = labels[seen_s.index(event.first_label.stamp_s) : seen_s.index(event.stamp_s) + 1]
        assert second == [event.terrain] * 2
    assert len(result.watcher.events) >= 2


def test_the_filter_has_six_states_and_keeps_its_icrs(result):
    estimates = result.replay.estimates
    means = result.replay.means
    np.testing.assert_array_equal(means[:, 6], 0.0)  # no bias of a gyroscope
    np.testing.assert_array_equal(means[:, 7:], 1.0)  # nor slip factors
    (first, *_) = (k for k, e in enumerate(estimates) if e.terrain == "boards")
    moved = np.abs(means[first, 3:6] - means[first - 1, 3:6])
    assert moved.max() < 0.01
    sigma = result.config.filter.reset_sigma_widths * result.run.robot.track_width
    assert result.replay.sigmas[first, 3:6] == pytest.approx([sigma] * 3, rel=0.05)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"parameters": SET}, "knows no parameter sets.*gravel"),
        ({"source": "none"}, "from the camera.*'none'"),
        ({"vision": False}, "from the camera.*'none'"),
        ({"preset": "chen2024"}, "'chen2024' is not one of chen2023"),
        (
            {"config": replace(PAPER, region=replace(PAPER.region, per_tread=True))},
            r"\[region\] per_tread = False, found True",
        ),
        (
            {"config": replace(PAPER, filter=replace(PAPER.filter, detect_jumps=True))},
            r"\[filter\] detect_jumps = False, found True",
        ),
        ({"config": Config()}, r"\[filter\] .* found "),
    ],
)
def test_what_contradicts_the_preset_is_an_error(across_run, paper, given, words):
    with pytest.raises(ConfigError, match=words):
        run_odometry(across_run, **{"model": paper, "preset": "chen2023", **given})


def test_a_model_that_is_not_the_papers_is_an_error(across_run, classifier):
    with pytest.raises(ConfigError, match=r"train --preset chen2023.*'default'"):
        run_odometry(across_run, model=classifier, preset="chen2023")


def test_what_the_paper_leaves_open_may_be_set(tmp_path, across_run, paper):
    file = tmp_path / "config.toml"
    file.write_text("[region]\nahead_s = 1.5\n[filter]\nreset_sigma_widths = 0.3\n")
    config = Config.read(file, PAPER)
    assert config.filter.use_gyroscope is False  # of the preset
    result = run_odometry(across_run, model=paper, preset="chen2023", config=config)
    assert result.config.region.ahead_s == 1.5
    assert result.config.filter.reset_sigma_widths == 0.3


def test_where_no_time_fits_the_camera_that_is_said(tmp_path, world, paper):
    folder = world.drive_straight(tmp_path / "run", world.across, 0.4)
    backwards = [*world.camera["mount"][:5], np.pi]
    world.write_toml(
        folder / "run.toml", robot=world.robot, camera=world.camera | {"mount": backwards}
    )
    with pytest.raises(ConfigError, match=r"no look-ahead time t_s fits.*\[region\] ahead_s"):
        run_odometry(folder, model=paper, preset="chen2023")


def test_the_command_offers_every_preset():
    assert set(run_verb.PRESETS) == set(RUN_PRESETS)
