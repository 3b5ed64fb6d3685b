"""Terrain by feel on recordings: whole runs held out, terrains and speeds never felt.

Run `python -m tests.studies.feel FOLDER`; FOLDER holds run folders with imu.csv that name one
terrain each.
"""

import argparse
import time
from pathlib import Path

import numpy as np

from odometry.feel.assessment import LENGTHS, assessed
from odometry.feel.design import Design
from odometry.feel.evidence import softmax
from odometry.feel.folds import stratified_folds
from odometry.feel.held_out import HeldOut, put_together, scores_of, told_of, windows_alone
from odometry.feel.members import columns_of, fitted_members
from odometry.feel.model import Limits
from odometry.feel.scores import area, balanced_accuracy, bootstrap_interval
from odometry.feel.selection import STRETCH_S, main_labels, selected
from odometry.feel.speed_alone import speed_alone
from odometry.feel.table import FeelTable
from odometry.feel.windows import feel_windows
from odometry.run import Run

SLOW_M_S = 0.3  # mean speed of a run: slower ones train, faster ones are judged, and back


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, default=3, help="Times that the folds are dealt.")
    parser.add_argument("--window", type=float, default=2.0)
    given = parser.parse_args()
    runs = [Run.read(file.parent) for file in sorted(given.folder.glob("*/run.toml"))]
    began_s = time.perf_counter()
    windows = [feel_windows(run, given.window) for run in runs]
    each_ms = 1e3 * (time.perf_counter() - began_s) / sum(map(len, windows))
    table = FeelTable.of(windows, Design.shared(windows))
    print(f"{len(runs)} runs, {len(table)} windows of {given.window:g} s, {each_ms:.2f} ms each")
    if given.seeds:
        nested(table, len(runs), given.seeds)
    unknown(table, len(runs))
    other_speeds(table, len(runs))


def nested(table, runs, seeds):
    """Whole runs held out in five folds, and one by one; the folds dealt anew for each seed."""
    for folds in (5, runs):
        found = [assessed(table, np.arange(runs), seed, folds) for seed in range(seeds)]
        for name in LENGTHS:
            rows = [one.by_length[name].to_table(table.names) for one in found]
            means = {
                key: np.mean([row[key] for row in rows], axis=0)
                for key in ("balanced_accuracy", "interval", "calibration_error", "refused")
            }
            spread = np.ptp([row["balanced_accuracy"] for row in rows])
            print(f"{folds} folds, {name}: {shown(means)}, over folds dealt anew {spread:.3f}")
        for name in found[0].by_groups:
            groups = np.mean([one.by_groups[name] for one in found])
            print(f"  windows, {name}: {groups:.3f}")
        if folds == 5:
            print(f"  windows by answer: {found[0].to_table()['window']['confusion']}")
            print(f"  runs by answer: {found[0].to_table()['run']['confusion']}")
        seeds = 1  # of runs held out one by one there is one way


def shown(means):
    low, high = means["interval"]
    return (
        f"{means['balanced_accuracy']:.3f} ({low:.3f} to {high:.3f}), calibration error "
        f"{means['calibration_error']:.3f}, refused {means['refused']:.3f}"
    )


def unknown(table, runs):
    """Each terrain in turn is never felt; known runs are held out in five folds beside it."""
    labels, groups = main_labels(table, runs), np.arange(runs)
    for name in table.names:
        rng = np.random.default_rng(0)
        others = labels != name
        folds = np.full(runs, -1)
        folds[others] = stratified_folds(groups[others], labels[others], 5, rng)
        scores = {length: ([], []) for length in LENGTHS}
        refused, sure = [], []
        for fold in range(5):
            known = others & (folds != fold)
            best = selected(table, groups, known, rng)
            limits = Limits.of(best.windows, best.stretches, table.speeds_m_s)
            told = told_of(table, known, folds == fold, best.choice)
            never = judged(table, known, labels == name, best.choice)
            for place, one in enumerate((told, never)):
                scores["window"][place].append(one.novelty)
                for length, lasts_s in (("stretch", STRETCH_S), ("run", np.inf)):
                    scores[length][place].append(put_together(table, one, lasts_s).novelty)
            refused.append((never.novelty > limits.window).mean())
            alone = windows_alone(table, never)
            probabilities = best.calibration.probabilities(
                alone.log_likelihoods[:, np.array(table.names) != name], np.ones(len(alone))
            )
            bold = (probabilities.max(axis=1) >= 0.9) & (never.novelty <= limits.window)
            sure.append(bold.mean())
        areas = [area(*map(np.concatenate, scores[length])) for length in LENGTHS]
        print(
            f"without {name}: area by window, stretch, run "
            f"{', '.join(f'{one:.3f}' for one in areas)}; windows refused {np.mean(refused):.2f}, "
            f"named with 0.9 or more {np.mean(sure):.2f}"
        )


def judged(table, fitted, others, choice):
    """Windows of runs whose terrain the fitted runs do not hold."""
    names = tuple(sorted(set(table.labels[fitted[table.runs]].tolist())))
    rows = np.flatnonzero(others[table.runs])
    members = fitted_members(table, fitted, names, choice)
    tables = [one[rows] for one in table.tables]
    columns = columns_of(tables, table.covariates, choice.parts(table.design))
    log_likelihoods, novelty = scores_of(members, columns)
    among = np.tile(log_likelihoods.min(axis=1)[:, None], len(table.names))
    among[:, np.searchsorted(table.names, names)] = log_likelihoods
    return HeldOut(rows, among, novelty)


def other_speeds(table, runs):
    """Slow runs train and fast ones are judged, and back; beside it what speed alone tells."""
    speeds = np.array([table.speeds_m_s[table.runs == run].mean() for run in range(runs)])
    slow = speeds < SLOW_M_S
    groups = np.arange(runs)
    for name, fitted in (("slow", slow), ("fast", ~slow)):
        known = set(table.labels[fitted[table.runs]].tolist())
        best = selected(table, groups, fitted, np.random.default_rng(0))
        told = windows_alone(table, told_of(table, fitted, ~fitted, best.choice))
        said = np.array(table.names, dtype=object)[softmax(told.log_likelihoods).argmax(axis=1)]
        right = said == told.labels
        low, high = bootstrap_interval(told.labels, right, told.runs)
        own = balanced_accuracy(told.labels, right)
        print(
            f"{name} runs train ({', '.join(sorted(known))}), the others are judged: {own:.3f} "
            f"({low:.3f} to {high:.3f}), of {len(set(told.labels.tolist()))} terrains; speed alone "
            f"{speed_alone(table, fitted.astype(int)):.3f} (both ways)"
        )


if __name__ == "__main__":
    main()
