"""What the check says of clean drives of robots of any size and pace.

    python -m tests.studies.recordings.check_any_robot [--first-seed 0] [--seeds 300]

Drives come from `tests/blind/any_robot.py`; nothing in them is at fault. A line for each drive with
a finding that is no property of it (few ticks, noise of a receiver, a bias, one motion alone).
"""

import argparse
import tempfile
from collections import Counter
from pathlib import Path

from terrain import check_run
from tests.blind.any_robot import write_clean_run
from tests.studies.recordings.check_scoring import interval

TRUE = {
    "coarse_speeds",
    "gyroscope_bias",
    "noisy_positions",
    "one_motion",
    "saturated_speed",  # without noise the fastest speed is one number
    "straight_drives",
    "treads_still",  # a drive of stops may have nothing else
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--seeds", type=int, default=300)
    options = parser.parse_args()
    names, accused = Counter(), 0
    for seed in range(options.first_seed, options.first_seed + options.seeds):
        with tempfile.TemporaryDirectory() as place:
            robot = write_clean_run(Path(place) / "run", seed)
            found = check_run(Path(place) / "run").findings
        false = [finding for finding in found if finding.name not in TRUE]
        accused += any(finding.level != "note" for finding in false)
        for finding in false:
            names[f"{finding.level} {finding.name}"] += 1
            size = f"{robot.track_m:.2f} m wide, {robot.fastest_m_s:.2f} m/s"
            print(f"{seed} {robot.way}, {robot.source}, {size}: {finding.level} {finding.name}: "
                  f"{finding.seen[:200]} | {finding.cause[:120]}", flush=True)  # fmt: skip
    low, high = interval(accused, options.seeds)
    print(f"accused {accused} of {options.seeds} ({low:.1%} to {high:.1%})", dict(names))


if __name__ == "__main__":
    main()
