"""Noisy positions: the filter with the usual noise of poses, that of the recording, or the true.

    python -m tests.studies.main_job.estimation_noise

Needs TERRAIN_ODOMETRY_DATA. Eight recordings; their positions get white noise, and are thinned,
with yaw (0.03 rad) and without. Mean distance of the estimate from the poses as they were, and
mean error of the odometer over 5 m of wheel travel, per metre.
"""

import argparse
from dataclasses import replace

import numpy as np

from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.evaluation.odometer_uncertainty import path_of
from odometry.geometry import se2
from odometry.preparation.pose_noise import with_pose_noise
from odometry.recording.run import Run
from odometry.replays.pipeline import ConstantTerrain, replay
from tests.studies.main_job.estimation_recordings import motion

RECORDINGS = (
    "warthog_grass_20240729_1446",
    "husky_2023_s04",
    "marmotte_boreal_20240125_1215_s02",
    "warthog_gravel_20240806_1137_s02",
    "warthog_sand_20240925_1413_s02",
    "warthog_2023_s00",
    "warthog_ice_20240730_1630_s02",
    "warthog_asphalt_fast_20240807_1130_s01",
)
SIGMAS_M, RATES_HZ, YAW_RAD = (0.1, 0.3, 1.0), (1.0, 5.0), 0.03
HORIZON_M, SETTLED_S = 5.0, 10.0


def main():
    argparse.ArgumentParser(description=__doc__).parse_args()
    print("yaw, Hz, m: taken as (range); estimate [m] and odometer [m per m] with the usual noise, "
          "that of the recording, the true")  # fmt: skip
    for with_yaw in (True, False):
        for rate_hz in RATES_HZ:
            for sigma_m in SIGMAS_M:
                rows = [figures(name, sigma_m, rate_hz, with_yaw) for name in RECORDINGS]
                taken = np.array([taken_m for taken_m, _ in rows])
                estimate, odometer = np.mean([row for _, row in rows], axis=0).T
                print(f"{'yaw' if with_yaw else 'no ':3} {rate_hz:g} {sigma_m:g}: "
                      f"{taken.min():.2f} to {taken.max():.2f}; "
                      f"{' '.join(f'{e:.3f}' for e in estimate)}; "
                      f"{' '.join(f'{e:.4f}' for e in odometer)}", flush=True)  # fmt: skip


def figures(name, sigma_m, rate_hz, with_yaw):
    """The noise that is taken, and (3, 2) errors of estimate and odometer."""
    run = Run.read(motion() / name)
    noisy = with_noise(run, sigma_m, rate_hz, with_yaw)
    taken, _ = with_pose_noise(noisy, IcrEkfConfig())
    configs = (IcrEkfConfig(), taken, IcrEkfConfig(position_sigma_m=sigma_m))
    return taken.position_sigma_m, [errors(*replayed(run, noisy, config)) for config in configs]


def with_noise(run, sigma_m, rate_hz, with_yaw):
    rng = np.random.default_rng(len(run.pose) + int(10 * sigma_m + rate_hz))
    poses = run.pose.stack("x", "y", "yaw")
    poses += rng.normal(0, 1, poses.shape) * [sigma_m, sigma_m, YAW_RAD]
    if not with_yaw:
        poses[:, 2] = np.nan
    beats = np.floor((run.pose.stamps_s - run.pose.stamps_s[0]) * rate_hz + 1e-9)
    first = np.r_[True, np.diff(beats) > 0]
    columns = {name: column[first] for name, column in run.pose.columns.items()}
    columns |= dict(zip(("x", "y", "yaw"), poses[first].T, strict=True))
    return replace(run, pose=replace(run.pose, columns=columns))


def replayed(run, noisy, config):
    """The replay, the poses as they were (N, 3) at its stamps, and the rows to evaluate (N,)."""
    ekf = IcrEkf(run.robot.track_width, config=config)
    result = replay(noisy, ekf, ConstantTerrain("ground"))
    measured = run.pose.stack("x", "y", "yaw")
    measured[:, 2] = np.unwrap(measured[:, 2])
    stamps_s = result.stamps_s
    true = np.column_stack([np.interp(stamps_s, run.pose.stamps_s, c) for c in measured.T])
    settled = (stamps_s >= run.pose.stamps_s[0] + SETTLED_S) & (stamps_s <= run.pose.stamps_s[-1])
    return result, true, settled


def errors(result, true, settled):
    """Mean errors of the estimate [m] and of the odometer [m per m]."""
    estimate = result.numbers("mean", columns=slice(0, 2))
    path = path_of(result)
    first = np.flatnonzero(settled)[::20]
    last = np.searchsorted(path.travel_m, path.travel_m[first] + HORIZON_M)
    within = last < len(true)
    off = se2.between(path.poses[first[within]], path.poses[last[within]])
    off -= se2.between(true[first[within]], true[last[within]])
    return (
        np.hypot(*(estimate - true[:, :2])[settled].T).mean(),
        np.hypot(*off[:, :2].T).mean() / HORIZON_M,
    )


if __name__ == "__main__":
    main()
