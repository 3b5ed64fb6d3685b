"""How many images get a label where they miss a corner of the region, and how good it is.

    python -m tests.studies.camera.region_visibility [--data FOLDER] [--every 2.0]
    python -m tests.studies.camera.region_visibility --accuracy [--seeds 2] [--data FOLDER]

The first counts, for real cameras (data/camera-frames) and the motion of real recordings
(data/motion, whose robots turn by an ordinary effective width): of the moments at which the middle
of the footprint enters the image, those without a region, where all of the footprint must be shown,
and with the settings as they are; inside the image alone, and for patches of 96 pixels of 3 mm.

The second drives wild curves over photographs (data/terrain-images/ground) and evaluates labels by
the share of the region that was shown; and reads regions that were shown whole again with a part
of them hidden, so that the same ground is evaluated.
"""

import argparse
import os
import tempfile
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import yaml

from odometry.geometry import se2
from odometry.recording.run import Robot, Run
from odometry.simulation.commands import WeavingDriver
from terrain.camera.camera import Camera
from terrain.checks.drawn_images import motion_at
from terrain.classification.training import train
from terrain.images import read_image
from terrain.main_job import run_odometry
from terrain.region.region import NoRegion, Rectangle, RegionConfig, predict_region
from terrain.region.warp import coarsest_m, ground_view, scale_mismatch
from terrain.synthesis.config import SynthesisConfig, default_camera
from terrain.synthetic import synthesise

PATCHES = SimpleNamespace(metres_per_pixel=0.003, patch_size_px=96)
WHOLE, DEFAULT = RegionConfig(least_share=1.0), RegionConfig()
ASKED = {  # settings, and whether patches must fit and be shown finely enough
    "all, in the image": (WHOLE, False),
    "part, in the image": (DEFAULT, False),
    "all, patches": (WHOLE, True),
    "part, patches": (DEFAULT, True),
    "treads, patches": (replace(DEFAULT, per_tread=True), True),
}
ZONES = ("asphalt", "concrete", "asphalt")
WILD = WeavingDriver(weave_rad=0.9, weave_period_s=6.0, largest_difference_m_s=1.2)
HIDDEN = {"nothing": (0.0, 0.0), "the near half": (0.5, 0.0), "one side": (0.0, 0.5),
          "near and side": (0.35, 0.35)}  # fmt: skip


