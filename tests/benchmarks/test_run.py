"""The main job with vision on the demo, beside reading its images."""

import cv2
import pytest

import odometry
import terrain
from odometry.installed import shipped_data
from terrain.one_thread import one_thread


@pytest.fixture(autouse=True)
def _alone():
    with one_thread():
        yield


@pytest.fixture(scope="module")
def run():
    return odometry.Run.read(shipped_data() / "runs/demo")


@pytest.mark.benchmark(group="the demo with vision")
@pytest.mark.parametrize("preset", ["default", "fast", "chen2023"])
def test_run(benchmark, run, preset):
    model = terrain.train(shipped_data() / "patches", preset=preset).classifier
    of_run = {"preset": preset} if preset == "chen2023" else {}
    settings = {"model": model} | of_run
    result = benchmark.pedantic(terrain.run_odometry, (run,), settings, rounds=5, warmup_rounds=1)
    assert len(result.watcher.image_labels) == len(list((run.folder / "images").iterdir()))


@pytest.mark.benchmark(group="the demo with vision")
def test_decoding(benchmark, run):
    files = sorted((run.folder / "images").iterdir())
    images = benchmark.pedantic(
        lambda: [terrain.read_image(file) for file in files], rounds=15, warmup_rounds=1
    )
    assert cv2.getNumThreads() == 1
    assert len(images) == len(files)
