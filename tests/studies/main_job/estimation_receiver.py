"""Estimates beside a receiver without yaw whose positions scatter and wander.

    python -m tests.studies.main_job.estimation_receiver [--first-seed 0] [--seeds 60] [--smooth]

Clean drives (`tests/blind/any_robot.py`), their poses replaced by true places with white noise of
0.2 to 1.5 m and errors that last for 10 to 120 s (Gauss-Markov), none to twice the white ones;
with --smooth such a white noise makes the errors that last, and a thirtieth of it scatters. A
row for each: the parameter that is farthest off at the end in deviations, the learned
y_left - y_right over the true one, and the share of the second half in which the place, and the
yaw, is off by more than three deviations; of the place also the root mean square in deviations
of one axis (1: as large as claimed).
"""

import argparse
import warnings
from dataclasses import replace

import numpy as np

from odometry.tables.table import Table
from terrain.main_job import run_odometry
from tests.studies.main_job.estimation_steps import clean_drive, farthest_and_width

SELDOM = ("gnss", "slow slam")  # true places too seldom to draw lines between them
SHARES = (0.0, 0.5, 1.0, 2.0)  # of the white noise: the errors that last


def with_receiver(run, truth, rng, *, smooth=False):
    """The run beside a receiver: white noise, rate and share of the errors that last."""
    rate_hz, white_m = rng.choice([1.0, 2.0, 5.0]), np.exp(rng.uniform(*np.log([0.2, 1.5])))
    share, lasts_s = rng.choice(SHARES), rng.uniform(10.0, 120.0)
    at_s = np.arange(truth["t"][0] + rng.uniform(0, 1), truth["t"][-1], 1 / rate_hz)
    keeps = np.exp(-1 / (rate_hz * lasts_s))
    columns = {"t": at_s, "yaw": np.full(len(at_s), np.nan)}
    for axis in ("x", "y"):
        wander = np.empty(len(at_s))
        wander[0], pushes = rng.normal(), np.sqrt(1 - keeps**2) * rng.normal(size=len(at_s))
        for i in range(1, len(at_s)):
            wander[i] = keeps * wander[i - 1] + pushes[i]
        scatter, lasting = (1 / 30, 1.0) if smooth else (1.0, share)
        off_m = white_m * (scatter * rng.normal(size=len(at_s)) + lasting * wander)
        columns[axis] = np.interp(at_s, truth["t"], truth[axis]) + off_m
    ordered = {name: columns[name] for name in ("t", "x", "y", "yaw")}
    return replace(run, pose=Table(run.pose.file, ordered, np.arange(2, len(at_s) + 2))), share


def figures(run, truth, robot):
    """Farthest parameter, width, shares beyond three deviations (place, yaw), place in sigmas."""
    replay = run_odometry(run, vision=False).replay
    off, width = farthest_and_width(replay, robot.truth)
    later = slice(len(replay.stamps_s) // 2, None)
    true = [np.interp(replay.stamps_s, truth["t"], truth[name]) for name in ("x", "y")]
    true.append(np.interp(replay.stamps_s, truth["t"], np.unwrap(truth["yaw"])))
    apart = (replay.means[:, :3] - np.stack(true, axis=-1))[later]
    sigmas = replay.sigmas[later, :3]
    place = np.hypot(*apart[:, :2].T) / np.hypot(*sigmas[:, :2].T)
    yaw = np.abs((apart[:, 2] + np.pi) % (2 * np.pi) - np.pi) / sigmas[:, 2]
    return (off, width, np.mean(place > 3), np.mean(yaw > 3), np.sqrt(np.mean(place**2)),
            np.sqrt(np.mean(apart[:, 0] ** 2 + apart[:, 1] ** 2)))  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--seeds", type=int, default=60)
    parser.add_argument("--smooth", action="store_true")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    rows = []
    for seed in range(options.first_seed, options.first_seed + options.seeds):
        robot, run, truth = clean_drive(seed)
        if len(truth) > 20000 or robot.source in SELDOM:
            continue
        received, share = with_receiver(
            run, truth, np.random.default_rng([seed, 3]), smooth=options.smooth
        )
        rows.append((run.yaw_rate is not None, share, *figures(received, truth, robot)))
        print(seed, robot.way, robot.source, *(f"{value:.2f}" for value in rows[-1]), flush=True)
    table = np.array(rows)
    for gyroscope in (True, False):
        for shares in (SHARES[:1], SHARES[1:]):
            chosen = table[(table[:, 0] == gyroscope) & np.isin(table[:, 1], shares)]
            if not len(chosen):
                continue
            off, width, place, yaw, sigmas, error_m = chosen[:, 2:].T
            print(f"gyroscope {gyroscope}, lasting {shares}: {len(chosen)} drives; a parameter "
                  f"beyond 3 deviations {np.sum(off > 3)}, beyond 5 {np.sum(off > 5)}; width below "
                  f"half {np.sum(width < 0.5)}; place beyond 3 for more than 5 % of the time "
                  f"{np.sum(place > 0.05)}, yaw {np.sum(yaw > 0.05)}; place in deviations "
                  f"{np.median(sigmas):.2f} [{sigmas.min():.2f}, {sigmas.max():.2f}]; "
                  f"off by {np.median(error_m):.2f} m")  # fmt: skip


if __name__ == "__main__":
    main()
