"""The pool of this machine: a process that is killed takes no other run with it."""

import subprocess
import sys
import time
from contextlib import suppress
from multiprocessing import active_children
from pathlib import Path

import pytest

from terrain.batch.batch import KILLED, local_outcomes, pool
from terrain.batch.job import FAILED, REPLAYED
from terrain.config import Config
from tests.terrain.batch.deadly import Deadly


def test_a_killed_process_is_one_failed_run(four_runs, job_of):
    options = {"b": Deadly(Config())}
    jobs = [job_of(four_runs / name, options.get(name)) for name in "ab"]
    others = set(active_children())  # of other tests
    found = {outcome.job.name: outcome for outcome in local_outcomes(jobs, 2)}
    assert {name: of.state for name, of in found.items()} == {"a": REPLAYED, "b": FAILED}
    assert found["b"].said == KILLED
    assert set(active_children()) <= others


def test_what_is_broken_off_ends_at_once():
    others = set(active_children())
    with suppress(KeyboardInterrupt), pool(1) as executor:
        assert executor.submit(abs, -1).result() == 1
        (process,) = set(active_children()) - others
        executor.submit(time.sleep, 600)
        raise KeyboardInterrupt
    process.join()
    assert process.exitcode != 0


@pytest.mark.slow
def test_a_process_of_the_pool_ends_with_its_parent():
    """A parent that is killed can report nothing."""
    program = """
import os, sys, time
from terrain.batch.batch import pool
with pool(1) as executor:
    print(executor.submit(os.getpid).result(), flush=True)
    executor.submit(time.sleep, 60)
    sys.stdin.read()
"""
    with subprocess.Popen(
        [sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as parent:
        child = int(parent.stdout.readline())
        parent.kill()
        parent.wait()
        deadline_s = time.monotonic() + 30
        while (goes_on := Path(f"/proc/{child}").exists()) and time.monotonic() < deadline_s:
            time.sleep(0.1)
    assert not goes_on


def test_processes_are_forked_from_one_that_has_imported_what_a_replay_needs():
    with pool(1) as executor:
        there = "'terrain.batch.job' in __import__('sys').modules"
        assert executor.submit(eval, there).result()
