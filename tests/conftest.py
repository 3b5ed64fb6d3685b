import gc
import os
import sys
from pathlib import Path

import pytest

# Every core has a process already; a thread more for each only waits for the others, and a process
# more, of verbs that take all cores, loads all libraries again.
for library in ("OMP", "OPENBLAS", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")
os.environ.setdefault("LOKY_MAX_CPU_COUNT", "1")
# Also where the environment wants no compiled files: without them each of the 60 processes that
# tests start compiles the packages again, and each process of tests all assertions. Git ignores
# them. A program that sets it in its own process (`tests/studies/speed/mutants.py`) has none.
if os.environ.pop("PYTHONDONTWRITEBYTECODE", None) is not None:
    sys.dont_write_bytecode = False

import numpy as np  # noqa: E402 - it reads them
from hypothesis import HealthCheck, settings  # noqa: E402 - compiled files of it are kept

SLOW = [HealthCheck.too_slow]  # is said of a busy computer, too: three tests failed by it on one
settings.register_profile(
    "project",
    max_examples=50,  # the same ones each time
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=SLOW,
)
settings.load_profile("project")


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Seek no garbage among the tests, of which nothing goes: neither here nor in their run.

    In their run after 100,000 new objects and not 700: 1 % of the time in place of 5.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(100_000, 20, 20)
        gc.enable()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """The whole project's tests first: of the longest ones none is left for one process alone."""
    items.sort(key=lambda item: item.path.parent != Path(__file__).parent)


ODOMETRY_CSV = "t,v_left,v_right\n0,0.5,0.5\n0.1,0.4,0.6\n0.2,0.4,0.6\n"


@pytest.fixture
def rng():
    return np.random.default_rng(2023)


@pytest.fixture(scope="session")
def shared_data():
    """The folder of recordings and reference values that the project does not carry."""
    folder = os.environ.get("TERRAIN_ODOMETRY_DATA")
    if not folder:
        pytest.skip("TERRAIN_ODOMETRY_DATA is not set: it names the folder of shared recordings")
    return Path(folder)


@pytest.fixture
def make_run(tmp_path):
    """Make a run folder of literal file contents: text, or bytes as they are."""

    def make(settings="[robot]\ntrack_width = 0.4\n", odometry=ODOMETRY_CSV, **files):
        folder = tmp_path / "a_run"
        folder.mkdir(exist_ok=True)
        contents = {"run.toml": settings, "odometry.csv": odometry}
        contents |= {f"{name}.csv": content for name, content in files.items()}
        for name, content in contents.items():
            if content is not None:
                data = content if isinstance(content, bytes) else content.encode()
                (folder / name).write_bytes(data)
        return folder

    return make
