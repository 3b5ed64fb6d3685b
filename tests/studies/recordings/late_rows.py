"""Rows of odometry.csv with other stamps than those of the measurement: what is said, and lost.

    python -m tests.studies.recordings.late_rows [--held-out] [--only FAULT] [--arrival]
        [--tables NAMES]

Needs TERRAIN_ODOMETRY_DATA. The stamps of real recordings with poses are made faulty. For each
fault: what `check` finds that it does not find in the recording as it is (the first of each), and
the errors of `run` over 5 m of wheel travel, metres and degrees per metre of the odometer, the same
of the estimate on withheld poses, as the geometric mean of ratios to those without the fault.
True stamps are known: all errors are at the true poses and the true wheel travel. `--arrival` takes
the stamps as they are. `--tables pose` or `odometry,pose` have the stamps of other files faulty.
Drives are dealt into development and held out whole.
"""

import argparse
import math
import os
import zlib
from collections import Counter
from dataclasses import replace
from pathlib import Path as Folder

import numpy as np

import odometry.preparation.prepared as preparation
from odometry.checks.recording import check_recording
from odometry.recording.run import Run
from odometry.tables.table import Table
from terrain.main_job import run_odometry
from tests.odometry.arrivals import in_order
from tests.studies.main_job.estimation_reckoning import (
    HORIZON_M,
    Path,
    at,
    reference_path,
    wheel_travel_m,
)

DEVELOPMENT = (
    *("husky_2023", "marmotte", "warthog_2023", "warthog_asphalt_fast"),
    "warthog_grass_20240729_1404",
)


def bursts(t, rng, fewest, most):
    last = np.cumsum(rng.integers(fewest, most + 1, len(t)))
    last = np.append(last[last < len(t) - 1], len(t) - 1)
    return in_order(t[last[np.searchsorted(last, np.arange(len(t)))]])


def stalls(t, rng, every_s, lasts_s):
    begin_s = np.cumsum(every_s * rng.uniform(0.7, 1.3, int(t[-1] / every_s) + 2))
    late_s = t.copy()
    for at_s in begin_s:
        late_s[(t >= at_s) & (t < at_s + lasts_s)] = at_s + lasts_s
    return in_order(late_s)


def wait(t, rng, mean_s, share=1.0):
    return rng.exponential(mean_s, len(t)) * (rng.random(len(t)) < share)


def from_a_moment(t, rng):
    """Seconds since a moment in the first half, and the seconds left then."""
    begin_s = rng.uniform(0.05, 0.5) * np.ptp(t)
    return np.maximum(t - t[0] - begin_s, 0), np.ptp(t) - begin_s


def grows(t, rng, most_s):
    since_s, left_s = from_a_moment(t, rng)
    return t + most_s * since_s / left_s


def fills(t, rng, most_s):
    since_s, left_s = from_a_moment(t, rng)
    return t + most_s * (1 - np.exp(-since_s / (rng.uniform(0.1, 0.3) * left_s)))


def cut_off(t, steps):
    """The stamps in so many steps a second."""
    return np.floor(np.round(steps * t, 6)) / steps