def main() -> None:
    """Print one of the two tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=os.environ.get("TERRAIN_ODOMETRY_DATA"))
    parser.add_argument("--every", type=float, default=2.0, help="seconds between moments")
    parser.add_argument("--accuracy", action="store_true")
    parser.add_argument("--seeds", type=int, default=2)
    arguments = parser.parse_args()
    if arguments.accuracy:
        accuracy(Path(arguments.data), arguments.seeds)
    else:
        count(Path(arguments.data), arguments.every)


def count(data: Path, every_s: float) -> None:
    """Moments without a region, by camera."""
    cameras = {
        "husky front": ros_camera(data / "camera-frames/husky", "camera_front"),
        "marv front": ros_camera(data / "camera-frames/marv", "camera_front"),
        "mast": default_camera(),
    }
    runs = [Run.read(file.parent) for file in sorted((data / "motion").glob("*/run.toml"))]
    print(
        f"{len(runs)} recordings; moments without a region, of those with the middle in the image"
    )
    print(f"{'camera':12} {'moments':>8} {'middle':>8}" + "".join(f" {name:>16}" for name in ASKED))
    for name, camera in cameras.items():
        moments = 0
        found = []
        for run in runs:
            for twist, speed_m_s in moving(run, every_s):
                moments += 1
                if middle_comes(camera, run.robot, twist, speed_m_s):
                    found.append(outcomes(camera, run.robot, twist, speed_m_s))
        shares = 1 - np.mean(found, axis=0)
        cells = "".join(f" {share:16.1%}" for share in shares)
        print(f"{name:12} {moments:8} {len(found):8}{cells}")


def outcomes(camera, robot, twist, speed_m_s):
    """Whether there is a region, by what is asked."""
    found = []
    for config, fine in ASKED.values():
        needs = {}
        if fine:
            needs["coarsest_m"] = coarsest_m(PATCHES, config.coarsest)
            needs["scale_mismatch"] = partial(too_small, camera, config.coarsest)
        region = predict_region(robot, camera, twist, speed_m_s, config, **needs)
        found.append(not isinstance(region, NoRegion))
    return found


def too_small(camera, coarsest, rectangle):
    """Why a rectangle cannot be compared with the patches, or ""."""
    return scale_mismatch(PATCHES, camera, rectangle, coarsest)


def moving(run, every_s):
    """Twist and mean tread speed at moments of a run while it moves."""
    stamps_s = np.arange(run.odometry.stamps_s[0], run.odometry.stamps_s[-1], every_s)
    for twist, speed_m_s in zip(*motion_at(run, stamps_s), strict=True):
        if speed_m_s > 0.05:
            yield twist, float(speed_m_s)


def middle_comes(camera, robot, twist, speed_m_s):
    """Whether the middle of the footprint ever enters the image within the limits."""
    length_m = robot.length or robot.track_width
    latest_s = min(DEFAULT.most_ahead_s, DEFAULT.most_ahead_lengths * length_m / speed_m_s)
    places = se2.exp(twist * np.linspace(0.0, latest_s, 300)[:, None])[:, :2]
    return bool(camera.in_image(camera.ground_to_pixels(places)).any())


def ros_camera(folder, name):
    """A camera by its ROS calibration file and its transformation."""
    calibration = yaml.safe_load((folder / f"{name}.yaml").read_text())
    frames = yaml.safe_load((folder / "transformations.yaml").read_text())

    def matrix(key):
        return np.array(frames[key]["data"], dtype=float).reshape(4, 4)

    intrinsics = np.array(calibration["camera_matrix"]["data"]).reshape(3, 3)
    pose = np.linalg.inv(matrix("T_base_link__base_footprint")) @ matrix(f"T_base_link__{name}")
    ground = np.column_stack([[1, 0, 0], [0, 1, 0], -pose[:3, 3]])
    size = calibration["image_width"], calibration["image_height"]
    lens = calibration["distortion_coefficients"]["data"]
    return Camera.from_homography(size, intrinsics, lens, intrinsics @ pose[:3, :3].T @ ground)


def accuracy(data: Path, seeds: int) -> None:
    """Labels by the share that was shown, and of the same ground with a part hidden."""
    shown, hidden = [], {name: [] for name in HIDDEN}
    images = 0
    for seed in range(seeds):
        with tempfile.TemporaryDirectory() as scratch:
            config = SynthesisConfig(seed=seed, zones=ZONES, driver=WILD)
            run = Run.read(
                synthesise(Path(scratch) / "run", config, photos=data / "terrain-images/ground")
            )
            model = train(run.folder / "patches").classifier
            result = run_odometry(run, model=model, parameters=run.folder / "parameters.toml")
            images += len(result.watcher.image_labels)
            camera = Camera.from_table(run.settings["camera"])
            for image_label in result.watcher.image_labels:
                if image_label.region is None:
                    continue
                true = terrain_of(run, config, image_label.stamp_s, image_label.region.rectangle)
                share = shown_share(run.robot, image_label.region)
                if true:
                    shown.append((share, image_label.label == true, image_label.label == "unknown"))
                if true and share > 0.99:
                    image = read_image(run.folder / image_label.image)
                    for name, cut in HIDDEN.items():
                        part = without(image_label.region.rectangle, *cut)
                        view = ground_view(image, camera, part, model.metres_per_pixel)
                        hidden[name].append(model.classify([view])[0].label == true)
    table = np.array(shown)
    print(f"{images} images, {len(table)} regions on one terrain")
    for low, high in ((0.0, 0.5), (0.5, 0.7), (0.7, 0.9), (0.9, 1.01)):
        rows = table[(table[:, 0] >= low) & (table[:, 0] < high)]
        if len(rows):
            right, unknown = rows[:, 1].mean(), rows[:, 2].mean()
            print(
                f"shown {low:.1f} to {min(high, 1):.1f}: {len(rows):4} regions, right {right:.3f}, "
                f"unknown {unknown:.3f}"
            )
    for name, right in hidden.items():
        print(
            f"hidden of whole ones, {name:14}: {len(right):4} regions, right {np.mean(right):.3f}"
        )


def shown_share(robot: Robot, region) -> float:
    """Area of the rectangle that is read, of the rectangle round the footprint (eq. 22)."""
    length, width = (1.2 * side for side in (robot.length, robot.width))
    sine, cosine = abs(np.sin(region.pose_ahead[2])), abs(np.cos(region.pose_ahead[2]))
    whole = (width * sine + length * cosine) * (width * cosine + length * sine)
    r = region.rectangle
    return float((r.x_max - r.x_min) * (r.y_max - r.y_min) / whole)


def without(r: Rectangle, near: float, side: float) -> Rectangle:
    """A rectangle without its nearest part and a part of its left side."""
    x_min = r.x_min + near * (r.x_max - r.x_min)
    return Rectangle(x_min, r.x_max, r.y_min, r.y_max - side * (r.y_max - r.y_min))


def terrain_of(run, config, stamp_s, rectangle):
    """The terrain of a rectangle in the image of a stamp; "" where it lies across an edge."""
    row = int(np.searchsorted(run.truth.stamps_s, stamp_s))
    pose = run.truth.stack("x", "y", "yaw")[min(row, len(run.truth) - 1)]
    x = se2.transform(pose, rectangle.corners)[:, 0]
    edges_m = config.zone_length_m * np.arange(1, len(config.zones))
    if np.any((x.min() - config.edge_wave_m < edges_m) & (edges_m < x.max() + config.edge_wave_m)):
        return ""
    zone = int(np.clip(x.mean() // config.zone_length_m, 0, len(config.zones) - 1))
    return config.zones[zone]


if __name__ == "__main__":
    main()
