"""Feel where it is weak: files of one drive taken for runs, and labels of terrains never felt.

    python -m tests.studies.feel.feel_weak FOLDER [--only parts names labels]
        [--seeds 100 101 102 103]

FOLDER holds run folders with imu.csv that name one terrain each.
Parts: of each terrain three drives are drawn, each is cut into three files, and all other drives
are judged by a model whose files are runs by clocks of their own, and by one that knows the drives.
Names: those of one or two pairs of recordings are exchanged; which recordings are noted.
Labels: `label --by-feel` of whole runs held out in five folds, and of each terrain left out.
"""

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.feel.assessment.assessment import assessed
from odometry.feel.assessment.doubted_runs import LEAST_OWN
from odometry.feel.assessment.scores import balanced_accuracy
from odometry.feel.classifier.design import Design
from odometry.feel.classifier.table import FeelTable, stratified_folds
from odometry.feel.identify_feel import identify_feel
from odometry.feel.labels.felt import FeelConfig
from odometry.feel.labels.follow import Felt
from odometry.feel.recorded.windows import feel_windows
from odometry.recording.run import UNKNOWN, Run
from odometry.recording.run_span import Span, cut_run
from odometry.tables.table import Table
from terrain.labelling.felt_terrain import LONG_S, STRETCH_S, SURE, sure_labels
from tests.studies.feel.feel_sensors import fitted

DRIVES, FILES = 3, 3
LEAST_WINDOWS = 20
LIKELY = 0.7
NAME_SEEDS = range(80, 86)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="+", default=["parts", "names", "labels"])
    parser.add_argument("--seeds", type=int, nargs="+", default=[100, 101, 102, 103])
    given = parser.parse_args()
    runs = [Run.read(file.parent) for file in sorted(given.folder.glob("*/run.toml"))]
    windows = [feel_windows(run) for run in runs]
    if "parts" in given.only:
        parts(runs, windows, given.seeds)
    if "names" in given.only:
        exchanged(runs, windows)
    if "labels" in given.only:
        labels(runs, windows)


def parts(runs, windows, seeds):
    """Printed accuracy of windows, that on other drives, and named rightly and wrongly there."""
    long = np.array([one.felt.sum() >= LEAST_WINDOWS for one in windows])
    names = np.array([run.terrain for run in runs], dtype=object)
    for clocks in (True, False):
        rows = []
        for seed in seeds:
            rng = np.random.default_rng(seed)
            drawn = [
                place
                for name in sorted(set(names))
                for place in rng.choice(np.flatnonzero(long & (names == name)), DRIVES, False)
            ]
            model = identify_feel([file for at in drawn for file in files_of(runs[at], at, clocks)])
            others = np.setdiff1d(np.arange(len(runs)), drawn)
            found = [felt(model, windows[at], runs[at]) for at in others]
            printed = model.report["window"]["balanced_accuracy"]
            rows.append([printed, accuracy(found, names[others]), *shares(found, names[others])])
        print(f"{'files as runs' if clocks else 'drives':14s}", np.mean(rows, axis=0).round(3))


def files_of(run, number, clocks):
    """A drive as files of its own folders, perhaps each by a clock of its own."""
    lasts_s = float(np.ptp(run.odometry.stamps_s)) / FILES
    cut = [cut_run(run, Span(lasts_s * i, lasts_s * (i + 1))) for i in range(FILES)]
    files = [replace(of, folder=Path(f"{of.folder}_{i}")) for i, of in enumerate(cut)]
    began_s = 1e4 * number + (100.0 * np.arange(FILES) if clocks else np.zeros(FILES))
    return [
        replace(of, odometry=later(of.odometry, by_s), imu=later(of.imu, by_s))
        for of, by_s in zip(files, began_s, strict=True)
    ]


def later(table, by_s):
    return Table(table.file, {**table.columns, "t": table["t"] + by_s}, table.lines)


