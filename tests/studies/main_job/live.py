"""The live main job on the real recordings with poses: the same as `run`, and what it costs.

    python -m tests.studies.main_job.live [--seven]

Needs TERRAIN_ODOMETRY_DATA. Each recording is replayed without images by `run_odometry`, as it
comes and with `[filter] causal`, and its frames are fed one by one to `LiveOdometry`. Printed:
frames; whether estimates and odometer of both are the same to the last bit; the median time of a
live frame; mean error per metre over 5 m of wheel travel of the odometer, and of the estimate on
withheld poses, as it comes and causal.
"""

import argparse
import math
import time

import numpy as np

import terrain
from odometry.estimation.config import IcrEkfConfig
from odometry.recording.run import Run
from terrain.config import Config
from tests.studies.main_job.estimation_recordings import motion, recordings

CAUSAL = Config(filter=IcrEkfConfig(causal=True))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seven", action="store_true", help="only the seven of the final figure")
    arguments = parser.parse_args()
    ratios = []
    print(f"{'':38}{'frames':>7}  same  ms  odometer, causal  estimate, causal", flush=True)
    for name in recordings(seven=arguments.seven):
        run = Run.read(motion() / name)
        as_it_comes, causal = (run_odometry(run, config) for config in (Config(), CAUSAL))
        steps, seconds = fed(run)
        same = "yes" if is_same(steps, causal.replay) else "NO"
        odometer, estimate = (
            [error(result, line) for result in (as_it_comes, causal)]
            for line in ("odometer", "estimate")
        )
        ratios.append(odometer[1] / odometer[0])
        cells = "  ".join(f"{value:.4f}" for value in (*odometer, *estimate))
        milliseconds = 1e3 * np.median(seconds)
        print(f"{name:38}{len(steps):7}  {same:4}  {milliseconds:.2f}  {cells}", flush=True)
    mean = math.exp(np.mean(np.log(ratios)))
    print(f"causal over as it comes: {mean:.3f} in geometric mean, {max(ratios):.3f} at worst")


def run_odometry(run, config):
    return terrain.run_odometry(run, vision=False, config=config)


def fed(run):
    """Steps of the frames of a run to the end of its odometry, and the time of each [s]."""
    lever_m = run.sensors.pose_m[:2] if run.sensors.pose_m else (0.0, 0.0)
    live = terrain.LiveOdometry(run.robot, lever_m=lever_m, at_pose=True)
    steps, seconds = [], []
    for frame in run.frames():
        begin_s = time.perf_counter()
        step = live.step(frame)
        seconds.append(time.perf_counter() - begin_s)
        if step is not None:
            steps.append(step)
            if np.isnan(frame.tread_speeds_m_s).any():
                break
    return steps, seconds


def is_same(steps, replay):
    means = np.array([step.estimate.mean for step in steps])
    poses = np.array([step.odometer for step in steps])
    return means.tobytes() == replay.means.tobytes() and (
        poses.tobytes() == replay.odometer().poses.tobytes()
    )


def error(result, line):
    return result.scores[line].mean_translation_per_m if line in result.scores else math.nan


if __name__ == "__main__":
    main()
