"""Whether identified parameters of clean drives of any robot are within their deviations.

    python -m tests.studies.identification.identify_any_robot [--first-seed 0] [--seeds 120]
        [--as one]

Drives come from `tests/blind/any_robot.py`. `--as terrains` names two terrains in turn every 30 s,
whose truth is the same; `--as runs` takes three drives of a robot together. Of each parameter set
of `icr` z is (estimate - truth) / deviation of the set that is written, of each
parameter, of the width and of what treads turn alone: alpha_right / alpha_left, alpha_left / width.
"""

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np

from odometry.errors import OdometryError
from odometry.identification.identify import identify
from odometry.identification.plausibility import notes, turns_outside
from odometry.recording.run_span import Span
from terrain.checks.recording import checked_run
from tests.blind.any_robot import write_clean_run
from tests.studies.recordings.check_scoring import interval

FAR = (3.0, 5.0)
NAMES = ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right", "width", "ratio", "gain")


def with_combinations(values, covariance):
    """Values of the five parameters and of combinations, and deviations of all (8,)."""
    y_left, y_right, _, by_left, by_right = values
    width = y_left - y_right
    ratio, gain = by_right / by_left, by_left / width
    gradients = [
        *np.eye(5),
        (1, -1, 0, 0, 0),
        (0, 0, 0, -ratio / by_left, 1 / by_left),
        (-gain / width, gain / width, 0, 1 / width, 0),
    ]
    deviations = [np.sqrt(by @ covariance @ by) for by in np.array(gradients, dtype=float)]
    return np.array([*values, width, ratio, gain]), np.array(deviations)


def folders_of(place, seed, as_):
    """Run folders to identify on, and their robot."""
    folders = [place / f"run_{drive}" for drive in range(3 if as_ == "runs" else 1)]
    robots = [write_clean_run(folder, seed, drive) for drive, folder in enumerate(folders)]
    if as_ == "terrains":
        file = folders[0] / "odometry.csv"
        header, *rows = file.read_text("utf-8").splitlines()
        named = [f"{row},{'ab'[int(float(row.split(',', 1)[0]) // 30) % 2]}" for row in rows]
        file.write_text("\n".join([f"{header},terrain", *named]) + "\n", "utf-8")
    return folders, robots[0]


def asked(seed, as_):
    """A dictionary for each table that is written, or one for the refusal."""
    with tempfile.TemporaryDirectory() as place:
        folders, robot = folders_of(Path(place), seed, as_)
        common = {"seed": seed}
        try:
            read = [checked_run(folder, Span()) for folder in folders]
            named = None if as_ == "terrains" else "yard"
            began_s = time.process_time()
            found = identify([run for run, _ in read], "icr", terrain=named)
            common["took"] = round(time.process_time() - began_s, 2)
            found.require_determined()
        except OdometryError as error:
            return [common | {"refused": str(error)}]
    warned = [f.name for _, report in read for f in report.findings if f.level == "warning"]
    return [common | scored(found, name, robot.truth, warned) for name in found.terrains]


def scored(found, name, truth, warned):
    """How far a table is from the truth, and what is said beside it."""
    of, table = found.terrains[name], found.to_parameter_set().terrains[name]
    truth = np.array([truth[n] for n in table.covariance_order])
    values, deviations = with_combinations(list(of.fit.packed), table.covariance)
    true_values, _ = with_combinations(truth, table.covariance)
    intervals = of.fit.intervals.values()
    halves = of.halves and of.halves.note()
    doubts = (*notes(of.fit), turns_outside(of.fit, found.robot), halves, of.mixed)
    return {
        "z": dict(zip(NAMES, np.round((values - true_values) / deviations, 2), strict=True)),
        "holds": [bool(i.low <= t <= i.high) for i, t in zip(intervals, truth, strict=True)],
        "said": [*warned, *filter(None, doubts)],
    }


def parser_of(words):
    """Options of a study of so many seeds."""
    parser = argparse.ArgumentParser(description=words.split("\n", 1)[0])
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--seeds", type=int, default=120)
    return parser


def share(count, of):
    """A count with its Wilson interval."""
    low, high = interval(count, of)
    return f"{count} of {of} ({low:.1%} to {high:.1%})"


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--as", dest="as_", default="one", choices=["one", "terrains", "runs"])
    options = parser.parse_args()
    seeds = range(options.first_seed, options.first_seed + options.seeds)
    lines = [line for seed in seeds for line in asked(seed, options.as_)]
    sets = [line for line in lines if "z" in line]
    print(f"sets {len(sets)}, refused {len(lines) - len(sets)}, "
          f"slowest {max(line.get('took', 0) for line in lines):.1f} s")  # fmt: skip
    for far in FAR:
        off = [line for line in sets if max(map(abs, line["z"].values())) > far]
        silent = [line for line in off if not line["said"]]
        print(f"a z beyond {far:g}: {share(len(off), len(sets))}, of which nothing is said of "
              f"{len(silent)}; {[line['seed'] for line in off]}")  # fmt: skip
    holds = [one for line in sets for one in line["holds"]]
    print(f"95 % intervals hold the truth: {share(sum(holds), len(holds))}")
    for name in NAMES:
        z = np.array([line["z"][name] for line in sets])
        print(f"{name}: rms z {np.sqrt(np.mean(z**2)):.2f}, beyond 3: {np.sum(np.abs(z) > FAR[0])}")


if __name__ == "__main__":
    main()
