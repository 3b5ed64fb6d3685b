"""Terrain by feel on recordings: whole runs held out, terrains and speeds left out of training.

    python -m tests.studies.feel.feel FOLDER [--seeds 3] [--window 2.0 ...]
        [--only nested unknown speeds]

FOLDER holds run folders with imu.csv that name one terrain each; the folds are drawn so many
times, for windows of each length [s].
"""

import argparse
import time
from pathlib import Path

import numpy as np

from odometry.feel.assessment.assessment import LENGTHS, assessed, speed_alone
from odometry.feel.assessment.calibration_words import calibration_words
from odometry.feel.assessment.held_out import HeldOut, by_length, judged_runs, scored, windows_alone
from odometry.feel.assessment.limits import STRETCH_S
from odometry.feel.assessment.scores import area, balanced_accuracy, bootstrap_interval
from odometry.feel.assessment.selection import main_labels, selected
from odometry.feel.classifier.design import Design
from odometry.feel.classifier.strangeness import unknown_probability
from odometry.feel.classifier.table import FeelTable, stratified_folds
from odometry.feel.labels.felt import FeelConfig
from odometry.feel.recorded.windows import feel_windows
from odometry.recording.run import Run

SLOW_M_S = 0.3  # mean speed of a run: slower ones train, faster ones are evaluated, and back
SURE = 0.9


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, default=3, help="Times that the folds are dealt.")
    parser.add_argument("--window", type=float, nargs="+", default=[2.0])
    parser.add_argument("--only", choices=["nested", "unknown", "speeds"], nargs="+")
    given = parser.parse_args()
    runs = [Run.read(file.parent) for file in sorted(given.folder.glob("*/run.toml"))]
    tables = []
    for window_s in given.window:
        began_s = time.process_time()
        windows = [feel_windows(run, window_s) for run in runs]
        each_ms = 1e3 * (time.process_time() - began_s) / sum(map(len, windows))
        tables.append(FeelTable.of(windows, Design.shared(windows)))
        count = len(tables[-1])
        print(f"{len(runs)} runs, {count} windows of {window_s:g} s, {each_ms:.2f} ms each")
    parts = given.only or ["nested", "unknown", "speeds"]
    if "nested" in parts:
        nested(tables, len(runs), given.seeds)
    if "unknown" in parts:
        unknown(tables[0], len(runs))
    if "speeds" in parts:
        other_speeds(tables[0], len(runs))


def nested(tables, runs, seeds):
    """Whole runs held out in five folds, dealt anew for each seed; all chosen inside."""
    found = []
    for seed in range(seeds):
        began_s = time.process_time()
        found.append(assessed(tables, np.arange(runs), seed))
        print(f"seed {seed}, {time.process_time() - began_s:.0f} s of processor time")
        for words in found[-1].to_table()["chosen_in_folds"]:
            print(f"  {words}", flush=True)
    for name in LENGTHS:
        rows = [one.by_length[name].to_table(one.names) for one in found]
        means = {
            key: np.mean([row[key] for row in rows], axis=0)
            for key in (
                "balanced_accuracy",
                "interval",
                "calibration_error",
                "refused",
                "mean_excess",
                "error_by_chance",
                "error_by_chance_of_runs",
            )
        }
        spread = np.ptp([row["balanced_accuracy"] for row in rows])
        print(f"{name}: {shown(means)}, over folds dealt anew {spread:.3f}")
        print(f"  {calibration_words(means)}; too sure by {means['mean_excess']:+.3f}")
    for name in found[0].by_groups:
        print(f"  windows, {name}: {np.mean([one.by_groups[name] for one in found]):.3f}")
    for length in ("window", "run"):
        print(f"  by answer, {length}: {found[0].to_table()[length]['confusion']}", flush=True)


def shown(means):
    low, high = means["interval"]
    return (
        f"{means['balanced_accuracy']:.3f} ({low:.3f} to {high:.3f}), calibration error "
        f"{means['calibration_error']:.3f}, refused {means['refused']:.3f}"
    )


