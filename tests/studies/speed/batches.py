"""Many runs: two processes against one, kills, a run that fails, a cluster that loses a worker.

    python -m tests.studies.speed.batches [--runs 40] [--seconds 60] [--seed 1]
        [--only speeds kills]

Simulates the runs, replays them as a user does, and prints what it took. One and two processes
take turns on halves of the runs (one, two, two, one), so that what else the machine does falls on
both. Then one batch is killed (SIGKILL) at random moments until it ends, and one is sent to a Dask
cluster of two workers, one of which is killed half way; both must give the bytes of the first.
"""

import argparse
import csv
import ctypes
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from contextlib import suppress
from pathlib import Path

import numpy as np

PROGRAM = [sys.executable, "-c", "from terrain.cli.main import main; main()"]
DASK = [sys.executable, "-m", "dask"]
PR_SET_CHILD_SUBREAPER = 36  # processes that outlive a batch become ours: their time counts
PARTS = ("speeds", "kills", "cluster")
Contents = dict[str, bytes]


def main() -> None:
    """Run the study and print its figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=40)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", choices=PARTS, default=PARTS)
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        names = [f"run_{number:02d}" for number in range(arguments.runs)]
        for number, name in enumerate(names):
            options = ("--duration", str(arguments.seconds), "--max-speed", "0.6")
            finish("simulate", *options, "--seed", str(number), "--out", name)
        print(f"{len(names)} runs of {arguments.seconds:g} s simulated", flush=True)
        Path("broken").mkdir()
        Path("broken/run.toml").write_text("[robot]\n")
        if "speeds" in arguments.only:
            speeds(names)
        if {"kills", "cluster"}.isdisjoint(arguments.only):
            return
        words = (*names, "broken", "--out")
        finish("batch", *words, "whole", "--processes", "2", code=1)
        whole = contents("whole")
        (failed,) = (row for row in table("whole/batch.csv") if row["error"])
        print(f"a run that fails is a row: {failed['run']}: {failed['error']}", flush=True)
        if "kills" in arguments.only:
            kills(words, whole, rng)
        if "cluster" in arguments.only:
            cluster(words, whole)


def speeds(names: list[str]) -> None:
    """One process against two, in turns."""
    half = len(names) // 2
    turns = [(1, names[:half]), (2, names[:half]), (2, names[half:]), (1, names[half:])]
    took = {1: np.zeros(2), 2: np.zeros(2)}
    for number, (processes, of) in enumerate(turns):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        began_s = time.monotonic()
        said = finish("batch", *of, "--processes", str(processes), "--out", f"turn_{number}")
        wall_s = time.monotonic() - began_s
        wait_for_all()
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        took[processes] += [wall_s, cpu_s]
        print("  " + next(line for line in said.splitlines() if "An hour" in line), flush=True)
    for processes, (all_s, all_cpu_s) in took.items():
        print(f"{processes} at a time: {all_s:.1f} s, {all_cpu_s:.1f} s of processor time")
    print(f"two processes are {took[1][0] / took[2][0]:.2f} times as fast as one", flush=True)


def wait_for_all() -> None:
    """Let the processes end from which those of a batch were forked."""
    with suppress(ChildProcessError):
        while True:
            os.wait()


def kills(words: tuple[str, ...], whole: Contents, rng: np.random.Generator) -> None:
    """Kill a batch again and again; what it had replayed is not replayed again."""
    count, code = 0, -signal.SIGKILL
    while code == -signal.SIGKILL:
        wanted = done("killed") + int(rng.integers(1, len(words) // 4 + 2))
        with started("batch", *words, "killed", "--processes", "2") as process:
            while process.poll() is None and done("killed") < wanted:
                time.sleep(0.05)
            time.sleep(float(rng.uniform(0.0, 1.0)))
            process.kill()
            process.communicate()
        code = process.returncode
        count += code == -signal.SIGKILL
    replayed = Counter(row["run"] for row in table("killed/times.csv"))
    broken = replayed.pop("broken")
    print(
        f"killed {count} times: {len(replayed)} runs replayed, each at most "
        f"{max(replayed.values())} time, the broken one tried {broken} times; same bytes: "
        f"{contents('killed') == whole}",
        flush=True,
    )


def done(folder: str) -> int:
    """How many jobs of a batch have ended."""
    file = Path(folder) / "times.csv"
    return file.read_text().count("\n") - 1 if file.is_file() else 0


def cluster(words: tuple[str, ...], whole: Contents) -> None:
    """Send the same to two workers, and kill one of them half way."""
    scheduler = dask("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
    address = told(scheduler, r"Scheduler at:\s+(\S+)")
    options = ("--nthreads", "1", "--no-nanny", "--no-dashboard", "--host", "127.0.0.1")
    workers = [dask("worker", *options, address) for _ in range(2)]
    for worker in workers:
        told(worker, "(Registered to)")
    with started("batch", *words, "far", "--scheduler", address) as process:
        while done("far") < len(words) // 2:
            time.sleep(0.1)
        workers[0].kill()
        process.communicate()
    for one in (*workers, scheduler):
        one.kill()
        one.communicate()
    replayed = Counter(row["run"] for row in table("far/times.csv"))
    print(
        f"cluster, one of two workers killed half way: {len(replayed)} jobs, each reported "
        f"{max(replayed.values())} time; same bytes: {contents('far') == whole}",
        flush=True,
    )


def started(*words: str) -> "subprocess.Popen[str]":
    """Start a verb."""
    return subprocess.Popen(
        [*PROGRAM, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def finish(*words: str, code: int = 0) -> str:
    """Run a verb to its end; what it said."""
    with started(*words) as process:
        said, errors = process.communicate()
    if process.returncode != code:
        sys.exit(f"failed: {' '.join(words)}\n{errors}")
    return said


def dask(*words: str) -> "subprocess.Popen[str]":
    """Start a scheduler or a worker."""
    return subprocess.Popen([*DASK, *words], stderr=subprocess.PIPE, text=True)


def told(process: "subprocess.Popen[str]", pattern: str) -> str:
    """What a process says in place of a group, as soon as it does."""
    assert process.stderr is not None
    for line in process.stderr:
        found = re.search(pattern, line)
        if found:
            return found[1]
    sys.exit(f"{process.args!r} never said {pattern}")


def table(file: str) -> list[dict[str, str]]:
    """Rows of a CSV file."""
    with Path(file).open(newline="") as stream:
        return list(csv.DictReader(stream))


def contents(folder: str) -> Contents:
    """All files but times.csv, which says how long it took."""
    root = Path(folder)
    files = (file for file in root.rglob("*") if file.is_file() and file.name != "times.csv")
    return {file.relative_to(root).as_posix(): file.read_bytes() for file in files}


if __name__ == "__main__":
    main()
