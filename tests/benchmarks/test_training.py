"""Features of training patches by two processes and by one, in wall time whatever the timer is."""

import time

import numpy as np

from terrain.classification.features.feature_jobs import shared_feature_matrix
from terrain.classification.presets import PRESETS

PATCHES = 400


def test_training_by_two_processes(benchmark):
    rng = np.random.default_rng(1)
    patches = [rng.integers(0, 256, (128, 128), dtype=np.uint8) for _ in range(PATCHES)]
    lasted_s = {1: [], 2: []}

    def timed(processes):
        started = time.perf_counter()
        found = shared_feature_matrix(patches, PRESETS["default"].features, processes=processes)
        lasted_s[processes].append(time.perf_counter() - started)
        return found

    def alone_before_each_round():
        timed(1)
        return (2,), {}

    found = benchmark.pedantic(timed, setup=alone_before_each_round, rounds=2)
    assert len(found) == PATCHES
    benchmark.extra_info["figure"] = min(lasted_s[1]) / min(lasted_s[2])