def felt(model, windows, run, **config):
    return Felt(
        model, FeelConfig(**config), windows, model.scores(windows), model.foreign(windows), run
    )


def accuracy(found, true):
    """Balanced accuracy of the most probable terrain by window."""
    rows = [(one.windows.felt, one) for one in found]
    answers = [
        np.array(one.model.names, dtype=object)[one.probabilities.argmax(axis=1)][at]
        for at, one in rows
    ]
    labels = np.repeat(true, [len(of) for of in answers])
    return balanced_accuracy(labels, np.concatenate(answers) == labels)


def shares(found, true):
    """Share of the time of a run, equal weights of terrains: right, wrong, wrong with LIKELY."""
    rows = []
    for one, name in zip(found, true, strict=True):
        at = one.windows.felt
        answers, sure = one.lasting_answers[at], one.lasting_probabilities[at].max(axis=1)
        wrong = np.isin(answers.astype(str), one.model.names) & (answers != name)
        rows.append([(answers == name).mean(), wrong.mean(), (wrong & (sure > LIKELY)).mean()])
    return by_terrain(np.array(rows), true)


def by_terrain(rows, true):
    return np.mean([rows[true == name].mean(axis=0) for name in sorted(set(true))], axis=0)


def exchanged(runs, windows):
    """How many recordings whose names were exchanged are noted, and how many others."""
    noted = np.zeros((2, 2), dtype=int)
    long = np.array([one.felt.sum() >= LEAST_WINDOWS for one in windows])
    true = np.array([run.terrain for run in runs], dtype=object)
    for seed in NAME_SEEDS:
        rng, named = np.random.default_rng(seed), true.copy()
        for _ in range(1 + seed % 2):
            names = rng.choice(sorted(set(true)), 2, replace=False)
            some = long & (named == true)
            one, other = (rng.choice(np.flatnonzero(some & (true == name))) for name in names)
            named[[one, other]] = true[[other, one]]
        tables = [of_name(one, name) for one, name in zip(windows, named, strict=True)]
        table = FeelTable.of(tables, Design.shared(tables))
        answers = assessed([table], np.arange(len(runs)), seed).by_length["run"]
        own = answers.probabilities[
            np.arange(len(runs)), np.searchsorted(table.names, answers.labels)
        ]
        wrong = (named != true)[answers.runs]
        for place, kind in enumerate((wrong, ~wrong)):
            noted[place] += (own[kind] < LEAST_OWN).sum(), kind.sum()
    print("exchanged: noted {} of {}; right: noted {} of {}".format(*noted.ravel()))


def of_name(windows, name):
    labels = np.where(windows.labels == UNKNOWN, UNKNOWN, name).astype(object)
    return replace(windows, labels=labels)


def labels(runs, windows):
    """Right and wrong labels, as shares of the time of a run, by 4 s alone and with 10 s."""
    true = np.array([run.terrain for run in runs], dtype=object)
    folds = stratified_folds(np.arange(len(runs)), true, 5, np.random.default_rng(0))
    for kind, left_out in (("known", folds), ("left out", true)):
        rows = np.zeros((len(runs), 2, 2))
        for of in sorted(set(left_out.tolist())):
            model = fitted(runs, windows, left_out != of)
            for at in np.flatnonzero(left_out == of):
                one = felt(model, windows[at], runs[at], stretch_s=STRETCH_S, sure=SURE)
                for place, long_s in enumerate((STRETCH_S, LONG_S)):
                    given, _ = sure_labels(one, long_s)
                    named = given[one.windows.felt]
                    rows[at, place] = (named == true[at]).mean(), wrong_share(named, true[at])
        print(kind, "by 4 s", by_terrain(rows[:, 0], true).round(4),
              "with 10 s", by_terrain(rows[:, 1], true).round(4))  # fmt: skip


def wrong_share(named, true):
    return ((named != "") & (named != true)).mean()


if __name__ == "__main__":
    main()
