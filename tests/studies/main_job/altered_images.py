"""Which terrain is in force where all images of a run are altered, as no photograph of training is.

    python -m tests.studies.main_job.altered_images --photos FOLDER [--seed 0] [--out FOLDER]
        [--colour]
        [--left-out TERRAIN ...] [--only NAME ...]

One run over the terrains of FOLDER in an order that the seed draws, zones of 5 m, and a classifier
of other photographs of them (parted by photo_id); terrains that are --left-out are in the run and
not in training. Printed for each alteration: frames with the true terrain in force, with `unknown`
(on terrain that was left out this is the true one), and with another.
"""

import argparse
import shutil
import tempfile
from collections import Counter
from pathlib import Path

import cv2
import numpy as np

from odometry.recording.run import UNKNOWN, Run
from terrain.classification.training import train
from terrain.main_job import run_odometry
from terrain.synthesis.config import SynthesisConfig
from terrain.synthetic import synthesise

ROWS, COLUMNS = np.mgrid[0:1:480j, 0:1:640j]


def main():
    """Make, train, alter, replay and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--photos", type=Path, required=True)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, help="keep the runs here")
    parser.add_argument("--colour", action="store_true", help="train with colour")
    parser.add_argument("--left-out", nargs="*", default=[], metavar="TERRAIN")
    parser.add_argument("--only", nargs="*", default=list(ALTERATIONS), choices=list(ALTERATIONS))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        out = arguments.out or Path(scratch)
        names = sorted(path.name for path in arguments.photos.iterdir() if path.is_dir())
        zones = np.random.default_rng(arguments.seed).permutation(names).tolist()
        config = SynthesisConfig(seed=arguments.seed, zones=tuple(zones), zone_length_m=5.0)
        folder = synthesise(out / "made", config, photos=arguments.photos)
        patches = out / "patches"
        left_out = shutil.ignore_patterns(*arguments.left_out)
        shutil.copytree(folder / "patches", patches, ignore=left_out)
        model = train(patches, colour=arguments.colour).classifier
        for name in arguments.only:
            run = Run.read(altered(folder, out / name.replace(" ", "_"), ALTERATIONS[name]))
            result = run_odometry(run, model=model, parameters=folder / "parameters.toml")
            print(f"{name:24s} {in_force(result, arguments.left_out)}", flush=True)


def altered(folder, out, alter):
    """A copy of a run with all images altered, by their number."""
    shutil.copytree(folder, out, ignore=shutil.ignore_patterns("patches"))
    for number, file in enumerate(sorted((out / "images").iterdir())):
        image = alter(cv2.imread(str(file)), number)
        cv2.imwrite(str(file), image, [cv2.IMWRITE_JPEG_QUALITY, 95])
    return out


def in_force(result, left_out):
    """Frames with the true terrain in force, `unknown`, and another."""
    truth = result.run.truth
    rows = np.searchsorted(truth.stamps_s, result.replay.stamps_s).clip(0, len(truth.stamps_s) - 1)
    count = Counter()
    for terrain, true in zip(result.replay.terrains, truth["terrain"][rows], strict=True):
        is_right = terrain == (UNKNOWN if true in left_out else true)
        count["right" if is_right else UNKNOWN if terrain == UNKNOWN else "wrong"] += 1
    return ", ".join(f"{word} {count[word]}" for word in ("right", UNKNOWN, "wrong"))


def _grey(image, values):
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)[image]


def _times(image, factors):
    if factors.ndim == 2:
        factors = cv2.resize(factors, image.shape[1::-1])[..., None]
    return np.clip(np.rint(image * factors), 0, 255).astype(np.uint8)


def _local_contrast(image):
    lab = cv2.cvtColor(image, cv2.COLOR_BGR2LAB)
    lab[..., 0] = cv2.createCLAHE(4.0, (8, 8)).apply(lab[..., 0])
    return cv2.cvtColor(lab, cv2.COLOR_LAB2BGR)


def _equalised(image):
    lab = cv2.cvtColor(image, cv2.COLOR_BGR2LAB)
    lab[..., 0] = cv2.equalizeHist(lab[..., 0])
    return cv2.cvtColor(lab, cv2.COLOR_LAB2BGR)


def _enlarged(image):
    height, width = image.shape[:2]
    middle = image[height // 4 : -height // 4, width // 4 : -width // 4]
    return cv2.resize(middle, (width, height))


def _glint(image, number):
    x, y = 0.5 + 0.4 * np.sin(number / 9), 0.8 + 0.12 * np.cos(number / 13)
    light = 230 * np.exp(-((COLUMNS - x) ** 2) / 0.04 - (ROWS - y) ** 2 / 0.022)
    light = cv2.resize(light, image.shape[1::-1])[..., None]
    return np.clip(image + light, 0, 255).astype(np.uint8)


GREYS = np.arange(256.0)
SHADE, STRIPES = 1 - 0.6 * (COLUMNS > 0.5), 0.5 + 0.5 * ((COLUMNS + 0.75 * ROWS) % 0.1 > 0.05)
ALTERATIONS = {
    "as it is": lambda image, _: image,
    "0.6 of the light": lambda image, _: _grey(image, 0.6 * GREYS),
    "gamma 2": lambda image, _: _grey(image, 255 * (GREYS / 255) ** 2),
    "negative": lambda image, _: _grey(image, 255 - GREYS),
    "local contrast": lambda image, _: _local_contrast(image),
    "equalised": lambda image, _: _equalised(image),
    "a glint that moves": _glint,
    "one half in shade": lambda image, _: _times(image, SHADE),
    "stripes of shade": lambda image, _: _times(image, STRIPES),
    "enlarged to twice": lambda image, _: _enlarged(image),
    "median of 9 px": lambda image, _: cv2.medianBlur(image, 9),
    "red": lambda image, _: _times(image, np.array([0.7, 0.8, 1.4])),
    "red and blue exchanged": lambda image, _: image[..., ::-1],
    "channels turned round": lambda image, _: image[..., [1, 2, 0]],
}

if __name__ == "__main__":
    main()
