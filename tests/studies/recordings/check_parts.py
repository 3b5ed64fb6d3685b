"""What the check says of faults of a part of a recording, and of treads that change.

    python -m tests.studies.recordings.check_parts --split first --seeds 6 [--first-seed 0]
        [--only KEY]

Real recordings with poses by their robot: Huskies and the Marmotte in the first split, the Warthog
in the second; beside them clean drives of `tests/blind/any_robot.py`, others in each. Right: the
first warning names the cause. Open: the first one says that none can be determined. Wrong: the
first one names another cause. None: no warning that the clean recording does not have, which is
right of cells that are left out and of terrain that changes (`wider`, `slipping`).
"""

import argparse
import os
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np

from tests.blind import changing_treads, part_faults
from tests.blind.any_robot import write_clean_run
from tests.blind.faults.fault import UnsuitableError
from tests.blind.faults.recordings import read_recording, write_recording
from tests.blind.part_faults import draw_span, is_right
from tests.studies.recordings.check_scoring import UNNAMED, check

REAL = {"first": ("husky", "marmotte"), "second": ("warthog",)}
DRAWN = {"first": range(7000, 7040), "second": range(8000, 8040)}
FAULTS = part_faults.FAULTS | changing_treads.FAULTS | changing_treads.LOOK_ALIKES
SIMULATED = 0.35  # share of the cases


def draw_case(fault, split, seed, place):
    """Write a clean recording and a faulty copy; returns its name, both folders and the span."""
    rng = np.random.default_rng([seed, *fault.key.encode()])
    motion = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion"
    real = [f for f in sorted(motion.glob("*/")) if f.name.startswith(REAL[split])]
    real = [folder for folder in real if (folder / "pose.csv").exists()]
    for attempt in range(30):
        if rng.random() < SIMULATED:
            drawn = int(rng.choice(DRAWN[split]))
            clean = place / f"clean_{attempt}"
            write_clean_run(clean, drawn)
            (clean / "truth.csv").unlink()
            name = f"any_robot {drawn}"
        else:
            clean = real[rng.integers(len(real))]
            name = clean.name
        recording = read_recording(clean)
        if not np.isfinite(recording["pose"]["yaw"]).any():
            continue
        span_s = draw_span(rng, recording["pose"]["t"])
        try:
            faulty = fault.change(recording, rng, span_s)
        except UnsuitableError:
            continue
        write_recording(faulty, place / "faulty")
        return name, clean, place / "faulty", span_s
    raise UnsuitableError(fault.key)


def judge(fault, split, seed):
    """How the answer is, and lines that say it."""
    with tempfile.TemporaryDirectory() as place:
        name, clean, faulty, span_s = draw_case(fault, split, seed, Path(place))
        before = {found[0] for found in check(clean) if found[1] != "note"}
        found = check(faulty)
    said = [f"{level} {name}: {seen} | {cause}" for name, level, seen, cause in found]
    new = [f for f in found if f[1] != "note" and (f[0] not in before or f[0] == UNNAMED)]
    if not new:
        answer = "none"
    elif fault.words and is_right(fault, *new[0][2:]):
        answer = "right"
    else:
        answer = "open" if new[0][0] == UNNAMED else "wrong"
    return answer, [f"seed {seed} on {name}, {span_s[0]:.1f} to {span_s[1]:.1f} s: {answer}", *said]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--split", choices=list(REAL), default="first")
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--only", action="append", choices=list(FAULTS), help="repeat")
    options = parser.parse_args()
    rows = []
    for key in options.only or FAULTS:
        counts = Counter()
        for seed in range(options.first_seed, options.first_seed + options.seeds):
            answer, lines = judge(FAULTS[key], options.split, seed)
            counts[answer] += 1
            print(key, *(line[:600] for line in lines), sep="\n  ", flush=True)
        rows.append((key, *(counts[name] for name in ("right", "open", "wrong", "none"))))
    print("\nfault                   right open wrong none")
    for key, *counts in rows:
        print(f"{key:24}" + "".join(f"{count:5}" for count in counts))


if __name__ == "__main__":
    main()
