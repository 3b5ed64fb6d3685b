"""Mistakes in [camera] on random cameras: how many are noticed, and named first.

    python -m tests.studies.recordings.check_camera [--cameras 40] [--first-seed 0] [--in-part]

Robots of 0.3 to 1.2 m, cameras 0.3 to 2 m above the ground that look 15 to 70 degrees down, fields
of view of 45 to 100 degrees; kept are those that see the region of a robot that drives straight on.
With --in-part robots are up to 3.2 times as large, and kept are cameras that never see all of the
region but 0.4 of it or more in front of the robot.
Images are of the size that the camera had before the mistake. A finding without a mistake is a
false alarm. The motion is straight; no pixel is looked at.
"""

import argparse
from collections import Counter
from pathlib import Path

import numpy as np

from odometry.checks.findings.finding import Level
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from terrain.camera.camera import Camera
from terrain.camera.camera_values import homography_of_mount
from terrain.checks.drawn_images import straight_ahead
from terrain.checks.image_files import SampledImage
from terrain.checks.image_sizes import other_sizes
from terrain.checks.recording import lens
from terrain.checks.region_ahead import region_ahead
from terrain.errors import CameraError
from terrain.region.region import Region, RegionConfig, predict_region

RIGHT = ("none", "none, homography")
ALIASES = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # x right, y forward


