"""Modes of robots of any size and pace: what `modes` names, clean and with faults.

    python -m tests.studies.modes.modes_any_robot [--first-seed 0] [--seeds 40]
        [--out modes_any_robot]

Each seed is a robot of `tests/blind/modes/any_robot.py` whose three terrains are identified, and
three drives of it: a clean one, one whose motion no mode describes from a moment on, and one whose
record is at fault. Shares are of the time from the onset on. Each drive is a row of cases.csv,
written as soon as it is known; seeds that are in it are not done again.
"""

import argparse
import csv
import tempfile
import time
from itertools import pairwise
from pathlib import Path

import numpy as np

import odometry
from odometry.errors import OdometryError
from odometry.modes.follow.answers import refusals
from odometry.modes.models.mode_set import DWELL_S, NO_MODES, NONE_OF_THESE, UNDETERMINED
from odometry.positions.heading import headed
from tests.blind.modes import any_robot

COLUMNS = (
    *("seed", "kind", "right", "wrong", "none", "right_all", "wrong_all"),
    *("track_m", "fastest_m_s", "sharpest_rad_s", "odometry_hz", "source", "gyro_noise", "reason"),
    "cpu_s",
)
PACES_RAD_S = (0.0, 0.1, 0.5, np.inf)  # of the sharpest turn


def run(study, what, name):
    """Do a study of a seed for each seed asked for, and print its tables."""
    parser = argparse.ArgumentParser(description=what.split("\n", 1)[0])
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--seeds", type=int, default=40)
    parser.add_argument("--out", type=Path, default=Path(name))
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    file = options.out / "cases.csv"
    rows = list(csv.DictReader(file.open(encoding="utf-8"))) if file.exists() else []
    known = {int(row["seed"]) for row in rows}
    with file.open("a", newline="", encoding="utf-8") as stream:
        sheet = csv.DictWriter(stream, COLUMNS)
        if not rows:
            sheet.writeheader()
        for seed in range(options.first_seed, options.first_seed + options.seeds):
            if seed not in known:
                for row in study(seed):
                    rows.append(row)
                    sheet.writerow(row)
                    print(*(row[name] for name in COLUMNS), sep="  ", flush=True)
                stream.flush()
    print("\n".join(table_of(rows)))


def study(seed):
    """The rows of one robot; a single one where it was refused."""
    kinds = (
        "clean",
        any_robot.OUTSIDE[seed % len(any_robot.OUTSIDE)],
        any_robot.RECORD[seed % len(any_robot.RECORD)],
    )
    return studied(any_robot.world_of(seed), seed, kinds)


def studied(world, seed, kinds, drives=2):
    """The rows of these drives of a robot, calibrated on so many of each terrain."""
    robot = world.robot
    about = dict.fromkeys(COLUMNS, "") | {
        "seed": str(seed),
        "track_m": f"{robot.track_m:.3g}",
        "fastest_m_s": f"{robot.fastest_m_s:.3g}",
        "sharpest_rad_s": f"{robot.sharpest_rad_s:.3g}",
        "odometry_hz": f"{world.odometry_hz:.3g}",
        "source": world.source or "none",
        "gyro_noise": f"{world.gyro_noise_rad_s:.2g}",
    }
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        begin = time.process_time()
        written = any_robot.write_calibration(world, seed, folder)
        try:
            modes = identified([of for of in written if int(of.name.rpartition("_")[2]) < drives])
        except OdometryError as error:
            return [about | {"kind": "identify", "reason": _one_line(error)}]
        rows = []
        for kind in kinds:
            onset_s = any_robot.write_case(world, seed, kind, folder / kind)
            row = about | {"kind": kind}
            try:
                row |= judged(read(folder / kind), modes, onset_s)
            except OdometryError as error:
                row |= {"reason": _one_line(error)}
            rows.append(row | {"cpu_s": f"{time.process_time() - begin:.1f}"})
            begin = time.process_time()
        return rows


def identified(folders):
    """Velocity modes of the calibration, as `identify-modes` finds them."""
    modes = odometry.identify_velocity_modes([read(folder) for folder in folders])
    return odometry.ModeSet(modes, np.full(len(modes.names), DWELL_S))


def read(folder):
    """A run, its yaw found where it was not measured, as the commands do."""
    return headed([odometry.Run.read(folder)]).runs[0]


def judged(run, modes, onset_s):
    """Shares of the time, from the onset on and of all, and the tests that refuse the most."""
    found = odometry.followed(run, modes)
    answers, labels = found.answers(found.motion), found.motion.labels
    lasts_s = np.append(np.diff(found.motion.stamps_s), 0.0)
    named = ~np.isin(answers, NO_MODES)
    right, wrong = named & (answers == labels), named & (answers != labels)
    after = lasts_s * (found.motion.stamps_s >= onset_s)
    shares = {
        "right": after @ right / after.sum(),
        "wrong": after @ wrong / after.sum(),
        "none": after @ (answers == NONE_OF_THESE) / after.sum(),
        "right_all": lasts_s @ right / lasts_s.sum(),
        "wrong_all": lasts_s @ wrong / lasts_s.sum(),
    }
    open_ = lasts_s * (answers == UNDETERMINED)
    refused = {
        name: open_ @ of / max(lasts_s.sum(), 1e-9)
        for name, of in refusals(found.motion, found.config.sure).items()
    }
    most = sorted(refused.items(), key=lambda one: -one[1])[:3]
    reason = ", ".join(f"{name} {share:.2f}" for name, share in most if share > 0)
    return {name: f"{share:.4f}" for name, share in shares.items()} | {"reason": reason}


def table_of(rows):
    """Means by kind of drive and by pace, and the worst drives."""
    done = [row for row in rows if row["wrong"]]
    lines = ["kind  drives  right  wrong  none  worst"]
    groups = {
        "clean": ("clean",),
        "outside": any_robot.OUTSIDE,
        "record": any_robot.RECORD,
    }
    groups |= {kind: (kind,) for kind in (*any_robot.OUTSIDE, *any_robot.RECORD)}
    for name, kinds in groups.items():
        lines += _line(name, [row for row in done if row["kind"] in kinds])
    for low, high in pairwise(PACES_RAD_S):
        for name in ("clean", "outside", "record"):
            of = [row for row in done if low <= float(row["sharpest_rad_s"]) < high]
            label = f"{low:g} to {high:g} rad/s, {name}"
            lines += _line(label, [row for row in of if row["kind"] in groups[name]])
    refused = [row for row in rows if not row["wrong"]]
    return [*lines, *(f"refused: {row['seed']} {row['kind']}: {row['reason']}" for row in refused)]


def _line(name, rows):
    if not rows:
        return []
    shares = np.array([[float(row[key]) for key in ("right", "wrong", "none")] for row in rows])
    means = "  ".join(f"{100 * share:.1f}" for share in shares.mean(axis=0))
    return [f"{name}  {len(rows)}  {means}  {100 * shares[:, 1].max():.1f}"]


def _one_line(error):
    return " ".join(str(error).split())[:200]


if __name__ == "__main__":
    run(study, __doc__, "modes_any_robot")
