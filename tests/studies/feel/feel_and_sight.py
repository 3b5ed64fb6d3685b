"""What the robot feels and what the camera sees, together and alone, on made courses.

    python -m tests.studies.feel.feel_and_sight [--seeds 20] [--first-seed 4]

Courses of `switching_courses` over three terrains, with vibration that is made here by terrain and
speed: band-limited noise, whose centre and size differ from drive to drive. The labels of the
camera are right six or eight times in ten, in stretches. Feel is identified on other drives.
Printed: share of the way on which the terrain in force is the true one, every terrain counting
the same, and the difference to both, with an interval over drives drawn anew.
"""

import argparse
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.signal import butter, sosfilt

from odometry.estimation.icr_ekf import IcrEkf
from odometry.feel.identify_feel import identify_feel
from odometry.feel.labels.follow import follow_feel
from odometry.recording.run import Run
from odometry.replays.pipeline import replay
from odometry.tables.table import Table
from terrain.config import Config
from terrain.image_labels.image_label import ImageLabel
from terrain.switch.feel_labels import FeelLabels
from tests.studies.main_job.switching_courses import LabellingWatcher, make_course

ZONES = ("gravel", "grass", "brick", "gravel", "brick", "grass")
RATE_HZ = 100.0
# centre [Hz], size at 1 m/s [m/s2], by how much both differ from drive to drive
SHAKEN = {"gravel": (14.0, 1.6), "grass": (11.0, 1.2), "brick": (18.0, 1.4)}
SPREAD = (0.15, 0.4)
SIGHTS = {"0.8": 0.8, "0.6": 0.6}
HELD_M = 0.5
TRAINING = 12  # drives


class Blind(LabellingWatcher):
    """A watcher whose camera sees nothing."""

    def look(self, frame, estimate, pose=None):  # noqa: ARG002 - the watcher's
        """No label."""
        return ImageLabel(frame.stamp_s, frame.image.name, reason="blind")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first-seed", type=int, default=4, help="0 to 3 are of development.")
    asked = parser.parse_args()
    seeds = range(asked.first_seed, asked.first_seed + asked.seeds)
    with tempfile.TemporaryDirectory() as scratch:
        training = [
            labelled(make_course(Path(scratch) / f"t{seed}", 1000 + seed, ZONES), 1000 + seed)
            for seed in range(TRAINING)
        ]
        model = identify_feel(training)
        for length in ("window", "stretch", "run"):
            print(f"feel, held out, {length}: {model.report[length]['balanced_accuracy']:.3f}")
        courses = [make_course(Path(scratch) / f"c{seed}", seed, ZONES) for seed in seeds]
        felt = [
            follow_feel(shaken(course, seed), model)
            for seed, course in zip(seeds, courses, strict=True)
        ]
        for name, accuracy in SIGHTS.items():
            shares = np.array(
                [
                    judged(course, of, accuracy, seed)
                    for seed, course, of in zip(seeds, courses, felt, strict=True)
                ]
            )
            say(f"camera right {name} of the time", shares)


def shaken(course, seed):
    """The run of a course with an IMU."""
    rng = np.random.default_rng([7, seed])
    drive = course.drive
    at = np.arange(drive.stamps_s[0], drive.stamps_s[-1], 1 / RATE_HZ)
    row = np.searchsorted(drive.stamps_s, at, side="right") - 1
    terrains = np.array(drive.terrains, dtype=object)[row]
    odometry = course.run.odometry
    held = np.searchsorted(odometry.stamps_s, at, side="right") - 1
    speed = np.abs(odometry.stack("v_left", "v_right")[held]).mean(axis=1)
    columns = {"t": at}
    for axis in "xyz":
        columns[f"accel_{axis}"] = 0.05 * rng.normal(size=len(at))
        columns[f"gyro_{axis}"] = 0.003 * rng.normal(size=len(at))
    for name, (centre_hz, size) in SHAKEN.items():
        middle_hz = centre_hz * np.exp(SPREAD[0] * rng.normal())
        band = [middle_hz / 1.6, min(middle_hz * 1.6, 49.0)]
        sos = butter(2, band, "bandpass", fs=RATE_HZ, output="sos")
        on = (terrains == name) * size * speed * np.exp(SPREAD[1] * rng.normal())
        for axis in "xyz":
            for kind, share in (("accel", 1.0), ("gyro", 0.04)):
                noise = sosfilt(sos, rng.normal(size=len(at)))
                columns[f"{kind}_{axis}"] += share * on * noise / noise.std()
    columns["accel_z"] += 9.81
    columns["gyro_z"] += odometry["gyro_z"][held]
    imu = Table(Path("made/imu.csv"), columns, np.arange(2, 2 + len(at)))
    return Run(course.run.folder, course.run.robot, course.run.settings, odometry, imu=imu)


def labelled(course, seed):
    """The run of a course with its true terrain in odometry.csv."""
    run = shaken(course, seed)
    row = np.searchsorted(course.drive.stamps_s, run.odometry.stamps_s, side="right") - 1
    names = np.array(course.drive.terrains, dtype="U10")[row]
    columns = {**run.odometry.columns, "terrain": names}
    return replace(run, odometry=replace(run.odometry, columns=columns))


def judged(course, felt, accuracy, seed):
    """Share of the way that is right by camera, by feel, and by both."""
    config = Config()
    config = replace(config, switch=replace(config.switch, label_accuracy=accuracy))
    found = []
    for kind, with_feel in ((LabellingWatcher, False), (Blind, True), (LabellingWatcher, True)):
        watcher = kind(course, config, accuracy=accuracy, held_m=HELD_M, seed=seed)
        watcher._felt = FeelLabels.of(felt, tuple(SHAKEN)) if with_feel else None
        run = course.run
        estimator = IcrEkf(run.robot.track_width, course.parameters, config.filter)
        result = replay(run, estimator, watcher)
        stamps_s = np.array([one.stamp_s for one in result.estimates])
        row = np.searchsorted(course.drive.stamps_s, stamps_s, side="right") - 1
        true = np.array(course.drive.terrains, dtype=object)[row]
        said = np.array([one.terrain for one in result.estimates], dtype=object)
        found.append(np.mean([(said == true)[true == name].mean() for name in SHAKEN]))
    return found


def say(title, shares):
    """Means, and what both gain over each with 5 to 95 % over drives."""
    rng = np.random.default_rng(0)
    drawn = shares[rng.integers(len(shares), size=(2000, len(shares)))].mean(axis=1)
    sight, feel, both = shares.mean(axis=0)
    print(f"{title}: camera {sight:.3f}, feel {feel:.3f}, both {both:.3f}")
    for place, name in enumerate(("sight", "feel")):
        low, high = np.quantile(drawn[:, 2] - drawn[:, place], [0.05, 0.95])
        print(
            f"  both over {name}: {both - shares[:, place].mean():+.3f} ({low:+.3f} to {high:+.3f})"
        )


if __name__ == "__main__":
    main()