FAULTS = {
    "none": lambda t, _: t,
    "late by chance, 20 ms": lambda t, rng: in_order(t + wait(t, rng, 0.02)),
    "50 ms": lambda t, rng: in_order(t + wait(t, rng, 0.05)),
    "120 ms": lambda t, rng: in_order(t + wait(t, rng, 0.12)),
    "200 ms": lambda t, rng: in_order(t + wait(t, rng, 0.2)),
    "200 ms, gamma of 4": lambda t, rng: in_order(t + rng.gamma(4, 0.05, len(t))),
    "120 ms, out of order": lambda t, rng: t + wait(t, rng, 0.12),
    "5 % by 200 ms": lambda t, rng: in_order(t + wait(t, rng, 0.2, 0.05)),
    "bursts of 3 to 20": lambda t, rng: bursts(t, rng, 3, 20),
    "bursts of 20": lambda t, rng: bursts(t, rng, 20, 20),
    "read each 0.33 s": lambda t, _: in_order(0.33 * np.ceil(t / 0.33)),
    "stalls of 1 s each 10 s": lambda t, rng: stalls(t, rng, 10, 1),
    "stalls of 1 s each 30 s": lambda t, rng: stalls(t, rng, 30, 1),
    "a stall of 1 s a minute": lambda t, rng: stalls(t, rng, 60, 1),
    "stalls of 0.3 s each 10 s": lambda t, rng: stalls(t, rng, 10, 0.3),
    "before and after, by 50 ms": lambda t, rng: in_order(t + rng.normal(0, 0.05, len(t))),
    "120 ms, whole ms": lambda t, rng: cut_off(in_order(t + wait(t, rng, 0.12)), 1000),
    "120 ms, rounded to 10 ms": lambda t, rng: np.round(in_order(t + wait(t, rng, 0.12)), 2),
    "5 % by 200 ms, whole ms": lambda t, rng: cut_off(in_order(t + wait(t, rng, 0.2, 0.05)), 1000),
    "bursts of 3 to 20, whole ms": lambda t, rng: cut_off(bursts(t, rng, 3, 20), 1000),
    "stalls of 1 s each 10 s, whole ms": lambda t, rng: cut_off(stalls(t, rng, 10, 1), 1000),
    "a stall of 1 s a minute, whole ms": lambda t, rng: cut_off(stalls(t, rng, 60, 1), 1000),
    "whole 0.1 s": lambda t, _: cut_off(t, 10),
    "rounded to 0.1 s": lambda t, _: np.round(t, 1),
    "whole 0.25 s": lambda t, _: cut_off(t, 4),
    "whole s": lambda t, _: cut_off(t, 1),
    "rounded to s": lambda t, _: np.round(t),
    "whole s, 120 ms late": lambda t, rng: cut_off(in_order(t + wait(t, rng, 0.12)), 1),
    "grows to 0.15 s": lambda t, rng: grows(t, rng, 0.15),
    "grows to 0.5 s": lambda t, rng: grows(t, rng, 0.5),
    "fills to 0.3 s": lambda t, rng: fills(t, rng, 0.3),
    "a clock 0.3 % fast from a moment": lambda t, rng: t + 0.003 * from_a_moment(t, rng)[0],
    "steps by 0.3 s": lambda t, rng: t + 0.3 * (t - t[0] > rng.uniform(0.2, 0.8) * np.ptp(t)),
    "0.3 s by turns, each 2 min": lambda t, _: t + 0.15 * (1 - np.cos(2 * np.pi * t / 120)),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--held-out", action="store_true")
    parser.add_argument("--only", action="append", choices=sorted(FAULTS), help="repeat")
    parser.add_argument("--arrival", action="store_true", help="stamps are not made even")
    parser.add_argument("--tables", default="odometry", help="names, with commas")
    options = parser.parse_args()
    tables = options.tables.split(",")
    if options.arrival:
        preparation.with_even_rows = lambda run, _: (run, ())
    folder = Folder(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion"
    names = [path.parent.name for path in sorted(folder.glob("*/pose.csv"))]
    runs = [
        Run.read(folder / name)
        for name in names
        if name.startswith(DEVELOPMENT) != options.held_out
    ]
    as_is = [(said(run), errors(run, run)) for run in runs]
    for fault in options.only or FAULTS:
        print_fault(fault, tables, runs, as_is)


def print_fault(fault, tables, runs, as_is):
    """What is said first, and by how many times errors grow, mean and (worst)."""
    first, ratios = Counter(), []
    for run, (known, before) in zip(runs, as_is, strict=True):
        late = faulty(run, fault, tables)
        new = [name for name in said(late) if name not in known]
        first[new[0] if new else "-"] += 1
        ratios.append(errors(late, run) / before)
    mean, worst = np.exp(np.nanmean(np.log(ratios), axis=0)), np.nanmax(ratios, axis=0)
    print(f"{fault:27} {dict(first.most_common())}", *(f"{r:.2f} ({w:.2f})" for r, w in
          zip(mean, worst, strict=True)), flush=True)  # fmt: skip


def faulty(run, fault, names):
    """The run with the stamps of a fault in some tables; rows as a reader leaves them."""
    return replace(run, **{name: arrived(getattr(run, name), run.name, fault) for name in names})


def arrived(table, name, fault):
    rng = np.random.default_rng(zlib.crc32(f"{name} {fault}".encode()))
    stamps_s = FAULTS[fault](table.stamps_s, rng)
    rows = np.argsort(stamps_s, kind="stable")
    columns = {name: column[rows] for name, column in table.columns.items()}
    late = Table(table.file, {**columns, "t": stamps_s[rows]}, np.arange(2, len(rows) + 2))
    return late.without_repeated()


def said(run):
    return [finding.name for finding in check_recording(run).findings]


def errors(run, true):
    """Metres and degrees per metre (4,) of the odometer, and of the estimate where withheld."""
    result = run_odometry(run, vision=False)
    reference = reference_path(true)
    travel_m = wheel_travel_m(true, reference.stamps_s)
    pose = result.second.withheld.run.pose
    withheld = np.isin(true.pose.lines, pose.lines[~np.isfinite(pose["x"])])
    used = np.isin(reference.stamps_s, true.pose.stamps_s[withheld])
    found = []
    for path, chosen in (
        (result.replay.odometer(), np.ones(len(used), dtype=bool)),
        (result.second.replay.trajectory(), used),
    ):
        begun = reference.stamps_s >= path.stamps_s[0]
        found += window_errors(path, reference, travel_m, chosen & begun)
    return np.array(found)


def window_errors(path, reference, travel_m, chosen):
    """Mean error of position and of heading between chosen poses 5 m of wheel travel apart."""
    ends = np.searchsorted(travel_m, travel_m + HORIZON_M)
    begins = np.flatnonzero((ends < len(travel_m)) & chosen)
    begins = begins[chosen[ends[begins]]]
    seen = at(Path(path.stamps_s, path.poses), reference.stamps_s)
    off = [
        between(seen[a], seen[b]) - between(reference.poses[a], reference.poses[b])
        for a, b in zip(begins, ends[begins], strict=True)
    ]
    metres = [math.hypot(x, y) for x, y, _ in off]
    radians = [abs(math.remainder(turn, 2 * math.pi)) for _, _, turn in off]
    return [np.mean(metres) / HORIZON_M, math.degrees(np.mean(radians)) / HORIZON_M]


def between(begin, end):
    """An end pose seen from a begin pose."""
    dx, dy, turn = end - begin
    cosine, sine = math.cos(begin[2]), math.sin(begin[2])
    return np.array([cosine * dx + sine * dy, cosine * dy - sine * dx, turn])


if __name__ == "__main__":
    main()
