"""Modes of whole runs held out: by motion alone, by feel alone, and by both.

    python -m tests.studies.modes.modes_feel FOLDER [--folds 5] [--made]

FOLDER holds run folders with imu.csv that name one terrain each. In each of five stratified folds
modes and feel are identified on the other runs, and each run held out is followed. Shares are of
the time of a run, the mean over terrains of the mean over runs, with 5 to 95 % of a bootstrap over
runs. `most probable` is the share in which the true terrain has the largest probability, named or
not. Nothing is chosen on these figures. `--made` evaluates runs that are made here instead:
vibration by terrain and speed, and yaw gains of which two are equal.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from odometry.feel.assessment.scores import class_weights
from odometry.feel.classifier.table import stratified_folds
from odometry.feel.identify_feel import identify_feel
from odometry.modes.follow.answers import named_modes
from odometry.modes.follow.feel_source import feel_source, with_feel
from odometry.modes.follow.mode_track import ModeTrack
from odometry.modes.follow.track import follow_modes
from odometry.modes.identify.identify_velocity import identify_velocity_modes
from odometry.modes.models.mode_set import DWELL_S, NO_MODES, ModeSet
from odometry.modes.modes_config import ModesConfig
from odometry.recording.run import Run
from tests.odometry.feel.feel_drives import drive

WAYS = ("motion alone", "feel alone", "both")
SHARES = ("right", "wrong", "most probable")
SPEEDS_M_S = (0.4, 0.6, 0.8)


def main() -> None:
    """Deal the folds, follow each run held out, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("--folds", type=int, default=5)
    parser.add_argument("--made", action="store_true")
    given = parser.parse_args()
    runs = made_runs() if given.made else real_runs(given.folder)
    labels = np.array([str(run.terrain) for run in runs], dtype=object)
    rng = np.random.default_rng(0)
    fold_of = stratified_folds(np.arange(len(runs)), labels, given.folds, rng)
    shares = np.empty((len(runs), len(WAYS), len(SHARES)))
    for fold in np.unique(fold_of):
        known = [run for run, of in zip(runs, fold_of, strict=True) if of != fold]
        modes = identify_velocity_modes(known)
        mode_set = ModeSet(modes, np.full(len(modes.names), DWELL_S))
        feel = identify_feel(known)
        for place in np.flatnonzero(fold_of == fold):
            source = feel_source(runs[place], feel, mode_set.names, mode_set.dwell_s)
            motion = follow_modes(runs[place], mode_set)
            both = with_feel(motion, source, mode_set.dwell_s, ModesConfig())
            shares[place] = [
                of_answers(motion, named_modes(motion, ModesConfig().sure), motion.probabilities),
                of_feel(both),
                of_answers(both, named_modes(both, ModesConfig().sure), both.probabilities),
            ]
        print(f"fold {fold}: {sum(fold_of == fold)} runs", flush=True)
    print_table(shares, labels)


def real_runs(folder: Path) -> list[Run]:
    """Those of a folder."""
    return [Run.read(file.parent) for file in sorted(folder.glob("*/run.toml"))]


def made_runs() -> list[Run]:
    """Eight of each terrain, 40 s each, at three speeds."""
    names = ("tiles", "gravel", "snow", "grates")
    return [
        drive(name, 50 * place + seed, seconds=40.0, speed=SPEEDS_M_S[seed % 3], turning=0.2)
        for place, name in enumerate(names)
        for seed in range(8)
    ]


def of_feel(track: ModeTrack) -> tuple[float, ...]:
    """Shares of feel alone, with the threshold of modes."""
    names = np.array(track.names, dtype=object)[track.felt.argmax(axis=1)]
    sure = track.felt.max(axis=1) >= ModesConfig().sure
    return of_answers(track, np.where(sure, names, NO_MODES[1]), track.felt)


def of_answers(
    track: ModeTrack, answers: np.ndarray, probabilities: np.ndarray
) -> tuple[float, ...]:
    """Shares of time with the right name, with a wrong one, and where the true one leads."""
    lasts_s = np.append(np.diff(track.stamps_s), 0.0)
    leads = np.array(track.names, dtype=object)[probabilities.argmax(axis=1)] == track.labels
    right = answers == track.labels
    wrong = ~right & ~np.isin(answers, NO_MODES)
    return tuple(float(lasts_s @ of / lasts_s.sum()) for of in (right, wrong, leads))


def print_table(shares: np.ndarray, labels: Sequence[str]) -> None:
    """A row for each way, intervals over runs, and what both add to feel alone."""
    weights = class_weights(np.asarray(labels))
    rng = np.random.default_rng(1)
    drawn = [resampled(rng, labels) for _ in range(2000)]
    print(f"{'':14}" + "".join(f"{name:>24}" for name in SHARES))
    for place, way in enumerate(WAYS):
        print(f"{way:14}", end="")
        for column in range(len(SHARES)):
            print(f"{said(shares[:, place, column], weights, drawn):>24}", end="")
        print()
    for name, other in (("both less motion", 0), ("both less feel", 1)):
        print(f"{name:18}", end="")
        for column in range(len(SHARES)):
            less = shares[:, 2, column] - shares[:, other, column]
            print(f"{said(less, weights, drawn):>24}", end="")
        print()
    for name in sorted(set(labels)):
        rows = np.asarray(labels) == name
        of = [" ".join(f"{100 * v:5.1f}" for v in shares[rows, i].mean(axis=0)) for i in range(3)]
        print(f"{name:12} " + " | ".join(of))


def resampled(rng: np.random.Generator, labels: Sequence[str]) -> np.ndarray:
    """Rows of a bootstrap within each terrain."""
    places = [np.flatnonzero(np.asarray(labels) == name) for name in sorted(set(labels))]
    return np.concatenate([rng.choice(of, len(of)) for of in places])


def said(values: np.ndarray, weights: np.ndarray, drawn: Sequence[np.ndarray]) -> str:
    """Weighed mean and interval in per cent."""
    mean = 100 * float(weights @ values / weights.sum())
    means = [100 * float(weights[rows] @ values[rows] / weights[rows].sum()) for rows in drawn]
    low, high = np.quantile(means, [0.05, 0.95])
    return f"{mean:.1f} [{low:.1f}, {high:.1f}]"


if __name__ == "__main__":
    main()
