"""Images that are late, reversed, mirrored, and cameras that look elsewhere: how many are named.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.recordings.check_image_motion
        [--first-seed 24] [--seeds 8] [--cache FOLDER]

Runs by `synthesise` on photographs of DATA/terrain-images/ground: cameras 0.4 to 1.4 m high that
look 20 to 55 degrees down, 2 to 10 images a second, 0.4 to 1.2 m/s. The camera rocks by 0 to 1
degree in pitch and roll from image to image, which `synthesise` does not do, and images are
blurred and noisy. Faults are made on the tables, mirrored images on the steps.
"""

import argparse
import os
import tempfile
from collections import Counter
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

from odometry.recording.run import Run
from odometry.simulation.commands import WeavingDriver
from terrain.camera.camera import Camera
from terrain.checks.image_motion import image_motion
from terrain.synthetic import SynthesisConfig, synthesise

RIGHT = {"late": "images_late", "height": "camera_height", "yaw": "camera_yaw"}
RIGHT |= {
    "half a run off": "images_unordered",
    "reversed": "images_reversed",
    "as it is": "",
    "pitch": "camera_lens",
    "roll": "images_upside_down",
}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first-seed", type=int, default=24)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--cache", type=Path, default=None)
    given = parser.parse_args()
    cache = given.cache or Path(tempfile.mkdtemp())
    photos = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images" / "ground"
    counts = {}
    for seed in range(given.first_seed, given.first_seed + given.seeds):
        run = Run.read(made(cache / f"{seed:03d}", seed, photos))
        camera = Camera.from_table(run.settings["camera"])
        for name, faulty, its in faults(run, camera):
            findings, skipped = image_motion(faulty, its)
            names = [one.name for one in findings]
            right = RIGHT[name.split(" by ")[0]]
            kind = "not checked" if skipped else "right" if names == [right] * bool(right) else (
                "nothing" if not names else "also" if right in names else "wrong")  # fmt: skip
            counts.setdefault(name, Counter())[kind] += 1
            if kind in {"wrong", "also"}:
                print(f"  seed {seed}, {name}: {[one.line for one in findings]}", flush=True)
    kinds = ("right", "also", "nothing", "not checked", "wrong")
    print(f"{'':24}", *(f"{kind:>12}" for kind in kinds))
    for name, of in counts.items():
        print(f"{name:24}", *(f"{of[kind]:12}" for kind in kinds))


def faults(run, camera):
    """Names, faulty runs and cameras."""
    stamps_s, files = run.images.stamps_s, run.images["file"]
    yield "as it is", run, camera
    for late_s in (-2.0, -0.5, 0.5, 1.0, 3.0):
        yield f"late by {late_s:g} s", with_images(run, t=stamps_s + late_s), camera
    for times in (0.5, 2.0):
        yield f"height by {times:g}", run, moved(camera, 2, lambda z, times=times: z * times)
    for degrees in (15, -90):
        turn = np.radians(degrees)
        yield f"yaw by {degrees}", run, moved(camera, 5, lambda yaw, turn=turn: yaw + turn)
    for degrees in (-5, 5):
        turn = np.radians(degrees)
        yield f"pitch by {degrees}", run, moved(camera, 4, lambda pitch, turn=turn: pitch + turn)
    yield "roll by 180", run, moved(camera, 3, lambda roll: roll + np.pi)
    yield "reversed", with_images(run, file=files[::-1].copy()), camera
    yield "half a run off", with_images(run, file=np.roll(files, len(files) // 2)), camera


def with_images(run, **columns):
    return replace(run, images=replace(run.images, columns=run.images.columns | columns))


def moved(camera, place, change):
    mount = camera.mount.copy()
    mount[place] = change(mount[place])
    return Camera.from_mount(camera.image_size, camera.matrix, camera.distortion, mount)


def made(folder, seed, photos):
    """A run whose camera rocks."""
    if folder.exists():
        return folder
    rng = np.random.default_rng(1000 + seed)
    terrains = sorted(one.name for one in photos.iterdir() if one.is_dir())
    focus, height = rng.uniform(300, 600), rng.uniform(0.4, 1.4)
    mount = [rng.uniform(0.1, 0.4), rng.uniform(-0.1, 0.1), height, np.radians(rng.normal(0, 1)),
             np.radians(rng.uniform(20, 55)), np.radians(rng.normal(0, 3))]  # fmt: skip
    matrix = np.array([[focus, 0, 319.5], [0, focus, 239.5], [0, 0, 1.0]])
    config = SynthesisConfig(
        seed=seed,
        zones=tuple(rng.choice(terrains, 2, replace=False).tolist()),
        zone_length_m=float(rng.uniform(8, 14)),
        icrs_m={name: (0.3 + 0.06 * k, -0.3 - 0.06 * k, 0.02) for k, name in enumerate(terrains)},
        camera=Camera.from_mount((640, 480), matrix, [-0.1, 0.03, 0, 0, 0], mount),
        image_rate_hz=float(rng.choice([2, 4, 5, 10])),
        driver=WeavingDriver(
            speed_m_s=rng.uniform(0.4, 1.2),
            speed_swing=rng.uniform(0.05, 0.3),
            weave_rad=rng.uniform(0.1, 0.4),
            weave_period_s=rng.uniform(8, 16),
        ),
        metres_per_pixel=float(rng.uniform(0.002, 0.004)),
        patches_per_terrain=1,
    )
    folder.mkdir(parents=True)
    synthesise(folder, config, photos=photos)
    rock(sorted((folder / "images").iterdir()), matrix, np.radians(rng.uniform(0, 1)), rng)
    return folder


def rock(files, matrix, rocks_rad, rng):
    """Turn the camera a little from image to image, with some blur, exposure and noise."""
    roll_pitch = np.zeros(2)
    for file in files:
        image = cv2.imread(str(file))
        roll_pitch = 0.5 * roll_pitch + np.sqrt(0.75) * rng.normal(0, rocks_rad, 2)
        turn, _ = cv2.Rodrigues(np.array([roll_pitch[0], 0.0, roll_pitch[1]]))
        turn = matrix @ turn @ np.linalg.inv(matrix)
        size = image.shape[1::-1]
        image = cv2.warpPerspective(image, turn, size, borderMode=cv2.BORDER_REFLECT)
        image = cv2.GaussianBlur(image, (0, 0), 0.3 + rng.uniform(0, 0.7))
        noisy = image * rng.uniform(0.9, 1.1) + rng.normal(0, 3, image.shape)
        bytes_of = np.clip(noisy, 0, 255).astype(np.uint8)
        cv2.imwrite(str(file), bytes_of, [cv2.IMWRITE_JPEG_QUALITY, 70])


if __name__ == "__main__":
    main()
