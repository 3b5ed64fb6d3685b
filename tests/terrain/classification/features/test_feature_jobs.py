"""Features shared by processes and by the workers of a cluster."""

import shutil

import cv2
import numpy as np
import pytest
from click.testing import CliRunner
from joblib.externals.loky import get_reusable_executor
from threadpoolctl import threadpool_info

from odometry.installed import shipped_data
from terrain.classification.features import feature_jobs
from terrain.classification.features.feature_jobs import (
    Transformed,
    features_of,
    shared_feature_matrix,
)
from terrain.classification.features.features import feature_matrix
from terrain.classification.features.network_features import Network, NetworkFeatures
from terrain.classification.presets import PRESETS
from terrain.cli.verbs.train import train
from terrain.errors import BatchError
from tests.terrain.classification.features.onnx_bytes import tiny_network
from tests.terrain.dask_processes import started_scheduler, started_workers

GREY = PRESETS["default"].features


@pytest.fixture
def images(rng, monkeypatch):
    """More than one process and five jobs are worth."""
    monkeypatch.setattr(feature_jobs, "WORTH_A_PROCESS", 4)
    monkeypatch.setattr(feature_jobs, "PATCHES_A_JOB", 2)
    return rng.integers(0, 256, (9, 24, 24), dtype=np.uint8)


@pytest.fixture(scope="module")
def cluster():
    """Address of a scheduler, and its two workers."""
    pytest.importorskip("distributed", reason="the extra dask is not installed")
    with started_scheduler() as scheduler, started_workers(scheduler, 2) as workers:
        yield scheduler, workers


@pytest.mark.slow
def test_processes_share_the_patches_and_give_the_same_bytes(images, monkeypatch):
    seen = []
    parallel = feature_jobs.Parallel
    monkeypatch.setattr(
        feature_jobs,
        "Parallel",
        lambda n_jobs, **of: seen.append(n_jobs) or parallel(n_jobs, **of),
    )
    monkeypatch.setattr(feature_jobs, "cpu_count", lambda: 2)
    shared = [shared_feature_matrix(images, GREY, processes=count) for count in (1, 2, 100, -1)]
    get_reusable_executor().shutdown(wait=True)
    assert seen == [1, 2, 2, 2]  # no more than are worth the while; by -1 as many as cores
    assert {one.tobytes() for one in shared} == {feature_matrix(images, GREY).tobytes()}


def test_jobs_that_end_in_another_order_keep_the_order_of_the_patches(images, monkeypatch):
    def from_the_last(parts, settings, _processes):
        return ((at, feature_matrix(some, settings)) for at, some in reversed(parts.items()))

    monkeypatch.setattr(feature_jobs, "_local", from_the_last)
    found = shared_feature_matrix(images, GREY, processes=2)
    np.testing.assert_array_equal(found, feature_matrix(images, GREY))


def test_libraries_compute_with_one_thread_each(images, monkeypatch):
    threads = []

    def watched(some, settings):
        threads.append(cv2.getNumThreads())
        threads.extend(library["num_threads"] for library in threadpool_info())
        return feature_matrix(some, settings)

    before = cv2.getNumThreads()
    cv2.setNumThreads(2)
    monkeypatch.setattr(feature_jobs, "features_of", watched)
    shared_feature_matrix(images, GREY, processes=1)
    assert cv2.getNumThreads() == 2
    cv2.setNumThreads(before)
    assert set(threads) == {1}


def test_workers_share_the_patches_though_one_is_killed(cluster, images, monkeypatch):
    scheduler, (first, _) = cluster
    monkeypatch.setattr(feature_jobs, "AHEAD", 1)  # a second job waits for an answer
    answers = feature_jobs.answers

    def and_a_kill(*of):
        for answer in answers(*of):
            first.kill()
            yield answer

    monkeypatch.setattr(feature_jobs, "answers", and_a_kill)
    far = shared_feature_matrix(images, GREY, processes=1, scheduler=scheduler)
    assert first.wait() < 0
    assert far.tobytes() == feature_matrix(images, GREY).tobytes()
    with pytest.raises(BatchError, match=r"^--scheduler tcp://\S+: \w*Error: "):
        shared_feature_matrix(["no image"] * 3, GREY, processes=1, scheduler=scheduler)


@pytest.mark.parametrize("colour", [False, True])
def test_workers_run_an_image_network(cluster, images, colour):
    shown = np.stack([images] * 3, axis=-1) if colour else images
    network = NetworkFeatures(Network("tiny.onnx", tiny_network()), layers=("r1",)).fit(shown)
    made_by = Transformed(network, colour)
    far = shared_feature_matrix(shown, made_by, processes=1, scheduler=cluster[0])
    assert far.tobytes() == features_of(shown, made_by).tobytes()


@pytest.mark.slow
def test_a_model_has_the_same_bytes_whoever_computed_it(cluster, tmp_path, monkeypatch):
    """Two processes: `tests/terrain/cli/test_train_and_classify.py`."""
    monkeypatch.setattr(feature_jobs, "WORTH_A_PROCESS", 10)
    patches = tmp_path / "patches"
    for file in (shipped_data() / "patches").glob("*/*[05].jpg"):
        (patches / file.parent.name).mkdir(parents=True, exist_ok=True)
        shutil.copy(file, patches / file.parent.name)
    models = []
    for options in (("--processes", "1"), ("--scheduler", cluster[0])):
        out = tmp_path / f"{len(models)}.model"
        words = [
            str(patches),
            *("--metres-per-pixel", "0.003", "--preset", "chen2023", "--out", str(out)),
        ]
        answer = CliRunner().invoke(train, [*words, *options], catch_exceptions=False)
        assert answer.exit_code == 0, answer.output
        models.append(out.read_bytes())
    assert models[0] == models[1]
