"""Whether the errors of the filter are as large as it says: NEES and NIS over seeds, in simulation.

    python -m tests.studies.main_job.estimation_consistency [--seeds 20] [--duration 60]
        [--gyroscope]
        [--real [--seven]]

The true state is drawn from the filter's estimate at its start; it wanders by the process
noise of its settings, and poses and yaw rates are measured with theirs. Then the mean of N runs
lies within the 95 % bounds of chi-squared (Bar-Shalom, Li and Kirubarajan 2001, 5.4.2) at 95 % of
the steps. The steps of one run are dependent, so that the whole mean spreads more than the bounds.
Nobody watches the sensors: white slip turns the robot by jumps that would be held out as spikes.
It is also ten times the variance at which the filter weighs the yaw rate of treads, whose slip it
takes to last: with the gyroscope, the estimate of the width is overconfident under it.
Open loop: the odometer's error under the covariance in odometer.csv after 5, 20 and 100 m, also
(--real, TERRAIN_ODOMETRY_DATA) on recordings with poses that are cut at four moments.
"""

import argparse
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2
from tqdm import tqdm

from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.frames import Frame
from odometry.recording.run import Run
from odometry.recording.run_span import Span, cut_run
from tests.studies.main_job.estimation_outputs import outputs_of
from tests.studies.main_job.estimation_reckoning import Path, at, reference_path, wheel_travel_m
from tests.studies.main_job.estimation_recordings import motion, recordings
from tests.studies.main_job.estimation_simulation import (
    TRACK_WIDTH_M,
    Noise,
    drive,
    frames_of,
    run_of,
    weave,
)

ICRS = np.array([0.42, -0.38, -0.05])
ICR_SIGMA_M = 0.05
NAMES = ("y_left", "y_right", "x_icr")
PLACE = ("x", "y", "yaw")
OF_WIDTH = np.array([0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0])  # y_left - y_right
HORIZONS_M = (5.0, 20.0, 100.0)


@dataclass(frozen=True)
class Squares:
    """Normalised squared errors of one run at its steps; NaN where nothing is estimated."""

    pose: np.ndarray
    state: np.ndarray
    innovation: np.ndarray
    width: np.ndarray
    size: int


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--duration", type=float, default=60.0)
    parser.add_argument("--gyroscope", action="store_true")
    parser.add_argument("--real", action="store_true", help="recordings, open loop alone")
    parser.add_argument("--seven", action="store_true", help="only those of the final figure")
    arguments = parser.parse_args()
    if arguments.real:
        print_open_loops(real_open_loops(seven=arguments.seven))
        return
    runs = [
        closed_loop(seed, arguments.duration, gyroscope=arguments.gyroscope)
        for seed in tqdm(range(arguments.seeds), "closed loop")
    ]
    for name, degrees in (
        ("pose", 3),
        ("state", runs[0].size),
        ("innovation", 3),
        ("width", 1),
    ):
        print_line(name, np.stack([getattr(run, name) for run in runs]), degrees)
    open_loops = [
        open_loop(seed, gyroscope=arguments.gyroscope)
        for seed in tqdm(range(arguments.seeds), "open loop")
    ]
    print_open_loops(open_loops)


def parameters():
    """The prior: a table with a covariance."""
    values = dict(zip(NAMES, ICRS.tolist(), strict=True))
    covariance = ICR_SIGMA_M**2 * np.eye(3)
    return ParameterSet({"ground": TerrainParameters("icr", values, NAMES, covariance)})


def matching_noise(config):
    """The noise that the settings of the filter describe; what a version does not have is none.

    The treads turn the robot with the noise of slip, whether a gyroscope measures it or not.
    """
    return Noise(
        position=config.position_noise,
        yaw=config.yaw_noise,
        slip=getattr(config, "slip_noise", 0.0),
        icr_m=config.icr_noise_widths * TRACK_WIDTH_M,
        alpha=getattr(config, "alpha_noise", 0.0),
        gyro=getattr(config, "gyro_noise", 0.0),
        bias=getattr(config, "bias_noise", 0.0),
        pose_m=config.position_sigma_m,
        pose_rad=config.yaw_sigma_rad,
    )


def drawn_drive(ekf, duration_s, rng):
    """A drive from a state that is drawn from the filter's estimate at its start.

    The pose at the start is measured with the noise of every pose.
    """
    standing = Frame(0.0, np.zeros(2), 0, np.zeros(3), None, yaw_rate_rad_s=0.0)
    prior = ekf.start(standing, "ground")
    size = len(prior.mean)
    state = np.array([0.0, 0.0, 0.0, *ICRS, 0.0, 1.0, 1.0])
    state[3:size] = rng.multivariate_normal(prior.mean[3:], prior.covariance[3:, 3:])
    return drive(weave(duration_s, rng), state, matching_noise(ekf.config), rng)


def closed_loop(seed, duration_s, *, gyroscope):
    """NEES of pose, whole state and y_left - y_right, and NIS of poses, of one run of frames."""
    rng = np.random.default_rng(seed)
    ekf = IcrEkf(TRACK_WIDTH_M, parameters(), IcrEkfConfig(watch_sensors=False))
    one = drawn_drive(ekf, duration_s, rng)
    first, *frames = frames_of(one, gyroscope=gyroscope)
    estimates = [ekf.start(first, "ground")]
    for frame in frames:
        estimates.append(ekf.step(estimates[-1], frame, "ground"))
    pose, state, width = [], [], []
    for estimate, truth in zip(estimates, one.states, strict=True):
        error = estimate.mean - truth[: len(estimate.mean)]
        error[2] = np.angle(np.exp(1j * error[2]))
        pose.append(squared(error[:3], estimate.covariance[:3, :3]))
        state.append(squared(error, estimate.covariance))
        width.append((OF_WIDTH @ error) ** 2 / (OF_WIDTH @ estimate.covariance @ OF_WIDTH))
    innovations = [e.innovation.normalised_squared if e.innovation else np.nan for e in estimates]
    return Squares(*map(np.array, (pose, state, innovations, width)), len(error))


