"""What the check says of columns that were computed from other columns, treatment by treatment.

    python -m tests.studies.recordings.check_copies --split first
    python -m tests.studies.recordings.check_copies --split second --seed 5
        --only gyro_is_twist_of_treads
        [--real] [--cache FOLDER]

TERRAIN_ODOMETRY_DATA names the folder of shared recordings. Each fault of
tests/blind/faults/copied.py is put into each recording that has what it needs, with each treatment.
With --real there are no simulated recordings; --cache keeps those. Right, acceptable (sensors
disagree), another cause first, or nothing; as in check_faults.py.
"""

import argparse
import os
import sys
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np

from tests.blind.faults import copied
from tests.blind.faults.bases import real_bases, simulated_bases
from tests.blind.faults.catalogue import right, suitable
from tests.blind.faults.fault import UnsuitableError
from tests.blind.faults.recordings import read_recording, write_recording
from tests.studies.recordings.check_scoring import UNNAMED, check, findings_of_clean, new_findings

TREATED = tuple(fault for fault in copied.FAULTS if fault.draw.__code__.co_argcount > 2)


def answer(fault, base, seed, treatment):
    """One of right, acceptable, wrong, nothing; and the first new finding."""
    rng = np.random.default_rng([seed, *fault.key.encode(), *base.name.encode()])
    more = () if treatment is None else (treatment,)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "run"
        write_recording(fault.draw(read_recording(base.folder), rng, *more), folder)
        found = new_findings(fault, check(folder), findings_of_clean(base.folder))
    found = [f for f in found if f[1] != "note" or fault.level == "note"]
    if not found:
        return "nothing", ""
    first = found[0]
    if right(fault, *first[2:]):
        return "right", first[0]
    return "acceptable" if first[0] == UNNAMED else "wrong", f"{first[0]}: {first[2]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--split", choices=["first", "second"], default="first")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", action="append", choices=[f.key for f in copied.FAULTS])
    parser.add_argument("--real", action="store_true", help="no simulated recordings")
    parser.add_argument("--cache", type=Path, help="keeps the simulated recordings")
    options = parser.parse_args()
    data = os.environ.get("TERRAIN_ODOMETRY_DATA")
    if not data:
        sys.exit("TERRAIN_ODOMETRY_DATA is not set: it names the folder of shared recordings")
    bases = real_bases(data, options.split)
    if not options.real:
        cache = options.cache or Path(tempfile.mkdtemp())
        bases += [b for b in simulated_bases(cache, options.split) if "truth" not in b.has]
    for fault in copied.FAULTS:
        if options.only and fault.key not in options.only:
            continue
        print(f"\n{fault.key}: {'right  acceptable  wrong  nothing':>38}")
        for treatment in copied.TREATMENTS if fault in TREATED else (None,):
            print_row(fault, suitable(fault, bases), options.seed, treatment)


def print_row(fault, bases, seed, treatment):
    counts, lines = Counter(), []
    for base in bases:
        try:
            kind, words = answer(fault, base, seed, treatment)
        except UnsuitableError:
            continue
        counts[kind] += 1
        if kind != "right":
            lines.append(f"      {kind}: {base.name}: {words[:180]}")
    name = "drawn" if treatment is None else treatment.__name__
    print(f"  {name:18}", *(f"{counts[k]:8}" for k in ("right", "acceptable", "wrong", "nothing")))
    print("\n".join(lines), flush=True)


if __name__ == "__main__":
    main()
