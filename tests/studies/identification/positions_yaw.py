"""Yaw found from positions, on real recordings whose yaw column was emptied.

    python -m tests.studies.identification.positions_yaw [--noise 0.02 0.3 1.0] [RUN ...]

For each recording of data/motion (TERRAIN_ODOMETRY_DATA names the folder of shared recordings),
noise of the positions, and with and without its gyroscope: the share of positions at which yaw is
estimated, the root mean square error against the measured yaw, the median stated standard
deviation, and how much of the errors is within 2 and beyond 4 of these; or that the yaw cannot be
estimated.
"""

import argparse

import numpy as np

from odometry.errors import OdometryError
from odometry.geometry.angles import wrap
from odometry.positions.heading import found_heading
from odometry.recording.run import Run
from odometry.windows.recorded.measured_poses import YAW_FOUND
from tests.studies.identification.positions import MOTION, emptied, without_gyroscope


def row(run: Run, seen: Run) -> str:
    """What is found of one run."""
    try:
        found = found_heading(seen)
    except OdometryError as error:
        return f"refused: {str(error)[:60]}"
    errors = np.abs(wrap(found.run.pose["yaw"] - run.pose["yaw"]))
    told = np.isfinite(errors)
    by_sigma = errors[told] / found.run.pose[YAW_FOUND][told]
    return (
        f"estimated {found.estimated_share:.2f}"
        f"  error {np.degrees(np.sqrt(np.mean(errors[told] ** 2))):5.1f}"
        f"  sigma {np.degrees(found.yaw_sigma_rad):5.1f} deg"
        f"  within 2 {np.mean(by_sigma < 2):.3f}  beyond 4 {np.mean(by_sigma > 4):.4f}"
    )


def main() -> None:
    """Run the study and print its rows."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--noise", type=float, nargs="+", default=[0.02, 0.3, 1.0])
    parser.add_argument("runs", nargs="*")
    given = parser.parse_args()
    every = sorted(folder.parent.name for folder in MOTION.glob("*/pose.csv"))
    for name in given.runs or every:
        run = Run.read(MOTION / name)
        for noise_m in given.noise:
            seen = emptied(run, noise_m=noise_m)
            for label, each in (("gyroscope", seen), ("treads", without_gyroscope(seen))):
                print(f"{name:42} {noise_m:4} m {label:9}  {row(run, each)}", flush=True)


if __name__ == "__main__":
    main()
