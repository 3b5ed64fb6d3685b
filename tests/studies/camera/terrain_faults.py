"""Names and notes of a model in colour where a camera is set, or its images are read, wrong.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_faults DEAL [DEAL...]
        [--only NAME...]

Models of some photographs answer the middle of others (up to four squares), all altered alike:
lights and `colour_faults`. Deals: ground and pavements (development: thirds of ground/, and of one
half of pavements/ by photo_id), held_out (thirds of the other half, by models of all the rest),
street (by a model of pavements/), street_ground. Printed for each alteration: right, wrong, sure
and wrong names of all photographs together (as a folder), without the rule of channels in another
order -> with it; how many of the models' folders have that note; the same of runs of five
photographs of one terrain each, and the share of these with that note.
"""

import argparse
import hashlib
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.arrays import ByteImage, IntArray
from odometry.recording.run import UNKNOWN
from terrain.classification.answer import Classification
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.likeness.likeness import FEWEST_IMAGES
from terrain.classification.photographs.patches import LabelledPhoto, find_photos, load_patches
from terrain.images import read_image
from tests.studies.camera.colour_faults import FAULTS, LIGHTS
from tests.studies.camera.terrain_left_out import SIZE_PX, middle

SURE, RUNS, FEWEST_GROUPS = 0.8, 10, 3
Photos = list[LabelledPhoto]
Deal = tuple[Photos, Photos]


def number(photo: LabelledPhoto, salt: str = "") -> int:
    """A number of the photo_id, that stays the same."""
    return int(hashlib.sha256((photo.group + salt).encode()).hexdigest(), 16)


def parted(photos: Photos, is_shown: Callable[[LabelledPhoto], bool]) -> Deal:
    """Photographs of training, and those that are shown."""
    return [of for of in photos if not is_shown(of)], [of for of in photos if is_shown(of)]


def deals(name: str, root: Path) -> Iterator[Deal]:
    """Of a name: photographs of training, and others."""
    folder = "ground" if "ground" in name else "pavements"
    photos = find_photos(root / folder)
    if name.startswith("street"):
        yield photos, find_photos(root / "street")
        return
    salt = {"ground": "g", "pavements": "x", "held_out": "y"}[name]
    if name == "pavements":
        photos = [of for of in photos if number(of) % 2 == 0]
    for k in range(3):
        yield parted(
            photos,
            lambda of, k=k: number(of, salt) % 3 == k and (name != "held_out" or number(of) % 2),
        )


def runs_of(photos: Photos) -> list[IntArray]:
    """Rows of all photographs, then of runs of five, of three photo_ids or more of a terrain."""
    rng = np.random.default_rng(0)
    labels, groups = (np.array([getattr(of, of_) for of in photos]) for of_ in ("label", "group"))
    runs = [np.arange(len(photos))]
    for label in np.unique(labels):
        own = np.unique(groups[labels == label])
        for _ in range(RUNS if len(own) >= FEWEST_GROUPS else 0):
            drawn = rng.choice(own, min(FEWEST_IMAGES, len(own)), replace=False)
            drawn = np.resize(drawn, FEWEST_IMAGES)
            of = [rng.choice(np.flatnonzero((groups == g) & (labels == label))) for g in drawn]
            runs.append(np.array(of))
    return runs


def scores(answers: Sequence[Classification], photos: Photos) -> IntArray:
    """Right, wrong, and sure and wrong names (3,)."""
    named = [(a, a.label == of.label) for a, of in zip(answers, photos, strict=True)]
    named = [(a, is_right) for a, is_right in named if a.label != UNKNOWN]
    sure = sum(not is_right and a.confidence >= SURE for a, is_right in named)
    right = sum(is_right for _, is_right in named)
    return np.array([right, len(named) - right, sure])


def judged(model: TerrainClassifier, photos: Photos, images: list[ByteImage]) -> IntArray:
    """Of a folder and of runs: scores without and with the rule, notes, count (2, 8)."""
    answers, found = model.classify(images), np.zeros((2, 8), int)
    for place, rows in enumerate(runs_of(photos)):
        likeness = model.likeness([images[i] for i in rows])
        for column, of in enumerate((replace(likeness, turned_beyond=0.0), likeness)):
            kept = [answers[i].unless_doubtful(of, model.noticed_share_) for i in rows]
            cells = slice(3 * column, 3 * column + 3)
            found[int(place > 0), cells] += scores(kept, [photos[i] for i in rows])
        found[int(place > 0), 6:] += likeness.turned_beyond > 1, 1
    return found


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("deals", nargs="+")
    parser.add_argument("--only", nargs="*", default=[*LIGHTS, *FAULTS])
    arguments = parser.parse_args()
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    for name in arguments.deals:
        found: dict[str, IntArray] = {}
        for train, shown in deals(name, root):
            patches = load_patches(train, SIZE_PX, max_per_photo=12)
            labels, groups = np.array(patches.labels), np.array(patches.groups)
            model = TerrainClassifier(colour=True).fit(patches.images, labels, groups)
            images = [np.ascontiguousarray(middle(read_image(of.path), 2, 2)) for of in shown]
            for change in arguments.only:
                altered = [{**LIGHTS, **FAULTS}[change](image) for image in images]
                found[change] = found.get(change, 0) + judged(model, shown, altered)
        for change, (folder, runs) in found.items():
            cells = [f"{b} -> {a}" for b, a in zip(folder[:3], folder[3:6], strict=True)]
            cells += [f"{folder[6]} of {folder[7]}; runs"]
            cells += [f"{b} -> {a}" for b, a in zip(runs[:3], runs[3:6], strict=True)]
            cells += [f"note {runs[6] / max(runs[7], 1):.3f}"]
            print(f"{name}, {change:26s}", ", ".join(cells))


if __name__ == "__main__":
    main()
