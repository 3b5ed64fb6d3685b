"""Faults that the check of recordings notices, causes that it names, and its false alarms.

    python -m tests.studies.recordings.check_faults --seeds 1 --split first
    python -m tests.studies.recordings.check_faults --seeds 10 --split second --only pose_late
        [--first-seed 0] [--clean yes] [--processes 1]
        [--quiet] [--cache FOLDER]

TERRAIN_ODOMETRY_DATA names the folder of shared recordings. Thresholds are chosen on the first
split; figures are stated of the second, whose drives the first does not have
(tests/blind/faults/bases.py lists both). `--clean` takes the recordings without a fault as well
(yes), not (no), or alone (only); `--quiet` prints the tables alone; `--cache` keeps the simulated
recordings.

Noticed: a finding at the fault's level or a more severe one, which the clean recording does not
have. Cause first: the first such refusal or warning (of a fault that is only noted: finding) names
the cause, or that of a fault which the files cannot distinguish from it. Wrong: the first names
another cause, and not that none can be determined. An exception is a crash.
"""

import argparse
import os
import shutil
import sys
import tempfile
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from tests.blind.faults.bases import real_bases, simulated_bases
from tests.blind.faults.catalogue import FAULTS
from tests.studies.recordings.check_scoring import clean_tasks, interval, judge, judge_clean


def share(good, count):
    low, high = interval(good, count)
    return f"{good}/{count} = {good / max(count, 1):.1%} ({low:.1%} to {high:.1%})"


def print_faults(answers, quiet):
    print(f"{'fault':36} {'level':8} cases noticed first anywhere wrong crash")
    for key in dict.fromkeys(answer.key for answer in answers):
        of = [answer for answer in answers if answer.key == key]
        sums = [sum(map(bool, (getattr(a, n) for a in of))) for n in
                ("noticed", "first", "anywhere", "wrong", "crash")]  # fmt: skip
        print(f"{key:36} {FAULTS[key].level:8} {len(of):5} {sums[0]:7} {sums[1]:5} "
              f"{sums[2]:8} {sums[3]:5} {sums[4]:5}")  # fmt: skip
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
    for name in ("noticed", "first", "anywhere", "wrong"):
        print(f"  {name:9} {share(sum(getattr(a, name) for a in answers), len(answers))}")
    noted = [a for a in answers if FAULTS[a.key].harmless]
    print(f"  harmless ones with a warning {sum(a.too_severe for a in noted)}/{len(noted)}, "
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
