"""Names of two training drives exchanged: what `identify-modes` notes, and of sets that are right.

    python -m tests.studies.modes.modes_exchanged FOLDER [--first-seed 500] [--seeds 6]

Calibration drives of the worlds of tests/blind/modes, two of each mode, are made in FOLDER. In each
set the second drives of every pair of modes are exchanged in turn.
"""

import argparse
from dataclasses import replace
from itertools import combinations
from pathlib import Path

from odometry.modes.identify.drive_turns import drive_turns, turn_notes
from odometry.recording.run import Run
from tests.blind.modes.worlds import calibration_runs, worlds

DRIVES = 2


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--first-seed", type=int, default=500)
    parser.add_argument("--seeds", type=int, default=6)
    given = parser.parse_args()
    for key, world in worlds().items():
        right, noted, exchanged = 0, 0, 0
        for seed in range(given.first_seed, given.first_seed + given.seeds):
            folders = calibration_runs(world, given.folder / key / str(seed), seed)
            runs = [Run.read(folder) for folder in folders]
            names = [name for name in world.known for _ in range(DRIVES)]
            right += bool(notes_of(runs, names))
            for one, other in combinations(range(1, len(names), DRIVES), 2):
                wrong = [*names]
                wrong[one], wrong[other] = names[other], names[one]
                found = notes_of(runs, wrong)
                noted += any(
                    f"{runs[at].name}, named" in note for at in (one, other) for note in found
                )
                exchanged += 1
        print(f"{key}: of {exchanged} exchanged {noted} noted, of {given.seeds} right {right}")


def notes_of(runs, names):
    named = [named_run(run, name) for run, name in zip(runs, names, strict=True)]
    return list(turn_notes(drive_turns(named)))


def named_run(run, name):
    """The run with a terrain of this name alone."""
    columns = {key: of for key, of in run.odometry.columns.items() if key != "terrain"}
    settings = {**run.settings, "run": {"terrain": name}}
    return replace(run, odometry=replace(run.odometry, columns=columns), settings=settings)


if __name__ == "__main__":
    main()
