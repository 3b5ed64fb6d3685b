"""Fog, a lost focus, drops and dirt that begin within a run, and what is no loss: what is found.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.recordings.check_lost_details
        [--first-seed 67] [--seeds 8] [--cache FOLDER]

The recordings of `check_image_motion` (rocking cameras, blurred and noisy images, several terrains
each), altered from 0.45 of their time on, in images of 320 px. Right is one finding that begins
within a second of it. Limits were chosen on seeds 60 to 66 and other recordings.
"""

import argparse
import os
import tempfile
from collections import Counter
from pathlib import Path

import cv2
import numpy as np

from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.checks.lost_details import lost_details
from terrain.checks.terrain_views import TerrainViews
from tests.studies.recordings.check_image_motion import made

BEGINS, SHAPE = 0.45, (240, 320)


def blobs(count, radius_px, seed):
    rng, found = np.random.default_rng(seed), np.zeros(SHAPE, np.float32)
    for _ in range(count):
        middle = int(rng.integers(0, SHAPE[1])), int(rng.integers(0, SHAPE[0]))
        cv2.circle(found, middle, int(rng.integers(radius_px // 2, radius_px)), 1, -1)
    return cv2.GaussianBlur(found, (0, 0), radius_px / 5)


DIRT, DROPS = blobs(25, 25, 1), blobs(60, 14, 2)


def drops(image):
    return image * (1 - DROPS) + DROPS * (cv2.GaussianBlur(image[::-1], (0, 0), 3) + 20)


def compressed(image):
    encoded = cv2.imencode(".jpg", np.asarray(image, np.uint8), [cv2.IMWRITE_JPEG_QUALITY, 30])[1]
    return cv2.imdecode(encoded, cv2.IMREAD_GRAYSCALE)


CHANGES = {
    "as it is": lambda image: image,
    "fog, 0.4 of the contrast": lambda image: 0.4 * image + 110,
    "fog, 0.25 of the contrast": lambda image: 0.25 * image + 150,
    "blur of 2 px": lambda image: cv2.GaussianBlur(image, (0, 0), 2.0),
    "blur of 1 px": lambda image: cv2.GaussianBlur(image, (0, 0), 1.0),
    "drops": drops,
    "dirt": lambda image: image * (1 - 0.8 * DIRT) + 30 * DIRT,
    "motion blur of 6 px": lambda image: cv2.blur(image, (6, 1)),
    "half the light": lambda image: 0.5 * image,
    "light times 1.5": lambda image: 1.5 * image,
    "gamma 0.6": lambda image: 255 * (image / 255) ** 0.6,
    "JPEG of quality 30": compressed,
}


class Changed:
    """Images of a run, changed from some stamp on."""

    def __init__(self, run, size, change, from_s):
        self._views = TerrainViews(run, size)
        files = map(str, run.images["file"])
        self._stamp_s = dict(zip(files, run.images.stamps_s, strict=True))
        self._change, self._from_s = change, from_s

    def grey(self, name):
        image = self._views.grey(name)
        if image is None or self._stamp_s[name] < self._from_s:
            return image
        changed = self._change(image.astype(np.float32))
        return np.clip(changed, 0, 255).astype(np.uint8)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first-seed", type=int, default=67)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--cache", type=Path, default=None)
    given = parser.parse_args()
    cache = given.cache or Path(tempfile.mkdtemp())
    photos = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images" / "ground"
    counts = {name: Counter() for name in CHANGES}
    for seed in range(given.first_seed, given.first_seed + given.seeds):
        run = Run.read(made(cache / f"{seed:03d}", seed, photos))
        camera = Camera.from_table(run.settings["camera"])
        first_s, last_s = run.images.stamps_s[[0, -1]]
        from_s = first_s + BEGINS * (last_s - first_s)
        for name, change in CHANGES.items():
            views = Changed(run, camera.image_size, change, from_s)
            spans_s = [one.spans_s[0] for one in lost_details(run, camera, views)]
            after_s = from_s - run.odometry.stamps_s[0]
            right = len(spans_s) == 1 and abs(spans_s[0][0] - after_s) < 1
            counts[name]["found" if right else "elsewhere" if spans_s else "nothing"] += 1
    for name, of in counts.items():
        print(f"{name:28}", dict(of))


if __name__ == "__main__":
    main()
