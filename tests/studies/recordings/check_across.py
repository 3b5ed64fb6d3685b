"""What the check says of clean drives across terrains, where slip changes with the place.

    python -m tests.studies.recordings.check_across [--first-seed 0] [--seeds 200]

Drives come from `tests/blind/drives_across.py`; nothing in them is at fault. A line for each drive
with a warning; the count beside it is of drives whose sides slip alike (by 0.03 or less).
"""

import argparse
import tempfile
from collections import Counter
from pathlib import Path

from terrain import check_run
from tests.blind.drives_across import ASYMMETRIES, write_drive_across
from tests.studies.recordings.check_scoring import interval


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--seeds", type=int, default=200)
    options = parser.parse_args()
    accused, drives = Counter(), Counter()
    for seed in range(options.first_seed, options.first_seed + options.seeds):
        with tempfile.TemporaryDirectory() as place:
            drive = write_drive_across(Path(place) / "run", seed)
            found = check_run(Path(place) / "run").findings
        warnings = [finding for finding in found if finding.level != "note"]
        drives[drive.asymmetry] += 1
        accused[drive.asymmetry] += bool(warnings)
        for finding in warnings:
            size = f"{drive.width_m:.2f} m wide, {drive.speed_m_s:.2f} m/s"
            why = f"{finding.name}: {finding.seen[:200]} | {finding.cause[:80]}"
            print(f"{seed} {drive.way}, {size}, {drive.asymmetry}: {why}", flush=True)
    for words, kinds in (("all", ASYMMETRIES), ("sides alike", ASYMMETRIES[:2])):
        count, of = (sum(each[kind] for kind in kinds) for each in (accused, drives))
        low, high = interval(count, of)
        print(f"{words}: accused {count} of {of} ({low:.1%} to {high:.1%})")


if __name__ == "__main__":
    main()