def unknown(table, runs):
    """Each terrain in turn is left out of training, and a fifth of the known runs beside it.

    Each fifth once, so that each known run is evaluated once and each unknown one five times.
    """
    labels, groups = main_labels(table, runs), np.arange(runs)
    lines = {length: [] for length in LENGTHS}
    for name in table.names:
        rng = np.random.default_rng(0)
        others = labels != name
        folds = np.full(runs, -1)
        folds[others] = stratified_folds(groups[others], labels[others], 5, rng)
        found = {length: ([], []) for length in LENGTHS}
        for fold in range(5):
            known = others & (folds != fold)
            best = selected([table], groups, known, rng)
            names = tuple(one for one in table.names if one != name)
            for kind, runs_of in enumerate((folds == fold, labels == name)):
                rows = np.flatnonzero(runs_of[table.runs])
                of = HeldOut(rows, scored(table, known, names, rows, [best.choice])[0])
                for length, one in answers(table, of, best, names).items():
                    found[length][kind].append(one)
        for length, (known_ones, never) in found.items():
            lines[length].append(figures(np.hstack(known_ones), np.hstack(never)))
            print(f"without {name}, {length}: {said(lines[length][-1])}", flush=True)
    for length, of in lines.items():
        print(f"mean over terrains, {length}: {said(np.mean(of, axis=0))}")


def answers(table, held_out, best, names):
    """Rows of log odds, refused, probability, whether named and named rightly; by length."""
    found = {}
    for length, of in by_length(table, held_out, best.calibration, STRETCH_S).items():
        odds = best.limits.log_odds(best.strangeness, of.windows, of.offsets)
        among = best.calibration.probabilities(of.evidence, of.windows)
        refused = best.limits.refused(of.windows, of.novelty, of.offsets)
        given = among.max(axis=1) * (1 - unknown_probability(odds, best.strangeness.share))
        named = ~refused & (given >= FeelConfig().sure)
        right = np.array(names, dtype=object)[among.argmax(axis=1)] == of.labels
        found[length] = np.array([odds, refused, given * ~refused, named, named & right])
    return found


def figures(known, never):
    """Area; of both: refused, named, named with SURE; of the known: named wrongly."""
    return [
        area(known[0], never[0]),
        *(of for row in (1, 3) for of in (known[row].mean(), never[row].mean())),
        (known[3] - known[4]).mean(),
        *((of[2] >= SURE).mean() for of in (known, never)),
    ]


def said(figures_of):
    return (
        "area {:.2f}; unknown {:.3f} of known, {:.3f} of left out; named with 0.6 or more {:.3f} "
        "of known, {:.3f} of left out ({:.3f} of known wrongly); with 0.9 {:.3f} and {:.3f}"
    ).format(*figures_of)


def other_speeds(table, runs):
    """Slow runs train and fast ones are evaluated, and back; beside it what speed alone says."""
    speeds = np.array([table.speeds_m_s[table.runs == run].mean() for run in range(runs)])
    slow = speeds < SLOW_M_S
    groups = np.arange(runs)
    for name, fitted in (("slow", slow), ("fast", ~slow)):
        known = set(table.labels[fitted[table.runs]].tolist())
        best = selected([table], groups, fitted, np.random.default_rng(0))
        (judged,) = judged_runs(table, fitted, ~fitted, [best.choice])
        held = windows_alone(table, judged, best.calibration)
        answer = np.array(table.names, dtype=object)[held.evidence.argmax(axis=1)]
        right = answer == held.labels
        low, high = bootstrap_interval(held.labels, right, held.runs)
        own = balanced_accuracy(held.labels, right)
        print(
            f"{name} runs train ({', '.join(sorted(known))}), the others are evaluated: {own:.3f} "
            f"({low:.3f} to {high:.3f}), of {len(set(held.labels.tolist()))} terrains; speed alone "
            f"{speed_alone(table, fitted.astype(int)):.3f} (both ways)"
        )


if __name__ == "__main__":
    main()
