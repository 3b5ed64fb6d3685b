"""Faults that the check of recordings notices, causes that it names, and its false alarms.

    python tests/studies/check_faults.py --seeds 1 --split first
    python tests/studies/check_faults.py --seeds 10 --split second --only pose_late

TERRAIN_ODOMETRY_DATA names the folder of shared recordings. Thresholds are chosen on the first
split; figures are stated of the second, whose drives the first does not have
(tests/blind/faults/bases.py lists both).

Noticed: a finding at the fault's level or a more severe one, which the clean recording does not
have. Cause first: the first such refusal or warning (of a fault that is only noted: finding)
names the cause, or that of a fault which the files cannot tell from it. An exception is a crash.
"""

import argparse
import os
import shutil
import sys
import tempfile
import traceback
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache as remember
from functools import partial
from pathlib import Path

import odometry
import terrain
from tests.blind.faults.bases import real_bases, simulated_bases
from tests.blind.faults.catalogue import FAULTS, make_case, right
from tests.blind.faults.clean import VARIANTS, is_clean, make_clean
from tests.blind.faults.fault import UnsuitableError
from tests.studies.wilson import interval

SEVERITY = {"note": 0, "warning": 1, "refused": 2}


@dataclass(frozen=True)
class Answer:
    """Of one faulty recording: what was noticed, whether its cause was named, what was said."""

    key: str
    seed: int
    base: str
    noticed: bool = False
    first: bool = False
    anywhere: bool = False
    too_severe: bool = False
    crash: str = ""
    said: tuple[str, ...] = ()


def check(folder):
    """Findings of the whole check as (name, level, seen, cause)."""
    checked = getattr(terrain, "check_run", None) or odometry.check_recording
    return [(f.name, f.level, f.seen, f.cause) for f in checked(folder).findings]


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
        if (name, level) not in names or ((name, level, text) not in seen and right(fault, cause))
    ]


def judge(bases, task):
    """Draw one case, check it and judge the answer."""
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
    return Answer(
        key,
        seed,
        base.name,
        noticed=bool(enough),
        first=bool(leading) and right(fault, leading[0][3]),
        anywhere=any(right(fault, cause) for *_, cause in found),
        too_severe=fault.level == "note" and any(SEVERITY[f[1]] > 0 for f in found),
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


def share(good, count):
    low, high = interval(good, count)
    return f"{good}/{count} = {good / max(count, 1):.1%} ({low:.1%} to {high:.1%})"


def print_faults(answers, quiet):
    print(f"{'fault':36} {'level':8} cases noticed first anywhere crash")
    for key in dict.fromkeys(answer.key for answer in answers):
        of = [answer for answer in answers if answer.key == key]
        sums = [sum(map(bool, (getattr(a, n) for a in of))) for n in
                ("noticed", "first", "anywhere", "crash")]  # fmt: skip
        print(f"{key:36} {FAULTS[key].level:8} {len(of):5} {sums[0]:7} {sums[1]:5} "
              f"{sums[2]:8} {sums[3]:5}")  # fmt: skip
        for answer in of:
            if not quiet and not (answer.noticed and answer.first):
                print(f"    seed {answer.seed} on {answer.base}: {answer.crash.strip()}")
                for line in answer.said or ("(nothing new)",):
                    print(f"      {line[:220]}")
    print()
    for title, wanted in (("named by the issue", True), ("not named", False)):
        print_totals(title, [a for a in answers if FAULTS[a.key].named == wanted])
    print_totals("all faults", answers)


def print_totals(title, answers):
    if not answers:
        return
    print(title)
    for name in ("noticed", "first", "anywhere"):
        print(f"  {name:9} {share(sum(getattr(a, name) for a in answers), len(answers))}")
    noted = [a for a in answers if FAULTS[a.key].level == "note"]
    print(f"  notes with a warning {sum(a.too_severe for a in noted)}/{len(noted)}, "
          f"crashes {sum(map(bool, (a.crash for a in answers)))}")  # fmt: skip


def print_clean(alarms):
    print("\nclean recordings: variant, cases, false alarms")
    counted = [alarm for alarm in alarms if alarm.clean]
    for key in dict.fromkeys(alarm.variant for alarm in counted):
        of = [alarm for alarm in counted if alarm.variant == key]
        raised = [alarm for alarm in of if alarm.alarms or alarm.crash]
        print(f"  {key:18} {len(of):5} {len(raised):5}")
        for alarm in raised:
            for line in alarm.alarms or (alarm.crash.strip(),):
                print(f"    {alarm.base}: {line[:220]}")
    names = Counter(line.split(":")[0] for alarm in counted for line in alarm.alarms)
    print("  false alarms by name:", dict(names.most_common()))
    print("  false alarms", share(sum(bool(a.alarms) for a in counted), len(counted)))
    print("\nother real recordings: a warning needs evidence")
    for alarm in (alarm for alarm in alarms if not alarm.clean):
        for line in alarm.alarms or ((alarm.crash or "no warning").strip(),):
            print(f"  {alarm.base}: {line[:220]}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--seeds", type=int, default=1, help="cases a fault")
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--only", action="append", choices=sorted(FAULTS), help="repeat")
    parser.add_argument("--split", choices=["first", "second", "all"], default="first")
    parser.add_argument("--clean", choices=["yes", "no", "only"], default="yes")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--quiet", action="store_true", help="the tables alone")
    parser.add_argument("--cache", type=Path, help="keeps the simulated recordings")
    options = parser.parse_args()
    data = os.environ.get("TERRAIN_ODOMETRY_DATA")
    if not data:
        sys.exit("TERRAIN_ODOMETRY_DATA is not set: it names the folder of shared recordings")
    cache = options.cache or Path(tempfile.mkdtemp())
    cache.mkdir(exist_ok=True, parents=True)
    study(options, data, cache)
    if not options.cache:
        shutil.rmtree(cache)


def study(options, data, cache):
    bases = real_bases(data, options.split) + simulated_bases(cache, options.split)
    seeds = range(options.first_seed, options.first_seed + options.seeds)
    tasks = [(key, seed) for key in options.only or FAULTS for seed in seeds]
    clean = list(clean_tasks(bases + simulated_bases(cache, "clean"), 1))
    with ProcessPoolExecutor(options.processes) as pool:
        if options.clean != "only":
            print_faults(list(pool.map(partial(judge, bases), tasks)), options.quiet)
        if options.clean == "only" or (options.clean == "yes" and not options.only):
            print_clean(list(pool.map(judge_clean, clean)))


if __name__ == "__main__":
    main()
