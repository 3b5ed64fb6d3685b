"""How far the odometer is off on recordings, by source, and whether its covariance is right.

    python -m tests.studies.main_job.odometer_noise [--all]

The 19 recordings of data/motion with poses that are not the seven of the final figures gave
`USUAL_NOISE`: the mean variance of each source, with `LEAST_SHARE` 0. NEES of a recording by its
own noise, and of each half by the noise of the other; 3 is expected. With --all also the seven.
"""

import argparse

import numpy as np

from odometry.evaluation.odometer_uncertainty import odometer_uncertainty
from odometry.evaluation.open_loop_consistency import DISTANCES_M
from odometry.evaluation.open_loop_errors import SOURCES
from odometry.recording.run import Run
from terrain.main_job import run_odometry
from tests.studies.main_job.estimation_recordings import SEVEN, motion, recordings


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--all", action="store_true")
    every = parser.parse_args().all
    variances, own, other = [], [], []
    for name in recordings(seven=False):
        if name in SEVEN and not every:
            continue
        result = run_odometry(Run.read(motion() / name), vision=False)
        found = odometer_uncertainty(result.run, result.replay)
        own.append({check.distance_m: check for check in found.own_checks})
        other.append({check.distance_m: check for check in found.checks})
        if name not in SEVEN:
            variances.append([*found.noise.variances, *found.noise.reference])
        print(f"{name:40} own {words(own[-1])}   other half {words(other[-1])}", flush=True)
    print("mean deviations of the 19:")
    for source, variance in zip(
        (*SOURCES, "position", "yaw"), np.mean(variances, axis=0), strict=True
    ):
        print(f"  {source:22} {np.sqrt(variance):.4f}")
    for kind, checks in (("own", own), ("other half", other)):
        for distance_m in DISTANCES_M:
            means = [each[distance_m].mean for each in checks if distance_m in each]
            right = sum(each[distance_m].is_consistent for each in checks if distance_m in each)
            if means:
                print(f"{kind:10} {distance_m:5g} m: median {np.median(means):.2f}, "
                      f"consistent {right} of {len(means)}")  # fmt: skip


def words(checks):
    return " ".join(f"{check.mean:5.1f}" for check in checks.values())


if __name__ == "__main__":
    main()
