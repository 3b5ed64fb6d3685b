"""Faults of recordings that misled and of which nothing was said, by the check and live.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.recordings.check_silent held [--live]
        [--only WORD]    # or dev

Recordings of data/motion (those of one half of `tests/blind/faults/bases.py`) and clean drives of
`tests/blind/any_robot.py` with a yaw that is turned a little, positions that are stretched a
little, and poses that are a little late or are corrected from some row on; and what looks like it.
A line for each: in how many something is named that is not said of the recording as it is. With
`--live` a velocity in other axes and poses in other frames instead, frame by frame for two minutes.
"""

import argparse
import os
import tempfile
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.checks.recording import check_recording
from odometry.recording.run import Run
from terrain.live.checked_so_far import CheckedSoFar
from tests.blind.any_robot import write_clean_run
from tests.blind.faults.bases import FIRST
from tests.studies.recordings.check_velocities import measured, with_velocity

SEEDS = {"dev": range(5000, 5040), "held": range(93000, 93060)}
LIVE_S = 125.0


def posed(change):
    """Another pose, by the columns t, x, y and yaw."""

    def changed(run):
        names = ("t", "x", "y", "yaw")
        columns = zip(names, change(*(run.pose[name] for name in names)), strict=True)
        return replace(run, pose=replace(run.pose, columns=run.pose.columns | dict(columns)))

    return changed


def antenna(ahead_m, left_m):
    return posed(
        lambda t, x, y, w: (
            t,
            x + ahead_m * np.cos(w) - left_m * np.sin(w),
            y + ahead_m * np.sin(w) + left_m * np.cos(w),
            w,
        )
    )


def corrected(turned_rad, aside_m, yaw=True):
    """From a moment of the middle half on, poses are turned about that place, or moved aside."""

    def change(t, x, y, w):
        rng = np.random.default_rng([len(t), round(100 * turned_rad + 1000 * aside_m)])
        at = np.searchsorted(t, rng.uniform(*np.quantile(t, [0.25, 0.75])))
        side, after = rng.uniform(-np.pi, np.pi), np.arange(len(t)) >= at
        angle = turned_rad * rng.choice([-1, 1]) * after
        dx, dy = x - x[at], y - y[at]
        x = x[at] + np.cos(angle) * dx - np.sin(angle) * dy + aside_m * after * np.cos(side)
        y = y[at] + np.sin(angle) * dx + np.cos(angle) * dy + aside_m * after * np.sin(side)
        return t, x, y, w + angle if yaw else np.nan * w

    return posed(change)


OFFLINE = {
    "as it is": posed(lambda t, x, y, w: (t, x, y, w)),
    "yaw + 0.05 rad": posed(lambda t, x, y, w: (t, x, y, w + 0.05)),
    "yaw + 0.1 rad": posed(lambda t, x, y, w: (t, x, y, w + 0.1)),
    "yaw - 0.15 rad": posed(lambda t, x, y, w: (t, x, y, w - 0.15)),
    "yaw + 0.2 rad": posed(lambda t, x, y, w: (t, x, y, w + 0.2)),
    "x times 1.05": posed(lambda t, x, y, w: (t, 1.05 * x, y, w)),
    "x times 1.1": posed(lambda t, x, y, w: (t, 1.1 * x, y, w)),
    "x times 0.92": posed(lambda t, x, y, w: (t, 0.92 * x, y, w)),
    "x times 1.1, no yaw": posed(lambda t, x, y, w: (t, 1.1 * x, y, np.nan * w)),
    "0.1 s late": posed(lambda t, x, y, w: (t + 0.1, x, y, w)),
    "antenna (0.3, 0.2) m": antenna(0.3, 0.2),
    "antenna (-0.5, 0) m": antenna(-0.5, 0.0),
    "positions 0.2 s late": posed(
        lambda t, x, y, w: (t, np.interp(t - 0.2, t, x), np.interp(t - 0.2, t, y), w)
    ),
    "corrected by 0.1 rad": corrected(0.1, 0.0),
    "corrected by 0.2 rad": corrected(0.2, 0.0),
    "corrected by 0.3 m": corrected(0.0, 0.3),
    "corrected by 0.6 m": corrected(0.0, 0.6),
    "corrected by 1 m": corrected(0.0, 1.0),
    "corrected by 0.6 m, no yaw": corrected(0.0, 0.6, yaw=False),
}


def velocity(change):
    """A measured velocity, at 5 Hz with 0.03 m/s of noise, in other axes."""
    return lambda run: with_velocity(run, change(measured(run, 5.0, 0.03, 0)))


LIVE = {
    "as it is": lambda run: run,
    "velocity as it is": velocity(lambda of: of),
    "velocity of the map": velocity(lambda of: replace(of, of_robot=of.of_map)),
    "velocity reversed": velocity(lambda of: replace(of, of_robot=-of.of_robot)),
    "velocity exchanged": velocity(lambda of: replace(of, of_robot=of.of_robot[:, ::-1])),
    "north before east": posed(lambda t, x, y, w: (t, y, x, np.pi / 2 - w)),
    "positions mirrored": posed(lambda t, x, y, w: (t, x, -y, w)),
    "yaw reversed": posed(lambda t, x, y, w: (t, x, y, -w)),
    "yaw in degrees": posed(lambda t, x, y, w: (t, x, y, np.degrees(w))),
}


def recordings(half, place):
    """With poses, and their yaw."""
    for folder in sorted((Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion").iterdir()):
        if (folder / "pose.csv").exists() and folder.name.startswith(FIRST) == (half == "dev"):
            yield replace(Run.read(folder), images=None)
    for seed in SEEDS[half]:
        write_clean_run(place / str(seed), seed)
        run = replace(Run.read(place / str(seed)), truth=None)
        if np.isfinite(run.pose["yaw"]).any():
            yield run


def named(run):
    return {f"{found.level} {found.name}" for found in check_recording(run).findings}


def said_live(run):
    """Whether anything is said within the first two minutes; None of a drive below one."""
    checked = CheckedSoFar(run.robot, (0.0, 0.0))
    begin_s, end_s = run.odometry.stamps_s[[0, -1]]
    if end_s - begin_s < 60.0:
        return None
    notes = []
    for frame in run.frames():
        if frame.stamp_s - begin_s < LIVE_S:
            checked.add(frame)
            notes += checked.notes()
    return bool(notes)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("half", choices=["dev", "held"])
    parser.add_argument("--live", action="store_true")
    parser.add_argument("--only", default="", help="faults whose words begin so")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        runs = list(recordings(options.half, Path(place)))
        if options.live:
            for words, change in LIVE.items():
                said = [one for run in runs if (one := said_live(change(run))) is not None]
                print(f"{words}: {sum(said)} of {len(said)}", flush=True)
            return
        before = [named(run) for run in runs]
        only = {words: of for words, of in OFFLINE.items() if words.startswith(options.only)}
        for words, change in only.items():
            pairs = zip(runs, before, strict=True)
            new = [", ".join(sorted(named(change(run)) - known)) for run, known in pairs]
            print(
                f"{words}, {len(runs)}: {dict(Counter(one or 'silent' for one in new))}", flush=True
            )


if __name__ == "__main__":
    main()