def open_loop(seed, *, gyroscope):
    """Normalised squared errors (3,) of the odometer after each horizon; None without covariance.

    The filter beside it has poses, so that the odometer learns its ICRs as it would.
    """
    ekf = IcrEkf(TRACK_WIDTH_M, parameters(), IcrEkfConfig())
    one = drawn_drive(ekf, 150.0, np.random.default_rng([seed, 1]))
    run = run_of(one, gyroscope=gyroscope)
    table = outputs_of(run, parameters=parameters()).tables["odometer"]
    return squares_at_horizons(run, table, Path(one.stamps_s, one.states[:, :3]))


def real_open_loops(*, seven):
    """The same of recordings with poses, from four moments of each on."""
    found = []
    for name in tqdm(recordings(seven=seven), "recordings"):
        run = Run.read(motion() / name)
        for share in (0.0, 0.25, 0.5, 0.75):
            part = cut_run(run, Span(share * float(np.ptp(run.odometry.stamps_s))))
            table = outputs_of(part).tables["odometer"]
            found.append(squares_at_horizons(part, table, reference_path(part)))
            if found[-1] is None:
                return found
            print(f"{name} from {share:.0%}: {np.round(found[-1], 1)}", flush=True)
    return found


def squares_at_horizons(run, table, reference):
    """Normalised squared errors after 5, 20 and 100 m; NaN where the run is shorter.

    Where the covariance begins at zero, it is of the motion since the start: the truth is placed
    at the start of the odometer.
    """
    covariances = covariances_of(table)
    if covariances is None:
        return None
    stamps_s = table["t"]
    if not covariances[0].any():
        reference = placed(reference, stamps_s[0], np.array([table[n][0] for n in PLACE]))
    travel = wheel_travel_m(run, stamps_s)
    found = []
    for horizon_m in HORIZONS_M:
        row = int(np.searchsorted(travel - travel[0], horizon_m))
        if row == len(stamps_s) or stamps_s[row] > reference.stamps_s[-1]:
            found.append(np.nan)
            continue
        truth = at(reference, stamps_s[row : row + 1])[0]
        error = np.array([table[name][row] for name in PLACE]) - truth
        error[2] = np.angle(np.exp(1j * error[2]))
        found.append(squared(error, covariances[row]))
    return found


def print_open_loops(found):
    if found[0] is None:
        print("open loop: odometer.csv has no covariance")
        return
    for column, horizon_m in zip(np.array(found).T, HORIZONS_M, strict=True):
        squares = column[np.isfinite(column)]
        low, high = chi2.ppf([0.025, 0.975], 3 * len(squares)) / max(len(squares), 1)
        inside = np.mean(squares <= chi2.ppf(0.95, 3))
        print(f"odometer after {horizon_m:3.0f} m, expected 3: mean {squares.mean():.2f}, bounds "
              f"{low:.2f} to {high:.2f}, median {np.median(squares):.2f} (expected "
              f"{chi2.ppf(0.5, 3):.2f}), {inside:.0%} of {len(squares)} within 95 %")  # fmt: skip


def placed(path, begin_s, start):
    """The path moved and turned so that it goes through a pose at a stamp."""
    x, y, yaw = at(path, np.array([begin_s]))[0]
    way = (path.poses[:, :2] - [x, y]) @ [1, 1j] * np.exp(1j * (start[2] - yaw))
    poses = [start[0] + way.real, start[1] + way.imag, path.poses[:, 2] + start[2] - yaw]
    return Path(path.stamps_s, np.stack(poses, axis=-1))


def covariances_of(table):
    """Covariances (N, 3, 3) of x, y, yaw from columns sigma_* and covariance_*_*, if there."""
    if any(f"sigma_{name}" not in table for name in PLACE):
        return None
    sigmas = np.stack([table[f"sigma_{name}"] for name in PLACE], axis=-1)
    covariances = np.einsum("ni,ij->nij", np.square(sigmas), np.eye(3))
    for i, one in enumerate(PLACE):
        for j, other in enumerate(PLACE[:i]):
            column = table.get(f"covariance_{other}_{one}")
            if column is not None:
                covariances[:, i, j] = covariances[:, j, i] = column
    return covariances


def squared(error, covariance):
    """Squared Mahalanobis length; NaN where the covariance is singular."""
    if np.linalg.cond(covariance) > 1e14:
        return np.nan
    return float(error @ np.linalg.solve(covariance, error))


def print_line(name, squares, degrees):
    """Mean over runs and steps, and at how many steps the mean over runs lies in the bounds."""
    told = np.isfinite(squares).all(axis=0)
    means = squares[:, told].mean(axis=0)
    low, high = chi2.ppf([0.025, 0.975], degrees * len(squares)) / len(squares)
    inside = np.mean((means >= low) & (means <= high))
    print(f"{name:22} expected {degrees}: mean {means.mean():.2f}, bounds of a step "
          f"{low:.2f} to {high:.2f}, {inside:.1%} of {told.sum()} steps inside, "
          f"medians {np.median(squares[:, told]):.2f} "
          f"(expected {chi2.ppf(0.5, degrees):.2f})")  # fmt: skip


if __name__ == "__main__":
    main()
