"""Every reader before what is no file, what never ends, and what is no text."""

import os

import pytest

from odometry.errors import ConfigError, OdometryError
from odometry.io.csv_table import read_csv_table
from odometry.io.structured import read_json, read_toml
from odometry.io.tum import read_tum
from odometry.modes.models.mode_set_file import read_mode_set
from odometry.parameters import read_parameters
from odometry.recording.run import Run
from odometry.simulation.contact.vehicle import read_contact_vehicle
from terrain.classification.classifier import TerrainClassifier
from terrain.config import Config
from terrain.images import read_image
from terrain.results import read_errors
from terrain.synthesis.config import read_camera

READERS = {
    "csv": lambda file: read_csv_table(file, ("t",)),
    "toml": lambda file: read_toml(file, ConfigError),
    "json": lambda file: read_json(file, ConfigError),
    "tum": read_tum,
    "parameters": read_parameters,
    "modes": read_mode_set,
    "config": Config.read,
    "camera": read_camera,
    "vehicle": read_contact_vehicle,
    "model": TerrainClassifier.load,
    "image": read_image,
    "run.toml": lambda file: Run.read(file.parent),
    "result.json": lambda file: read_errors(file.parent),
}


def made(kind, file):
    """Something that is at the path and no regular file, or an endless one."""
    match kind:
        case "pipe":
            os.mkfifo(file)
        case "device":
            file.symlink_to("/dev/zero")
        case "folder":
            file.mkdir()
        case "endless":  # 8 GB that need no room on the disk
            with file.open("wb") as stream:
                stream.truncate(8 * 1024**3)
        case "text":
            file.write_text("what is this?\n")
        case "zeros":
            file.write_bytes(bytes(1000))
        case "empty":
            file.touch()


@pytest.mark.parametrize("kind", ["pipe", "device", "folder", "endless", "text", "zeros", "empty"])
@pytest.mark.parametrize("reader", READERS)
def test_what_cannot_be_read_is_one_line(tmp_path, reader, kind):
    file = tmp_path / (reader if reader in ("run.toml", "result.json") else f"a.{reader}")
    made(kind, file)
    if reader in ("toml", "config", "run.toml") and kind == "empty":
        pytest.skip("an empty file is TOML of no table")
    with pytest.raises(OdometryError, match=file.name) as error:
        READERS[reader](file)
    assert len(str(error.value).splitlines()) == 1
    expected = {"pipe": "a pipe", "device": "a device", "folder": "a folder", "endless": "bytes"}
    assert expected.get(kind, "") in str(error.value)
