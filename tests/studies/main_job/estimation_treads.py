"""What a tread does to the filter that reports what is not its own speed for a while.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.main_job.estimation_treads [--seven]
        [--draw 0]

Each recording gets, at a moment drawn at random from its middle half and for 3 to 15 s, each of
`FAULTS`. A row (JSON) shows the parameter that is farthest off 1, 10 and 60 s after the end, in
deviations that `estimate.csv` states, against the same recording untouched; place and yaw
likewise; and what was said that is not said of the untouched recording.
"""

import argparse
import json
import zlib
from dataclasses import replace

import numpy as np

from odometry.recording.run import Run
from tests.studies.main_job.estimation_outputs import outputs_of, with_columns
from tests.studies.main_job.estimation_recordings import SEVEN, motion, recordings
from tests.studies.main_job.estimation_stuck import TREADS, moving_s

SHORTEST_S, LONGEST_S = 3.0, 15.0
LATE_S, SMOOTH_S = 0.5, 0.5
LATER_S = 1.0, 10.0, 60.0
PARAMETERS = "y_left", "y_right", "x_icr", "alpha_left", "alpha_right", "gyro_bias"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seven", action="store_true", help="the seven that are held out")
    parser.add_argument("--draw", type=int, default=0)
    arguments = parser.parse_args()
    for name in recordings(seven=arguments.seven):
        if (name in SEVEN) != arguments.seven:
            continue
        run = Run.read(motion() / name)
        plain = outputs_of(run)
        rng = np.random.default_rng([arguments.draw, zlib.crc32(name.encode())])
        for fault, change in FAULTS.items():
            begin_s = float(rng.choice(moving_s(run)))
            end_s = begin_s + float(rng.uniform(SHORTEST_S, LONGEST_S))
            found = outputs_of(changed(run, change, begin_s, end_s, int(rng.integers(2))))
            row = {"recording": name, "fault": fault, **figures(plain, found, end_s)}
            print(json.dumps(row), flush=True)


def changed(run, change, begin_s, end_s, tread):
    """The run whose treads report something else for a while."""
    stamps_s, speeds = run.odometry.stamps_s, run.odometry.stack(*TREADS)
    inside = (stamps_s >= begin_s) & (stamps_s < end_s)
    reported = speeds.copy()
    reported[inside] = change(stamps_s, speeds, inside, tread)[inside]
    columns = dict(zip(TREADS, reported.T, strict=True))
    return replace(run, odometry=with_columns(run.odometry, **columns))


def late(stamps_s, speeds, _, tread):
    then = np.searchsorted(stamps_s, stamps_s - LATE_S, side="right") - 1
    return _with(speeds, tread, speeds[np.maximum(then, 0), tread])


def clipped(_, speeds, inside, __):
    most = np.abs(speeds[inside]).max() / 2
    return np.clip(speeds, -most, most)


def commanded(stamps_s, speeds, _, tread):
    period_s = float(np.median(np.diff(stamps_s)))
    weights = np.exp(-0.5 * (np.arange(-30, 31) * period_s / SMOOTH_S) ** 2)
    return _with(speeds, tread, np.convolve(speeds[:, tread], weights / weights.sum(), "same"))


FAULTS = {
    "mirrored": lambda _, speeds, __, tread: speeds[:, [1 - tread, 1 - tread]],
    "exchanged": lambda _, speeds, __, ___: speeds[:, ::-1],
    "late": late,
    "without_sign": lambda _, v, __, tread: _with(v, tread, np.abs(v[:, tread])),
    "halved": lambda _, v, __, tread: _with(v, tread, v[:, tread] / 2),
    "clipped": clipped,
    "commanded": commanded,
}


def _with(speeds, tread, column):
    after = speeds.copy()
    after[:, tread] = column
    return after


def figures(plain, found, end_s):
    """How many deviations parameters, place and yaw are off later, and what was said."""
    before, after = plain.tables["estimate"], found.tables["estimate"]
    row = {}
    for later_s in LATER_S:
        at_s = end_s + later_s
        if at_s > after["t"][-1]:
            continue
        off = {name: _apart(before, after, at_s, name) for name in (*PARAMETERS, "x", "y", "yaw")}
        sigma = {
            name: max(np.interp(at_s, after["t"], after[f"sigma_{name}"]), 1e-9) for name in off
        }
        worst = max(PARAMETERS, key=lambda name: off[name] / sigma[name])
        place = np.hypot(off["x"], off["y"]) / np.hypot(sigma["x"], sigma["y"])
        yaw = off["yaw"] / sigma["yaw"]
        row[f"after_{later_s:.0f}_s"] = [off[worst] / sigma[worst], worst, float(place), yaw]
    return {**row, "said": sorted(_said(found) - _said(plain))}


def _apart(before, after, at_s, name):
    apart = np.interp(at_s, after["t"], after[name]) - np.interp(at_s, before["t"], before[name])
    return float(abs(np.angle(np.exp(1j * apart)) if name == "yaw" else apart))


def _said(outputs):
    """Kinds and times of events, and notes."""
    of_filter = {f"{each['kind']} {each['begin_s']:.0f}" for each in outputs.events}
    return of_filter | {note[:60] for note in outputs.result["notes"]}


if __name__ == "__main__":
    main()
