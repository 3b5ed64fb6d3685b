"""Whether answers that are sure are right, on the training camera and on images unlike it.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_confidence [FOLDER...]

Models of four fifths of ground/ or pavements/ (96 px, 12 patches a photograph; folds by photo_id,
the first three) answer squares, up to four of a photograph: those held out, as they are and
altered, the other folder's, whose terrains the model may lack, and things (`terrain_things.py`).
Printed for each: the share with the note of one image, of squares and of whole photographs; the
share with a name; then by the votes alone and as `classify` answers: the share with a name and a
confidence of 0.9 or more, how many of these are wrong, and the expected calibration error of the
names; last that of exact probabilities by chance, squares of a photograph right or wrong together.
Bands, motion, a third of the scale and bleaching are no alteration of training as such.
"""

import argparse
import os
from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage
from odometry.recording.run import UNKNOWN
from terrain.classification.answer import Classification
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.neighbours.calibration import reliability, reliability_by_chance
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.photographs.patches import (
    LabelledPhoto,
    cut_patches,
    find_photos,
    load_patches,
)
from terrain.images import read_image
from tests.studies.camera.terrain_likeness import blurred, compressed, gamma, noisy
from tests.studies.camera.terrain_things import development, reserved

SIZE_PX, SQUARES, FOLDS, SURE = 96, 4, 3, 0.9
OTHER = {"ground": "pavements", "pavements": "ground"}
Change = Callable[[ByteImage], ByteImage]


def banded(image: ByteImage) -> ByteImage:
    """Rows brighter and darker by a third, as lamps on the mains make them."""
    waves = 1 + 0.35 * np.sin(2 * np.pi * np.arange(len(image)) / 24)
    return np.asarray(np.clip(image * waves[:, None, None], 0, 255), np.uint8)


def moved(image: ByteImage) -> ByteImage:
    """Blurred by a motion of 11 px along the rows."""
    return np.asarray(cv2.blur(image, (11, 1)), np.uint8)


def bleached(image: ByteImage) -> ByteImage:
    """As bright as snow, with a third of the contrast."""
    bright = np.clip(215 + 0.35 * (image - image.mean()), 0, 255)
    return np.asarray(bright, np.uint8)


def reduced(image: ByteImage) -> ByteImage:
    """A third of the scale."""
    return np.asarray(cv2.resize(image, None, fx=1 / 3, fy=1 / 3, interpolation=cv2.INTER_AREA))


ALTERED: dict[str, Change] = {
    "held out": lambda image: image,
    "bands of rows": banded,
    "motion of 11 px": moved,
    "a third of the scale": reduced,
    "bleached": bleached,
    "gamma 2": gamma(2.0),
    "JPEG of quality 10": compressed(10),
    "noise of 10 levels": noisy,
    "blur of 2 px": blurred(2),
}


@dataclass
class Answered:
    """Answers by the votes and as `classify` gives them, true terrains, photographs, and notes."""

    votes: list[Classification]
    answers: list[Classification]
    true: list[str]
    groups: list[str]
    square_notes: list[bool]
    photo_notes: list[bool]

    @classmethod
    def by(
        cls,
        model: TerrainClassifier,
        squares: Sequence[ByteImage],
        true: Sequence[str],
        groups: Sequence[str],
    ) -> "Answered":
        """Of squares, each an image of its own."""
        by_votes = copy(model)
        by_votes.confidence_ = None
        before = [model.classify_features(model.patch_features(square)) for square in squares]
        votes, answers = (list(map(of.checked, squares, before)) for of in (by_votes, model))
        notes = [has_note(model, square) for square in squares]
        return cls(votes, answers, list(true), list(groups), notes, [])

    def line(self) -> str:
        """The shares."""
        named = np.array([of.label != UNKNOWN for of in self.answers])
        cells = [f"{len(named):5d}", _share(self.square_notes), _share(self.photo_notes)]
        cells.append(_share(named))
        for answers in (self.votes, self.answers):
            names = np.array([likeliest(of) for of in answers])
            right = names == np.array(self.true)
            confidence = np.array([of.confidence for of in answers])
            sure = named & (confidence >= SURE)
            cells += [_share(sure), _share(~right[sure])]
            table = np.column_stack([confidence, np.zeros(len(named))])[named]
            cells.append(f"{reliability(np.where(right[named], 0, 1), table).expected_error:.3f}")
        chance = reliability_by_chance(table, np.array(self.groups)[named]).expected_error
        cells.append(f"(chance {chance:.3f})")
        return " ".join(cells)


