"""What the check says of faulty and of clean recordings, scored."""

import math
import signal
import tempfile
import traceback
from dataclasses import dataclass
from functools import cache as remember
from pathlib import Path

import odometry
import terrain
from tests.blind.faults.catalogue import FAULTS, make_case, right
from tests.blind.faults.clean import VARIANTS, is_clean, make_clean
from tests.blind.faults.fault import UnsuitableError

UNNAMED = "sensors_disagree"  # what is said where no cause fits
SEVERITY = {"note": 0, "warning": 1, "refused": 2}


@dataclass(frozen=True)
class Answer:
    """Of one faulty recording: what was noticed, whether its cause was named, what was said.

    `wrong` where another cause stands first, and not that none can be determined.
    """

    key: str
    seed: int
    base: str
    noticed: bool = False
    first: bool = False
    anywhere: bool = False
    wrong: bool = False
    too_severe: bool = False
    crash: str = ""
    said: tuple[str, ...] = ()


def check(folder):
    """Findings of the whole check as (name, level, what was found, cause); at most two minutes."""
    checked = getattr(terrain, "check_run", None) or odometry.check_recording
    signal.signal(signal.SIGALRM, _give_up)
    signal.alarm(120)
    try:
        return [(f.name, f.level, f.seen, f.cause) for f in checked(folder).findings]
    finally:
        signal.alarm(0)


def _give_up(number, frame):  # noqa: ARG001
    raise TimeoutError("the check took more than two minutes")


@remember
def findings_of_clean(folder):
    return check(folder)


def new_findings(fault, found, clean):
    """Findings that the clean recording has not, or not in these figures and of this cause."""
    names = {(name, level) for name, level, *_ in clean}
    seen = {(name, level, text) for name, level, text, _ in clean}
    return [
        (name, level, text, cause)
        for name, level, text, cause in found
        if (name, level) not in names
        or ((name, level, text) not in seen and right(fault, text, cause))
    ]


def judge(bases, task):
    """Draw one case, check it and score the answer."""
    key, seed = task
    fault = FAULTS[key]
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "run"
        try:
            base = make_case(fault, bases, seed, folder)
        except UnsuitableError as error:
            return Answer(key, seed, f"none: {error}", crash="not drawn")
        try:
            found = new_findings(fault, check(folder), findings_of_clean(base.folder))
        except Exception:
            return Answer(key, seed, base.name, crash=traceback.format_exc(limit=-2))
    enough = [f for f in found if SEVERITY[f[1]] >= SEVERITY[fault.level]]
    least = min(SEVERITY[fault.level], SEVERITY["warning"])
    leading = [f for f in found if SEVERITY[f[1]] >= least]
    first = bool(leading) and right(fault, *leading[0][2:])
    return Answer(
        key,
        seed,
        base.name,
        noticed=bool(enough),
        first=first,
        anywhere=any(right(fault, *finding[2:]) for finding in found),
        wrong=bool(leading) and not first and leading[0][0] != UNNAMED,
        too_severe=fault.harmless and any(SEVERITY[f[1]] > 0 for f in found),
        said=tuple(f"{level} {name}: {seen} | {cause}" for name, level, seen, cause in found),
    )


@dataclass(frozen=True)
class Alarm:
    """Of one clean recording: its warnings and refusals."""

    variant: str
    base: str
    clean: bool
    alarms: tuple[str, ...] = ()
    crash: str = ""


def judge_clean(task):
    variant, base, seed = task
    with tempfile.TemporaryDirectory() as place:
        folder = make_clean(variant, base, seed, Path(place) / "run")
        try:
            found = check(folder)
        except Exception:
            crash = traceback.format_exc(limit=-2)
            return Alarm(variant.key, base.name, is_clean(base), crash=crash)
    alarms = tuple(
        f"{name}: {seen} | {cause}" for name, level, seen, cause in found if level != "note"
    )
    return Alarm(variant.key, base.name, is_clean(base), alarms)


def clean_tasks(bases, seeds):
    """Every recording as it is, once; every variant of every clean recording, each seed."""
    for base in bases:
        for variant in VARIANTS:
            as_it_is = variant.key == "as_it_is"
            if (as_it_is and not {"truth"} & base.has) or (
                is_clean(base) and variant.needs <= base.has and "imu" not in base.has
            ):
                for seed in range(1 if as_it_is else seeds):
                    yield variant, base, seed


def interval(good, count, z=1.959964):
    """Bounds of the 95 % interval of a share of `good` in `count` (Wilson 1927)."""
    if count == 0:
        return 0.0, 1.0
    p, s = good / count, z * z / count
    middle = (p + s / 2) / (1 + s)
    half = math.sqrt(p * (1 - p) * s + s * s / 4) / (1 + s)
    return max(0.0, middle - half), min(1.0, middle + half)
