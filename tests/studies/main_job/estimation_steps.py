"""What steps of the tread speeds do to the ICRs that the filter learns.

    python -m tests.studies.main_job.estimation_steps [--first-seed 0] [--seeds 60]

Clean drives with a gyroscope and measured yaw (`tests/blind/any_robot.py`), their tread speeds as
they are and in steps of 2, 5 and 10 % of the fastest, what is left of a tick counting in the next
row. A row for each: the parameter that is farthest off at the end in deviations, and the learned
y_left - y_right over the true one.
"""

import argparse
import tempfile
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.recording.run import Run
from terrain.main_job import run_odometry
from tests.blind.any_robot import write_clean_run

SHARES = (0.0, 0.02, 0.05, 0.1)
PARAMETERS = {"y_left": 3, "y_right": 4, "x_icr": 5, "alpha_left": 7, "alpha_right": 8}


def clean_drive(seed):
    """Robot, run and truth."""
    with tempfile.TemporaryDirectory() as place:
        robot = write_clean_run(Path(place) / "run", seed)
        run = Run.read(Path(place) / "run")
        truth = np.genfromtxt(Path(place) / "run" / "truth.csv", delimiter=",", names=True)
    return robot, run, truth


def in_steps(run, step_m_s):
    if not step_m_s:
        return run
    counted = np.cumsum(run.odometry.stack("v_left", "v_right"), axis=0) / step_m_s
    left, right = step_m_s * np.diff(np.round(counted), axis=0, prepend=0.0).T
    columns = run.odometry.columns | {"v_left": left, "v_right": right}
    return replace(run, odometry=replace(run.odometry, columns=columns))


def farthest_and_width(replay, truth):
    mean, sigma = replay.means[-1], replay.sigmas[-1]
    off = max(abs(mean[at] - truth[name]) / sigma[at] for name, at in PARAMETERS.items())
    return off, (mean[3] - mean[4]) / (truth["y_left"] - truth["y_right"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--seeds", type=int, default=60)
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    found = {share: [] for share in SHARES}
    for seed in range(options.first_seed, options.first_seed + options.seeds):
        robot, run, _ = clean_drive(seed)
        if run.yaw_rate is None or np.isnan(run.pose["yaw"]).any() or len(run.pose) > 20000:
            continue
        for share in SHARES:
            coarse = in_steps(run, share * robot.fastest_m_s)
            replay = run_odometry(coarse, vision=False).replay
            found[share].append(farthest_and_width(replay, robot.truth))
        last = [found[share][-1] for share in SHARES]
        print(seed, robot.way, *(f"{off:.1f}, {width:.2f};" for off, width in last), flush=True)
    for share, rows in found.items():
        off, width = np.array(rows).T
        print(f"steps of {share:.0%}: beyond 3 deviations {np.sum(off > 3)} of {len(off)}, width "
              f"off by {np.median(np.abs(width - 1)):.1%} in the median, "
              f"{np.quantile(np.abs(width - 1), 0.9):.1%} in nine of ten")  # fmt: skip


if __name__ == "__main__":
    main()
