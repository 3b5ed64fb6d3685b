"""One frame of the live main job, beside the parts that nobody can leave out."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import odometry
import terrain
from odometry.recording.frames import Frame

DATA = Path(__file__).parents[2] / "data"
ROUNDS, IMAGES = 1000, 30


@pytest.fixture(scope="module")
def run():
    return odometry.Run.read(DATA / "runs/demo")


@pytest.fixture(scope="module")
def classifier():
    return terrain.train(DATA / "patches").classifier


@pytest.fixture
def live(run, classifier):
    camera = terrain.Camera.from_table(run.settings["camera"])
    return terrain.LiveOdometry(run.robot, camera=camera, model=classifier)


def of_images(live, frames):
    """Frames with an image, one by one; live takes those between them unmeasured."""
    for frame in frames:
        if frame.image is None:
            live.step(frame)
        else:
            yield replace(frame, image=terrain.decode_image(frame.image.read_bytes()))


@pytest.mark.benchmark(group="one live frame without an image")
def test_a_live_frame(benchmark, run, live):
    frames = (replace(frame, image=None) for frame in run.frames())
    benchmark.pedantic(live.step, setup=lambda: ((next(frames),), {}), rounds=ROUNDS)


@pytest.mark.benchmark(group="one live frame without an image")
def test_the_step_of_its_filter(benchmark, run):
    frames = run.frames()
    ekf = odometry.IcrEkf(run.robot.track_width)
    latest = ekf.start(next(frames), "a")

    def step(frame: Frame) -> None:
        nonlocal latest
        latest = ekf.step(latest, frame, "a")

    benchmark.pedantic(step, setup=lambda: ((next(frames),), {}), rounds=ROUNDS)


@pytest.mark.benchmark(group="one live frame with an image")
def test_a_live_frame_with_an_image(benchmark, run, live):
    frames = of_images(live, run.frames())
    for _ in range(5):
        live.step(next(frames))  # of a robot that stands
    benchmark.pedantic(live.step, setup=lambda: ((next(frames),), {}), rounds=IMAGES)


@pytest.mark.benchmark(group="one live frame with an image")
def test_the_classification_of_one_patch(benchmark, classifier):
    size_px = classifier.patch_size_px
    patch = np.random.default_rng(1).integers(0, 256, (size_px, size_px), dtype=np.uint8)
    benchmark.pedantic(classifier.classify, args=([patch],), rounds=IMAGES)
