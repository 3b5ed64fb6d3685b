"""The pool of this machine: a process that is killed takes no other run with it."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from terrain.batch.job import FAILED, REPLAYED
from terrain.batch.local import KILLED, local_outcomes
from terrain.config import Config
from terrain.run_options import RunOptions


@pytest.mark.usefixtures("no_process_left")
def test_a_killed_process_is_one_failed_run(four_runs, job_of):
    class Deadly(RunOptions):  # made here, so that it travels to the process whole
        def replay(self, *_, **__):
            os.kill(os.getpid(), 9)

    options = {"b": Deadly(Config())}
    jobs = [job_of(four_runs / name, options.get(name)) for name in "ab"]
    found = {outcome.job.name: outcome for outcome in local_outcomes(jobs, 2)}
    assert {name: of.state for name, of in found.items()} == {"a": REPLAYED, "b": FAILED}
    assert found["b"].said == KILLED


def test_a_process_of_the_pool_ends_with_its_parent():
    """A parent that is killed can tell nobody."""
    program = """
import os, sys, time
from terrain.batch.local import _end_with
if os.fork() == 0:
    _end_with(os.getppid())
    print(os.getpid(), flush=True)
    time.sleep(60)
sys.stdin.read()
"""
    with subprocess.Popen(
        [sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as parent:
        child = int(parent.stdout.readline())
        parent.kill()
        parent.wait()
        deadline = time.monotonic() + 30
        while (goes_on := Path(f"/proc/{child}").exists()) and time.monotonic() < deadline:
            time.sleep(0.1)
    assert not goes_on