def main() -> None:
    """Print one row a mistake."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cameras", type=int, default=40)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--in-part", action="store_true")
    arguments = parser.parse_args()
    noticed: Counter[str] = Counter()
    named: Counter[str] = Counter()
    tried: Counter[str] = Counter()
    seed = arguments.first_seed
    while tried["none"] < arguments.cameras:
        rng = np.random.default_rng(seed)
        seed += 1
        robot, table = drawn(rng)
        if arguments.in_part:
            robot = larger(robot, rng.uniform(1.0, 3.2))
        if is_seen(Camera.from_table(table), robot) != ("part" if arguments.in_part else "all"):
            continue
        for name, (wrong, words) in mistakes(table).items():
            causes = found(robot, wrong, table["image_size"])
            tried[name] += 1
            noticed[name] += bool(causes)
            named[name] += bool(causes) and words in causes[0].split("; less likely")[0]
    for name, count in tried.items():
        print(f"{name:24} noticed {noticed[name]:3} named first {named[name]:3} of {count}")
    wrong_ones = [name for name in tried if name not in RIGHT]
    total = sum(tried[name] for name in wrong_ones)
    print(
        f"all mistakes: noticed {sum(noticed[n] for n in wrong_ones) / total:.1%}, named first "
        f"{sum(named[n] for n in wrong_ones) / total:.1%} of {total}; false alarms "
        f"{sum(noticed[n] for n in RIGHT)} of {sum(tried[n] for n in RIGHT)}"
    )


def larger(robot, times):
    """A robot of the same shape."""
    sides = (robot.track_width, robot.length, robot.width)
    width, length, outside = (times * side for side in sides)
    return Robot(width, length=length, width=outside)


def is_seen(camera, robot):
    """How much of the region of a robot that drives straight on one image shows."""
    if isinstance(straight_ahead(camera, robot), Region):
        return "all"
    twist = np.array([1.0, 0.0, 0.0])
    region = predict_region(robot, camera, twist, 1.0, RegionConfig())
    in_front = isinstance(region, Region) and region.place[0] > robot.length / 2
    return "part" if in_front else "nothing"


def drawn(rng):
    """A robot and a [camera] table with a mount."""
    length = rng.uniform(0.3, 1.2)
    robot = Robot(0.7 * length, length=length, width=0.8 * length)
    width = int(rng.choice([640, 1280, 1920]))
    height = 3 * width // 4 if rng.uniform() < 0.5 else 9 * width // 16
    focal = width / 2 / np.tan(np.radians(rng.uniform(45, 100)) / 2)
    centre = np.array([width - 1, height - 1]) / 2 * (1 + rng.normal(0, 0.02, 2))
    roll, yaw = rng.normal(0, 0.02, 2)
    pitch = np.radians(rng.uniform(15, 70))
    place = [rng.uniform(0, length / 2), rng.normal(0, 0.05), rng.uniform(0.3, 2.0)]
    return robot, {
        "image_size": [width, height],
        "matrix": [[focal, 0, centre[0]], [0, focal, centre[1]], [0, 0, 1]],
        "distortion": [-0.05, 0.01, 0.0005, -0.0003, 0.0],
        "mount": [float(value) for value in (*place, roll, pitch, yaw)],
    }


def mistakes(table):
    """Wrong tables by the name of the mistake, and words that its cause holds."""
    mount, matrix = np.array(table["mount"]), np.array(table["matrix"])
    width, height = table["image_size"]
    ground = homography_of_mount(matrix, mount)

    def mounted(place=1.0, angles=1.0, turn=(0, 0, 0)):
        other = np.concatenate([mount[:3] * place, mount[3:] * angles + turn])
        return table | {"mount": other.tolist()}

    def homography(h):
        return {k: v for k, v in table.items() if k != "mount"} | {"ground_to_image": h.tolist()}

    return {
        "none": (table, ""),
        "none, homography": (homography(ground), ""),
        "degrees": (mounted(angles=180 / np.pi), "degrees"),
        "pitch sign": (mounted(angles=np.array([1, -1, 1])), "wrong sign"),
        "yaw + 90": (mounted(turn=(0, 0, np.pi / 2)), "off by 90"),
        "yaw - 90": (mounted(turn=(0, 0, -np.pi / 2)), "off by -90"),
        "yaw + 180": (mounted(turn=(0, 0, np.pi)), "off by 180"),
        "mm": (mounted(place=1000), "mm"),
        "cm": (mounted(place=100), "cm"),
        "height in mm": (mounted(place=np.array([1, 1, 1000])), "mm"),
        "height in cm": (mounted(place=np.array([1, 1, 100])), "cm"),
        "z down": (mounted(place=np.array([1, 1, -1])), "z has the wrong sign"),
        "image_size swapped": (table | {"image_size": [height, width]}, "swapped"),
        "matrix twice": (table | {"matrix": (np.diag([2, 2, 1]) @ matrix).tolist()}, "resolution"),
        "matrix half": (
            table | {"matrix": (np.diag([0.5, 0.5, 1]) @ matrix).tolist()},
            "resolution",
        ),
        "inverse": (homography(np.linalg.inv(ground)), "image_to_ground"),
        "homography in mm": (homography(ground @ np.diag([1e-3, 1e-3, 1])), "mm"),
        "homography in cm": (homography(ground @ np.diag([1e-2, 1e-2, 1])), "cm"),
        "x right, y forward": (homography(ground @ ALIASES.T), "x right and y forward"),
        "coefficients' order": (table | {"distortion": [-0.25, 0.1, -0.04, 5e-4, -3e-4]}, "order"),
    }


def found(robot, table, size):
    """Causes of warnings, in the order in which the check prints them."""
    findings = []
    try:
        camera = Camera.from_table(table)
    except CameraError:
        camera = None
    if camera is not None:
        findings += lens(camera)
        image = SampledImage(0, 0.0, Path("a.jpg"), tuple(size), "", b"")
        for scaled in other_sizes(camera, table, [image]):
            findings.append(scaled.finding)
            table = scaled.mended or table
    findings += region_ahead(straight_run(robot), table)
    return [finding.cause for finding in findings if finding.level is Level.WARNING]


def straight_run(robot):
    """Ten seconds at half a metre per second, an image each second."""
    t, speed = np.arange(0.0, 10.01, 0.1), np.full(101, 0.5)
    odometry = {"t": t, "v_left": speed, "v_right": speed}
    images = {"t": t[::10], "file": np.array(["a.jpg"] * 11)}
    tables = [Table(Path("x.csv"), c, np.arange(len(c["t"]))) for c in (odometry, images)]
    return Run(Path("run"), robot, {}, tables[0], images=tables[1])


if __name__ == "__main__":
    main()
