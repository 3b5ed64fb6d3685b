"""Recordings as another IMU would give them: which names they get by feel, and what is refused.

Run `python -m tests.studies.feel.feel_sensors FOLDER`;
FOLDER holds run folders with imu.csv of all six
axes that name one terrain each. Whole runs are held out in five folds; each is evaluated as it is
and altered, by the model of the others as before (distances alone) and with the shape of its
spectrum.
"""

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.errors import OdometryError
from odometry.feel.assessment.selection import main_labels, selected
from odometry.feel.classifier.design import Design
from odometry.feel.classifier.members import fitted_members
from odometry.feel.classifier.sensor import SensorShape
from odometry.feel.classifier.table import FeelTable, stratified_folds
from odometry.feel.labels.felt import FeelConfig
from odometry.feel.labels.follow import Felt, check_repeats
from odometry.feel.model import FeelModel
from odometry.feel.recorded.signals import AXES
from odometry.feel.recorded.windows import FeelWindows, feel_windows
from odometry.recording.run import UNKNOWN, Run
from odometry.tables.table import Table
from tests.studies.feel.feel_alterations import ALTERED, Change

WINDOW_S = 2.0


def altered(run: Run, change: Change, model: FeelModel) -> FeelWindows | None:
    """Windows of the run as another IMU would give it; None where it is refused."""
    axes = change(np.stack([run.imu[name] for name in AXES]))
    columns = {**run.imu.columns, **dict(zip(AXES, axes, strict=True))}
    table = Table(run.imu.file, columns, np.arange(2, 2 + len(run.imu)))
    try:
        windows = feel_windows(replace(run, imu=table), WINDOW_S)
        model.design.check(windows, run.name)
        check_repeats(model, windows, run.name)
    except OdometryError:
        return None
    return windows


def fitted(runs: list[Run], windows: list[FeelWindows], known: np.ndarray) -> FeelModel:
    """The model of some of the runs, every choice made among them."""
    table = FeelTable.of(windows, Design.shared(windows))
    best = selected([table], np.arange(len(runs)), known, np.random.default_rng(0))
    names = tuple(sorted(set(main_labels(table, len(runs))[known])))
    members = fitted_members(table, known, names, [best.choice])[0]
    sensor = SensorShape.of([windows[row] for row in np.flatnonzero(known)], table.design)
    axes = table.design.axes
    repeats = max(windows[row].most_repeats(axes) for row in np.flatnonzero(known))
    return FeelModel(names, table.design, best.choice, members, best.calibration, best.strangeness,
                     best.limits, sensor, runs[0].robot.track_width, "",
                     repeats=repeats)  # fmt: skip


def answers(model: FeelModel, windows: FeelWindows, run: Run) -> list[float]:
    """Run right, wrong, unknown; windows right, wrong, unknown."""
    felt = Felt(model, FeelConfig(), windows, model.scores(windows), model.foreign(windows), run)
    of_run, of_windows = felt.answer_of_run[0], felt.answers[felt.windows.felt]
    rows = (np.array([of_run]), of_windows)
    return [
        float(np.mean(kind))
        for of in rows
        for kind in (
            of == run.terrain,
            np.isin(of.astype(str), model.names) & (of != run.terrain),
            of == UNKNOWN,
        )
    ]


def said(rows: list[list[list[float]]]) -> str:
    """Means over runs, before and with the shape."""
    means = np.mean(rows, axis=0) if rows else []
    return "; ".join(" ".join(f"{cell:.2f}" for cell in row) for row in means)


def main() -> None:
    """Print the shares."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    runs = [Run.read(file.parent) for file in sorted(folder.glob("*/run.toml"))]
    windows = [feel_windows(run, WINDOW_S) for run in runs]
    labels = np.array([run.terrain for run in runs], dtype=object)
    folds = stratified_folds(np.arange(len(runs)), labels, 5, np.random.default_rng(0))
    models = [fitted(runs, windows, folds != fold) for fold in range(5)]
    print("runs right, wrong, unknown; windows likewise: before; with the shape; runs refused")
    for name, change in ALTERED.items():
        found = [altered(run, change, models[fold]) for run, fold in zip(runs, folds, strict=True)]
        judged = [
            [answers(one, of, run) for one in (replace(models[fold], sensor=None), models[fold])]
            for run, of, fold in zip(runs, found, folds, strict=True)
            if of is not None
        ]
        print(f"{name:18s} {said(judged)}; {sum(of is None for of in found)}", flush=True)
    for name in models[0].names:
        known = labels != name
        model = fitted(runs, windows, known)
        rows = [
            [answers(one, windows[row], runs[row]) for one in (replace(model, sensor=None), model)]
            for row in np.flatnonzero(~known)
        ]
        print(f"left out {name}: {said(rows)}", flush=True)


if __name__ == "__main__":
    main()
