import pytest

from odometry.outputs.provenance import Made


@pytest.fixture
def made():
    """What a run of `run` says that made its output."""
    inputs = (("RUN", "my_run", "ab12"), ("--parameters", "set.toml", "cd34"))
    return Made("run", "terrain-odometry run my_run", {"vision": [True]}, inputs, {"numpy": "2.4"})
