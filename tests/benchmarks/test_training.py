"""Features of training patches by two processes and by one."""

import time

import numpy as np

from terrain.classification.feature_jobs import shared_feature_matrix
from terrain.classification.presets import PRESETS

PATCHES = 400


def test_training_by_two_processes(benchmark):
    rng = np.random.default_rng(1)
    patches = [rng.integers(0, 256, (128, 128), dtype=np.uint8) for _ in range(PATCHES)]
    settings, alone_s = PRESETS["default"].features, []

    def alone_before_each_round():
        started = time.perf_counter()
        shared_feature_matrix(patches, settings, processes=1)
        alone_s.append(time.perf_counter() - started)
        return (patches, settings), {"processes": 2}

    found = benchmark.pedantic(shared_feature_matrix, setup=alone_before_each_round, rounds=2)
    assert len(found) == PATCHES
    benchmark.extra_info["figure"] = min(alone_s) / benchmark.stats.stats.min
