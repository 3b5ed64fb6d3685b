"""Real recordings changed so strongly that each change alone makes 2.5 times the noise floor.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.gap.gap_real_strong [--held-out]
        [--out FOLDER]
        [--only WORD ...]

Pairs are the halves of each recording, both ways round, and two sequences of one drive. The change
of the measured one is as strong as it takes, where that is no more than MOST. Recordings of
HELD_OUT are measured with --held-out alone, and calibrate nothing without it. Every case is a row
of FOLDER/cases.csv, written as soon as it is known.
"""

import argparse
import csv
import os
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import permutations
from pathlib import Path

import numpy as np

from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.errors import OdometryError
from odometry.gap.prepare.prepared import prepared
from odometry.gap.prepare.simulate import residuals
from odometry.gap.prepare.statistic import floor_there
from odometry.models.icr import Icr
from odometry.recording.run import Run
from odometry.windows.dense.dense import DenseWindows
from tests.studies.gap.gap_real import COLUMNS, CONFIG, study
from tests.studies.gap.gap_real_cases import Case, in_halves, late, recordings
from tests.studies.gap.gap_real_changes import (
    MADE,
    TWICE,
    arm,
    lagging,
    large_wheel,
    score_of,
    turned,
)

TIMES = 2.5  # the noise floor
LEAST = 0.5  # of the change by `gap_real_changes`
HELD_OUT = (
    *("marmotte_boreal_20240125_1215_s00", "husky_2023_s00", "warthog_2023", "warthog_asphalt"),
    *("warthog_gravel", "warthog_ice", "warthog_sand"),
)
# name: usual strength, most that is tried, the change
STRENGTHS: Mapping[str, tuple[float, float, Callable[[Run, float], Run]]] = {
    "time_offset": (0.15, 0.6, late),
    "lever_arm": (0.3, 1.0, arm),
    "wheel_scale": (0.05, 0.25, lambda run, more: large_wheel(run, 1 + more)),
    "heading_offset": (0.06, 0.35, turned),
    "actuator_lag": (0.3, 1.0, lagging),
}


def main() -> None:
    """Run the cases, and count how often a change has its name."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--held-out", action="store_true")
    parser.add_argument("--out", type=Path, default=Path("gap_real_strong"))
    parser.add_argument("--only", nargs="*", default=[""], help="words in the name of cases")
    arguments = parser.parse_args()
    runs = recordings(Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion")
    every = cases(runs, held_out=arguments.held_out)
    count(every, arguments.only, arguments.out)


def count(every: Iterator[Case], only: Sequence[str], out: Path) -> None:
    """Run the cases that are asked for, write a row for each, and print the scores."""
    out.mkdir(parents=True, exist_ok=True)
    scores: Counter[str] = Counter()
    with (out / "cases.csv").open("w", newline="", encoding="utf-8") as stream:
        sheet = csv.DictWriter(stream, COLUMNS)
        sheet.writeheader()
        for case in every:
            if not any(word in case.name for word in only):
                continue
            row = study(case, out)
            sheet.writerow(row)
            stream.flush()
            print(*(f"{name}={text}" for name, text in row.items() if text), sep="  ")
            if row["ratio"] and float(row["ratio"]) >= TWICE:
                scores[score_of(row, {})] += 1
    print(f"at {TWICE:g} times the floor: {dict(scores)} of {scores.total()}")


def cases(runs: Mapping[str, Run], *, held_out: bool) -> Iterator[Case]:
    """The changed pairs of one part; those that cannot be judged are left out."""
    for name, known, measured in pairs(runs):
        is_held = measured.folder.name.startswith(HELD_OUT)
        if is_held != held_out or (known.folder.name.startswith(HELD_OUT) and not held_out):
            continue
        try:
            strengths = strong_enough(known, measured)
        except OdometryError:
            continue
        for expected, strength in strengths.items():
            change = STRENGTHS[expected][2]
            title = f"{expected} of {strength:.3g} {name}"
            yield Case("strong", title, expected, [known], [change(measured, strength)])


def pairs(runs: Mapping[str, Run]) -> Iterator[tuple[str, Run, Run]]:
    """A name, the run that calibrates and the run that is measured."""
    for name, run in runs.items():
        first, second = in_halves(run)
        yield f"{name} forward", first, second
        yield f"{name} backward", second, first
    for one, other in permutations(runs, 2):
        if one[:-2] == other[:-2] and one[-3] == "s":
            yield f"{one} to {other}", runs[one], runs[other]


def strong_enough(known: Run, measured: Run) -> dict[str, float]:
    """By name the strength of which a change alone moves the ends of held-out windows so far."""
    ready = prepared([measured], [known], [], (Icr(), None), CONFIG)
    held, base = ready.scenes[1], ready.known.base
    floor_m = floor_there(ready.floor(), ready.known, held, ready.config).value
    moved = partial(moved_m, base, held)
    found = {}
    for name, (usual, most, _) in STRENGTHS.items():
        strength = usual * TIMES * floor_m / moved(MADE[name])
        if strength <= most:
            found[name] = max(strength, LEAST * usual)
    return found


def moved_m(base: Base, scenes: Sequence[DenseWindows], change: Added) -> float:
    """Root mean square [m] by which a change moves the ends of windows."""
    ends = [
        (residuals(base, (change,), scene) - residuals(base, (), scene))[:, -1, :2]
        for scene in scenes
    ]
    return float(np.sqrt((np.concatenate(ends) ** 2).sum(axis=1).mean()))


if __name__ == "__main__":
    main()
