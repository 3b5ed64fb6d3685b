"""What robots that are stuck or slip, and poses that are held, do to the filter on recordings.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.main_job.estimation_stuck [--seven] [--draw 0]

Each recording gets, at moments drawn at random from its middle half, a robot that is stuck twice (3
to 12 s are inserted: treads go on with noise, poses and gyroscope stay with theirs) and poses that
are held once (up to 6 s: the pose of the first moment with another noise); a tread that spins (1.8
times as fast) and treads that slip (2.2 times) for so long. A row shows what was noticed; how many
of its deviations a slip factor is off 1 and 10 s after the end, against the same recording
untouched; how much larger the deviation of the position is in the half minute after, and for how
many seconds after the end it is more than three times as large.
"""

import argparse
import os
import zlib
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.recording.run import Run
from odometry.tables.table import Table
from tests.studies.main_job.estimation_outputs import outputs_of, with_columns
from tests.studies.main_job.estimation_recordings import SEVEN

SHORTEST_S, LONGEST_S, LONGEST_HELD_S = 3.0, 12.0, 6.0
MOVES_M_S = 0.3
WIDE = 3.0  # times the deviation of the recording untouched
NOISES = {"x": 0.01, "y": 0.01, "yaw": 0.005, "gyro_z": 0.01}
SLIP_FACTORS = ("alpha_left", "alpha_right")
TREADS = ("v_left", "v_right")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seven", action="store_true", help="the seven that are held out")
    parser.add_argument("--draw", type=int, default=0)
    arguments = parser.parse_args()
    for folder in sorted((Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion").iterdir()):
        if not folder.is_dir() or (folder.name in SEVEN) != arguments.seven:
            continue
        run = Run.read(folder)
        if run.pose is None or not len(moments := moving_s(run)):
            continue
        rng = np.random.default_rng([arguments.draw, zlib.crc32(folder.name.encode())])
        plain = outputs_of(run).tables["estimate"]
        for change in (stuck, stuck, held, spinning, slipping):
            begin_s = float(rng.choice(moments))
            longest_s = LONGEST_HELD_S if change is held else LONGEST_S
            lasts_s = min(float(rng.uniform(SHORTEST_S, LONGEST_S)), longest_s)
            changed, added_s = change(run, begin_s, lasts_s, rng)
            found = outputs_of(changed)
            print(folder.name, change.__name__, *figures(plain, found, begin_s, lasts_s, added_s))


def moving_s(run):
    """Stamps of the middle half of a run at which a tread moves."""
    stamps_s = run.odometry.stamps_s
    share = (stamps_s - stamps_s[0]) / np.ptp(stamps_s)
    speeds = np.abs(run.odometry.stack("v_left", "v_right")).max(axis=1)
    return stamps_s[(share > 0.25) & (share < 0.7) & (speeds > MOVES_M_S)]


def stuck(run, begin_s, lasts_s, rng):
    """The run with seconds inserted in which the robot stays, and how many."""
    tables = {
        name: _lengthened(getattr(run, name), begin_s, lasts_s, rng)
        for name in ("odometry", "pose", "imu")
        if getattr(run, name) is not None
    }
    longer = replace(run, **tables)
    return longer, float(longer.odometry.stamps_s[-1] - run.odometry.stamps_s[-1])


def _lengthened(table, begin_s, lasts_s, rng):
    """The table with its last row before a stamp repeated for a while, with noise."""
    stamps_s = table.stamps_s
    at = int(np.searchsorted(stamps_s, begin_s))
    period_s = float(np.median(np.diff(stamps_s[max(0, at - 50) : at + 50])))
    count = round(lasts_s / period_s)
    rows = np.r_[:at, np.full(count, max(at - 1, 0)), at : len(stamps_s)]
    columns = {name: column[rows].copy() for name, column in table.columns.items()}
    inside = slice(at, at + count)
    columns["t"][inside] += period_s * (1 + np.arange(count))
    columns["t"][at + count :] += period_s * count
    for name in TREADS:
        if name in columns:
            columns[name][inside] *= rng.normal(1, 0.03, count)
    for name, sigma in NOISES.items():
        if name in columns:
            middle = 0.0 if name == "gyro_z" else columns[name][inside]
            columns[name][inside] = middle + rng.normal(0, sigma, count)
    return Table(table.file, columns, np.arange(2, len(rows) + 2))


def held(run, begin_s, lasts_s, rng):
    """The run with the pose of a moment for a while, with noise; nothing is inserted."""
    stamps_s = run.pose.stamps_s
    inside = (stamps_s >= begin_s) & (stamps_s < begin_s + lasts_s)
    columns = {}
    for name in ("x", "y", "yaw"):
        column = run.pose[name].copy()
        kept = column[np.searchsorted(stamps_s, begin_s)]
        column[inside] = kept + rng.normal(0, NOISES[name] / 2, inside.sum())
        columns[name] = column
    return replace(run, pose=with_columns(run.pose, **columns)), 0.0


def spinning(run, begin_s, lasts_s, rng):
    """The run with one tread that turns faster than the robot goes."""
    return _faster(run, begin_s, lasts_s, {str(rng.choice(TREADS)): 1.8}), 0.0


def slipping(run, begin_s, lasts_s, rng):  # noqa: ARG001 - of the face of changes
    """The run with both."""
    return _faster(run, begin_s, lasts_s, dict.fromkeys(TREADS, 2.2)), 0.0


def _faster(run, begin_s, lasts_s, times):
    stamps_s = run.odometry.stamps_s
    inside = (stamps_s >= begin_s) & (stamps_s < begin_s + lasts_s)
    columns = {
        name: np.where(inside, factor, 1.0) * run.odometry[name] for name, factor in times.items()
    }
    return replace(run, odometry=with_columns(run.odometry, **columns))


def figures(plain, found, begin_s, lasts_s, added_s):
    """What was noticed, how far slip factors are off in their deviations, how unsure places are."""
    after, end_s = found.tables["estimate"], begin_s + lasts_s
    off = [
        max(
            abs(_at(after, at_s, name) - _at(plain, at_s - added_s, name))
            / _at(after, at_s, f"sigma_{name}")
            for name in SLIP_FACTORS
        )
        for at_s in (min(end_s + later_s, after["t"][-1]) for later_s in (1, 10))
    ]
    then = (after["t"] > end_s + 2) & (after["t"] < end_s + 30)
    wider = np.median(
        _sigma_m(after, after["t"][then]) / _sigma_m(plain, after["t"][then] - added_s)
    )
    later_s = after["t"][after["t"] > end_s]
    ratios = _sigma_m(after, later_s) / _sigma_m(plain, later_s - added_s)
    wide_s = np.diff(later_s, append=later_s[-1])[ratios > WIDE].sum()
    noticed = Counter(event["kind"] for event in found.events)
    return *(f"{each:.2f}" for each in (*off, wider, wide_s)), dict(sorted(noticed.items()))


def _at(table, stamps_s, name):
    return np.interp(stamps_s, table["t"], table[name])


def _sigma_m(table, stamps_s):
    return np.hypot(_at(table, stamps_s, "sigma_x"), _at(table, stamps_s, "sigma_y"))


if __name__ == "__main__":
    main()