def has_note(model: TerrainClassifier, image: ByteImage) -> bool:
    """Whether one image is said to be unlike the training photographs."""
    likeness = model.likeness([image])
    return likeness is not None and likeness.note is not None


def likeliest(answer: Classification) -> str:
    """The known terrain that it would be named."""
    return max(answer.probabilities.items(), key=lambda pair: pair[1])[0]


def _share(of: AnyArray | Sequence[bool]) -> str:
    return f"{np.mean(of):.3f}" if len(of) else "    -"


def squares_of(image: ByteImage) -> list[ByteImage]:
    """Up to four, spread evenly."""
    found = cut_patches(image, SIZE_PX)
    kept = np.linspace(0, len(found) - 1, min(len(found), SQUARES)).astype(int)
    return [found[i] for i in kept]


def of_photos(
    model: TerrainClassifier, photos: Sequence[LabelledPhoto], change: Change
) -> Answered:
    """Of squares of photographs, changed."""
    squares, true, groups, notes = [], [], [], []
    for photo in photos:
        read = read_image(photo.path)
        image = change(read if read.ndim == 3 else np.repeat(read[..., None], 3, axis=2))
        cut = squares_of(image)
        squares += cut
        true += [photo.label] * len(cut)
        groups += [photo.group] * len(cut)
        if cut:
            notes.append(has_note(model, image))
    answered = Answered.by(model, squares, true, groups)
    answered.photo_notes = notes
    return answered


def shown_to(
    model: TerrainClassifier, held: Sequence[LabelledPhoto], other: Sequence[LabelledPhoto]
) -> dict[str, Answered]:
    """Everything that a model is shown."""
    found = {name: of_photos(model, held, change) for name, change in ALTERED.items()}
    found["the other folder"] = of_photos(model, other, ALTERED["held out"])
    for name, things in (("development", development), ("test", reserved)):
        of = [squares[::3][:SQUARES] for squares in things(SIZE_PX).values()]
        every = [square for squares in of for square in squares]
        found[f"things of {name}"] = Answered.by(
            model, every, ["no terrain"] * len(every), list(map(str, range(len(every))))
        )
    return found


def folder_study(root: Path, name: str) -> None:
    """Print the shares of the models of one folder."""
    photos, other = find_photos(root / name), find_photos(root / OTHER[name])
    patches = load_patches(photos, SIZE_PX, max_per_photo=12)
    labels, groups = np.array(patches.labels), np.array(patches.groups)
    parts: dict[str, list[Answered]] = {}
    for train, held_out in grouped_folds(np.unique(labels, return_inverse=True)[1], groups)[:FOLDS]:
        images = [patches.images[i] for i in train]
        model = TerrainClassifier().fit(images, labels[train], groups[train])
        held = [photo for photo in photos if photo.group in set(groups[held_out].tolist())]
        for shown, answered in shown_to(model, held, other).items():
            parts.setdefault(shown, []).append(answered)
    print(f"{name}: squares; note of a square, of a photograph; with a name; by the votes: sure,")
    print("wrong of these, calibration error; as classify answers: the same")
    for shown, of in parts.items():
        columns = zip(*(vars(answered).values() for answered in of), strict=True)
        together = Answered(*(list(chain.from_iterable(column)) for column in columns))
        print(f"  {shown:24s}", together.line(), flush=True)


def main() -> None:
    """Print the shares."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="*", choices=[[], *OTHER], default=[])
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    for name in parser.parse_args().folders or OTHER:
        folder_study(root, name)


if __name__ == "__main__":
    main()
