"""How soon a command says something, and what an import costs: whole processes."""

import os
import pty
import subprocess
import sys
import time

import pytest

from odometry.installed import shipped_data

COMMAND = "from terrain.cli.main import main; main()"
DEMO = str(shipped_data() / "runs" / "demo")


def first_output_s(arguments):
    """Until the first byte on a terminal."""
    ours, theirs = pty.openpty()
    started = time.perf_counter()
    with subprocess.Popen(arguments, stdout=theirs, stderr=theirs) as process:
        assert os.read(ours, 1)
        spent_s = time.perf_counter() - started
        process.kill()
    os.close(ours)
    os.close(theirs)
    return spent_s


def bare_s():
    """Python alone."""
    started = time.perf_counter()
    subprocess.run([sys.executable, "-c", ""], check=True)
    return time.perf_counter() - started


@pytest.mark.parametrize("what", ["help", "run", "import"])
def test_a_start(benchmark, what, tmp_path):
    """What Python itself takes is left out of the import."""
    program, packages = [sys.executable, "-c", COMMAND], "import odometry, terrain; print()"
    starts = {
        "help": lambda: first_output_s([*program, "--help"]),
        "run": lambda: first_output_s([*program, "run", DEMO, "--out", str(tmp_path / "out")]),
        "import": lambda: first_output_s([sys.executable, "-c", packages]) - bare_s(),
    }
    found = []
    benchmark.pedantic(lambda: found.append(starts[what]()), rounds=7, warmup_rounds=1)
    benchmark.extra_info["figure"] = min(found[1:])
