"""Kills (SIGKILL) at random moments: nothing torn, nothing mixed, and every rerun the same.

    python -m tests.studies.speed.kills [--kills 100] [--seed 1] [--verb run ...]

For each verb a result is made undisturbed once, and once with another setting. Then it is made in
child processes, each killed at a random moment of the time that the verb takes; every other kill
falls into the last fifth, where it writes. In turn the place is empty, holds the finished result
of the other setting, or what the kill before left. After each kill every file that has no
temporary name must be, byte for byte, of one of the two results (else it is torn), and the place
must hold one of them whole, or nothing, or say that it is unfinished (else it is mixed). Then the
verb runs to its end: every byte must be as undisturbed, and nothing temporary left.
"""

import argparse
import importlib
import os
import pkgutil
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from pathlib import Path

import cv2
import numpy as np

import odometry
import terrain
from odometry.outputs.leftovers import is_temporary
from odometry.outputs.manifest import NAME, UNFINISHED, read_manifest
from terrain.cli.main import cli

Contents = dict[str, bytes]
OUT, SAID = Path("out"), Path("said.txt")
LATE = 0.8  # of the time; from here on every other kill
COLUMNS = ("ended first", "nothing", "old", "new", "unfinished", "torn", "mixed", "differ")
SYNTHESISE = "synthesise --zone grass --zone gravel --zone-length 2 --image-rate 1 --out"
FORMATS = "--to ros --to tum --to mcap --to parquet"
INPUTS = (
    "simulate --out yard --duration 60 --seed 1 --max-speed 0.6",
    "simulate --out hill --duration 45 --seed 2 --slope 8 --drive figure_eight --max-speed 0.6",
    "simulate --out grass --duration 25 --traction grass --drive sinusoid",
    "simulate --out asphalt --duration 25 --traction asphalt --drive sinusoid --seed 1",
    f"{SYNTHESISE} photos",
    "identify-modes grass asphalt --out modes.toml",
    "train photos/patches --preset chen2023 --out terrain.model",
    "run yard --out driven",
)
VERBS = {  # a command, and what gives another result of it
    "run": ("run photos --model terrain.model --out out/r", "--no-vision"),
    "identify": ("identify yard --model icr --out out/set.toml", "--from 20"),
    "train": ("train photos/patches --preset chen2023 --out out/t.model", "--patch-size 64"),
    "label": ("label photos --out out/p", "--per-place 4"),
    "gap": ("gap hill --calibration yard --out out/g", "--horizon-s 1.5"),
    "modes": ("modes grass --models modes.toml --out out/m", "--sure 0.7"),
    "synthesise": (f"{SYNTHESISE} out/s", "--image-rate 2"),
    "simulate": ("simulate --duration 25 --seed 3 --out out/s", "--slope 3"),
    "compare": ("compare yard hill --model icr_symmetric --out out/c", "--from 20"),
    "export": (f"export driven {FORMATS} --out out/e", "--cell 0.7"),
}


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--verb", action="append", choices=list(VERBS))
    arguments = parser.parse_args()
    cv2.setNumThreads(1)
    for package in (odometry, terrain):  # once here, so that no child imports them
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            importlib.import_module(module.name)
    print(f"{'verb':12}{'kills':>6}" + "".join(f"{name:>13}" for name in COLUMNS))
    with tempfile.TemporaryDirectory() as scratch:
        os.chdir(scratch)
        for line in INPUTS:
            finish(line)
        for verb in arguments.verb or VERBS:
            rng = np.random.default_rng([arguments.seed, list(VERBS).index(verb)])
            counts = study(*VERBS[verb], arguments.kills, rng)
            cells = "".join(f"{counts[name]:13}" for name in COLUMNS)
            print(f"{verb:12}{arguments.kills:6}{cells}", flush=True)


def study(command: str, other: str, kills: int, rng: np.random.Generator) -> Counter[str]:
    """Kill one verb many times; count what was found."""
    old, _ = undisturbed(f"{command} {other}")
    new, took_s = undisturbed(command)
    left: Contents = {}
    counts: Counter[str] = Counter()
    for number in range(kills):
        restore(({}, old, left)[number % 3])
        from_s = LATE * took_s if number % 2 else 0.0
        counts["ended first"] += killed_at(float(rng.uniform(from_s, took_s)), command)
        left = contents()
        there = {name: data for name, data in left.items() if not is_aside(name)}
        counts[what_is(there, old, new)] += 1
        counts["torn"] += any(
            data not in (old.get(name), new.get(name)) and Path(name).name != NAME
            for name, data in there.items()
        )
        finish(command)
        counts["differ"] += contents() != new or any(map(is_aside, names()))
    return counts


def what_is(there: Contents, old: Contents, new: Contents) -> str:
    """What a place holds after a kill."""
    for name, result in (("nothing", {}), ("old", old), ("new", new)):
        if there == result:
            return name
    manifests = [read_manifest(file.parent) for file in OUT.glob(f"*/{NAME}")]
    says_so = any(one is not None and one.state == UNFINISHED for one in manifests)
    return "unfinished" if says_so else "mixed"


def undisturbed(command: str) -> tuple[Contents, float]:
    """A result made in an empty place, and the time that it took."""
    restore({})
    began_s = time.monotonic()
    finish(command)
    return contents(), time.monotonic() - began_s


def started(command: str) -> int:
    """Start a command in a child process; its number."""
    child = os.fork()
    if child:
        return child
    said = os.open(SAID, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(said, 1)
    os.dup2(said, 2)
    try:
        cli(command.split(), standalone_mode=False)
    except BaseException:  # whatever it is, the child ends here
        traceback.print_exc()
        os._exit(1)
    os._exit(0)


def finish(command: str) -> None:
    """Run a command to its end."""
    _, status = os.waitpid(started(command), 0)
    if status:
        sys.exit(f"failed: terrain-odometry {command}\n{SAID.read_text()}")


def killed_at(moment_s: float, command: str) -> bool:
    """Kill a command after a time; whether it had ended before."""
    child = started(command)
    time.sleep(moment_s)
    os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    return not os.WIFSIGNALED(status)


def names() -> list[str]:
    """Names of all files and folders of the place."""
    return [path.relative_to(OUT).as_posix() for path in sorted(OUT.rglob("*"))]


def contents() -> Contents:
    """All files of the place."""
    return {name: (OUT / name).read_bytes() for name in names() if (OUT / name).is_file()}


def restore(result: Contents) -> None:
    """Make the place hold these files alone."""
    if OUT.exists():
        shutil.rmtree(OUT)
    OUT.mkdir()
    for name, data in result.items():
        (OUT / name).parent.mkdir(parents=True, exist_ok=True)
        (OUT / name).write_bytes(data)


def is_aside(name: str) -> bool:
    """Whether a file has a temporary name, or lies in a folder that has one."""
    return any(map(is_temporary, Path(name).parts))


if __name__ == "__main__":
    main()
