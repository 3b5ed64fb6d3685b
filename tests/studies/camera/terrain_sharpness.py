"""Whether `train` notes one terrain that is by a blurred, enlarged or noisy camera.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_sharpness [--draws 60]
        [--seed 79]

Two or more terrains of ground/ (a corner of 400 px), pavements/ or street/ are drawn, 5 to 20
photographs of each, one a photo_id, all saved as JPEG of 90. The photographs of one terrain are
altered before: is that terrain noted, or another one? And is any noted where all photographs are
altered alike, as by one such camera? Prints both, of so many draws.
"""

import argparse
import os
from collections.abc import Callable, Mapping
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import ByteImage, FloatArray
from terrain.classification.photographs.finest_detail import SHORTEST_PX, apart, spectrum
from terrain.classification.photographs.patches import find_photos
from terrain.images import read_image, to_grey

Alteration = Callable[[ByteImage, np.random.Generator], ByteImage]
Spectra = Mapping[str, Mapping[str, FloatArray]]  # by terrain and photo_id
FOLDERS = {"ground": 400, "pavements": None, "street": None}  # side of the corner
QUALITY, FEWEST = 90, 5


def as_bytes(image: FloatArray) -> ByteImage:
    """Rounded, and cut off at black and white."""
    return np.asarray(np.clip(np.rint(image), 0, 255), np.uint8)


def saved(image: ByteImage, form: str, quality: int) -> ByteImage:
    """Pixels of a file of this form."""
    flag = cv2.IMWRITE_WEBP_QUALITY if form == ".webp" else cv2.IMWRITE_JPEG_QUALITY
    data = cv2.imencode(form, image, [flag, quality])[1]
    return np.asarray(cv2.imdecode(np.asarray(data), cv2.IMREAD_GRAYSCALE), np.uint8)


def zoomed(factor: float) -> Alteration:
    """The middle, enlarged to the whole: a digital zoom."""

    def alter(image: ByteImage, _: np.random.Generator) -> ByteImage:
        top, left = (int(side * (1 - 1 / factor) / 2) for side in image.shape)
        middle = image[top : image.shape[0] - top, left : image.shape[1] - left]
        size = image.shape[1::-1]
        return np.asarray(cv2.resize(middle, size, interpolation=cv2.INTER_CUBIC), np.uint8)

    return alter


def reduced(factor: float) -> Alteration:
    """Reduced, and enlarged to its size again."""

    def alter(image: ByteImage, _: np.random.Generator) -> ByteImage:
        small = cv2.resize(image, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)
        return np.asarray(cv2.resize(small, image.shape[1::-1], interpolation=cv2.INTER_LANCZOS4))

    return alter


def blurred(sigma: float) -> Alteration:
    """As out of focus."""
    return lambda image, _: np.asarray(cv2.GaussianBlur(image, (0, 0), sigma), np.uint8)


def noisy(deviation: float) -> Alteration:
    """With noise of so many grey levels at a grey of 128, more in bright parts."""

    def alter(image: ByteImage, rng: np.random.Generator) -> ByteImage:
        strength = deviation * np.sqrt(np.maximum(image, 8) / 128)
        return as_bytes(image + strength * rng.normal(size=image.shape))

    return alter


ALTERATIONS: dict[str, Alteration] = {
    "as it is": lambda image, _: image,
    "digital zoom 1.5": zoomed(1.5),
    "digital zoom 2": zoomed(2.0),
    "digital zoom 3": zoomed(3.0),
    "0.6 of the size and back": reduced(0.6),
    "blur of 1.2 px": blurred(1.2),
    "blur of 2.5 px": blurred(2.5),
    "noise of 6 greys": noisy(6.0),
    "noise of 12 greys": noisy(12.0),
    "median of 5 px": lambda image, _: np.asarray(cv2.medianBlur(image, 5), np.uint8),
    "WebP of 60": lambda image, _: saved(image, ".webp", 60),
    "JPEG of 40": lambda image, _: saved(image, ".jpg", 40),
    "gamma 1.8": lambda image, _: as_bytes(255 * (image / 255) ** 1.8),
    "0.4 times as bright": lambda image, _: as_bytes(0.4 * image),
    "haze": lambda image, _: as_bytes(110 + 0.4 * image),
}


def spectra_of(folder: Path, side: int | None, alter: Alteration) -> Spectra:
    """Of one photograph of each photo_id, altered and saved."""
    found: dict[str, dict[str, FloatArray]] = {}
    for number, photo in enumerate(find_photos(folder)):
        grey = to_grey(read_image(photo.path))[:side, :side]
        if min(grey.shape) >= SHORTEST_PX:
            altered = alter(grey, np.random.default_rng(number))
            of_terrain = found.setdefault(photo.label, {})
            of_terrain[photo.group] = spectrum(saved(altered, ".jpg", QUALITY))
    return {terrain: of for terrain, of in found.items() if len(of) >= FEWEST}


def counted(plain: Spectra, altered: Spectra, draws: int, rng: np.random.Generator) -> list[int]:
    """How often the altered terrain is noted, another one is, and any where all are altered."""
    counts = np.zeros(3, dtype=int)
    for _ in range(draws):
        terrains = rng.choice(sorted(plain), rng.integers(2, len(plain) + 1), replace=False)
        most = rng.integers(FEWEST, 21)
        groups = {terrain: rng.permutation(sorted(plain[terrain]))[:most] for terrain in terrains}
        one, every = (
            {terrain: np.array([of[terrain][g] for g in groups[terrain]]) for terrain in terrains}
            for of in ({**plain, terrains[0]: altered[terrains[0]]}, altered)
        )
        found = set(apart(one))
        counts += [terrains[0] in found, bool(found - {terrains[0]}), bool(apart(every))]
    return counts.tolist()


def main() -> None:
    """Print a row of each alteration."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=60)
    parser.add_argument("--seed", type=int, default=79)
    options = parser.parse_args()
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    rng = np.random.default_rng(options.seed)
    print(f"of {options.draws} draws: noted, another terrain noted; all altered alike, any noted")
    plain = {name: spectra_of(root / name, side, ALTERATIONS["as it is"])
             for name, side in FOLDERS.items()}  # fmt: skip
    for alteration, alter in ALTERATIONS.items():
        row = []
        for name, side in FOLDERS.items():
            noted = counted(plain[name], spectra_of(root / name, side, alter), options.draws, rng)
            row.append(f"{name} {noted[0]}, {noted[1]}; {noted[2]}")
        print(f"{alteration:25s}", " | ".join(row), flush=True)


if __name__ == "__main__":
    main()
