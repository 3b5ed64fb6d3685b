"""What the check says of the place of an antenna that run.toml states rightly, wrongly or not.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.recordings.check_places [--seed 0] [--draws 2]
        [--only WORD ...]

Real recordings whose poses have a yaw, measured as by an antenna at a place drawn by the seed: 0.2
to 1.2 m from the centre in any direction. `[sensors] pose` is that place, nothing, that place with
its signs turned round, or with x and y exchanged; with the yaw, and with positions alone. A line
for each way to state it: how often `far_sensor` is found, how often it is where what is stated (or
the centre) is more than 0.6 m and half of the robot's length off, how often another warning comes
that the recording has not as it is, and how far the place that is proposed lies off the true one.
"""

import argparse
import os
import re
from collections import defaultdict
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.recording.run import Run
from tests.odometry.checks.poses.test_far_sensor import measured_at, without_yaw

FAR_M = 0.6
STATED = {
    "rightly": lambda place: place,
    "not": lambda _place: None,
    "signs turned round": np.negative,
    "x and y exchanged": lambda place: place[::-1],
}


@dataclass
class Counts:
    """Of one way to state the place: recordings, findings, and errors of what is proposed."""

    runs: int = 0
    named: int = 0
    far: int = 0
    far_named: int = 0
    others: int = 0
    off_m: list[float] = field(default_factory=list)


def main() -> None:
    """Check every recording with places as drawn, and print the counts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--draws", type=int, default=2, help="places of each recording")
    parser.add_argument("--only", nargs="*", default=[""], help="words in the name of recordings")
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    counts: dict[tuple[str, str], Counts] = defaultdict(Counts)
    for folder in sorted((Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion").iterdir()):
        if not (folder / "pose.csv").exists():
            continue
        for _ in range(arguments.draws):
            size_m, angle = rng.uniform(0.2, 1.2), rng.uniform(-np.pi, np.pi)
            if any(word in folder.name for word in arguments.only):
                place_m = size_m * np.array([np.cos(angle), np.sin(angle)])
                count(Run.read(folder), place_m, counts)
    for (measured, stated), of in counts.items():
        off = f"{np.median(of.off_m):.2f} m off" if of.off_m else ""
        print(
            f"{measured}, stated {stated}: named {of.named} of {of.runs}, of far ones "
            f"{of.far_named} of {of.far}, other warnings {of.others}; {off}"
        )


def count(run: Run, place_m: FloatArray, counts: dict[tuple[str, str], Counts]) -> None:
    """Check one recording by an antenna at (2,), with and without yaw, in each way stated."""
    for measured, of in (("yaw", lambda run: run), ("positions alone", without_yaw)):
        usual = {finding.name for finding in check_recording(of(run)).at(Level.WARNING)}
        for words, stated in STATED.items():
            claimed_m = stated(place_m)
            there = of(measured_at(run, *place_m))
            if claimed_m is not None:
                sensors = {"pose": [*map(float, claimed_m), 0.0]}
                there = replace(there, settings={**run.settings, "sensors": sensors})
            found = {one.name: one for one in check_recording(there).at(Level.WARNING)}
            off_m = place_m - (0.0 if claimed_m is None else claimed_m)
            far = np.hypot(*off_m) > max(FAR_M, (run.robot.length or 1.0) / 2)
            named = found.get("far_sensor")
            mine = counts[measured, words]
            mine.runs, mine.named = mine.runs + 1, mine.named + (named is not None)
            mine.far, mine.far_named = mine.far + far, mine.far_named + (far and named is not None)
            mine.others += bool(found.keys() - usual - {"far_sensor"})
            if named is not None:
                numbers = re.findall(r"pose = \[([-.0-9]+), ([-.0-9]+)", named.remedy)[-1]
                mine.off_m.append(float(np.hypot(*(np.array(numbers, dtype=float) - place_m))))


if __name__ == "__main__":
    main()
