import pytest

from odometry.outputs.provenance import Asked
from terrain.batch.job import Job
from terrain.config import Config
from terrain.run_options import RunOptions

RUNS = ("a", "b", "c", "d")


@pytest.fixture
def four_runs(tmp_path, world):
    """Four short runs that differ; the folder that holds them."""
    folder = tmp_path / "runs"
    for number, name in enumerate(RUNS):
        world.drive_curves(folder / name, truth=number % 2 == 1)
    return folder


@pytest.fixture
def job_of(tmp_path):
    """A job on a run folder, into a folder of `out`."""

    def make(folder, options=None, out=tmp_path / "out"):
        asked = Asked("run", f"run {folder}", {}, (("RUN", folder),), tmp_path)
        return Job(folder.name, folder, out / folder.name, asked, options or RunOptions(Config()))

    return make
