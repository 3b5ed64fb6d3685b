"""Inputs made wrong at random are read, or refused by an error of the project: nothing else."""

import numpy as np
import pytest

from tests.fuzz.readers import fails, readers

CHANGES = 100  # tests/studies/recordings/fuzz_readers.py makes thousands
SEED = 12


@pytest.fixture(scope="module")
def all_readers(tmp_path_factory):
    return {reader.name: reader for reader in readers(tmp_path_factory.mktemp("fuzz"))}


NAMES = [
    *("odometry.csv", "pose.csv", "velocity.csv", "images.csv", "truth.csv", "imu.csv"),
    *("gnss.csv", "gnss.pos", "gnss.nmea", "run.toml"),
    *("parameter set", "velocity modes", "traction modes", "config", "camera", "vehicle", "TUM"),
    *("image, png", "image, jpg", "image, tiff", "image, bmp"),
    *("camera_info", "camchain", "camera XML", "transforms", "marks.csv"),
    *("classifier", "manifest.csv", "result.json"),
]


def test_all_readers_are_named(all_readers):
    assert list(all_readers) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_what_is_valid_is_read(all_readers, name):
    assert fails(all_readers[name], all_readers[name].valid) is None


@pytest.mark.parametrize("name", NAMES)
def test_what_is_wrong_is_read_or_refused(all_readers, name):
    reader, rng = all_readers[name], np.random.default_rng(SEED)
    errors = [fails(reader, reader.changed(reader.valid, rng)) for _ in range(CHANGES)]
    refused = [str(error) for error in errors if error is not None]
    assert refused
    assert all(refused)
