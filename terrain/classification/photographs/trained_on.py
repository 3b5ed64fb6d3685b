"""What a classifier needs to be trained on, and what it was trained on."""

import hashlib
import re
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self, TypeGuard

import numpy as np

from odometry.arrays import AnyArray, ByteImage
from odometry.recording.run import UNKNOWN
from terrain.classification.photographs.thumbnails import THUMBNAIL_PX, looks_like_one
from terrain.errors import ImageError, PatchError

# What answers are called that name no terrain, and terrain that no source knows (`new_terrain`)
RESERVED = re.compile(rf"{UNKNOWN}[\s_-]*\d*", re.IGNORECASE)
PLAIN_MODES = ("1", "L", "RGB", "I;16")  # of images of Pillow
SUM_DIGITS = 16  # of SHA-256: chance matches among a million images are of the order of 1e-8


@dataclass(frozen=True)
class TrainedOn:
    """The photographs of a training set.

    Attributes
    ----------
    image_sums : frozenset of str
        Of their pixels, by `image_sum`.
    photo_ids : frozenset of str
        Those that a manifest gave.
    thumbnails : frozenset of str
        By `thumbnail_text`; none of files before version 0.25.
    """

    image_sums: frozenset[str] = frozenset()
    photo_ids: frozenset[str] = frozenset()
    thumbnails: frozenset[str] = frozenset()

    def holds(self, image: ByteImage) -> bool:
        """Whether an image is one of the photographs, with the same pixels or saved again."""
        return image_sum(image) in self.image_sums or looks_like_one(image, self.thumbnails)

    def __or__(self, other: "TrainedOn") -> "TrainedOn":
        """The photographs of both."""
        return TrainedOn(
            self.image_sums | other.image_sums,
            self.photo_ids | other.photo_ids,
            self.thumbnails | other.thumbnails,
        )

    def to_table(self) -> dict[str, list[str]]:
        """Values that JSON can hold, in order."""
        return {name: sorted(texts) for name, texts in vars(self).items()}

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Self:
        """Read what `to_table` gave.

        Raises
        ------
        KeyError, TypeError
            If a list is missing or no list of texts.
        ValueError
            If a thumbnail is none.
        """
        lists = [table["image_sums"], table["photo_ids"], table.get("thumbnails", [])]
        for texts in lists:
            if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
                raise TypeError(f"trained_on holds {texts!r}")
        if any(len(bytes.fromhex(text)) != THUMBNAIL_PX**2 for text in lists[2]):
            raise ValueError(f"trained_on holds thumbnails that are not {THUMBNAIL_PX} px wide")
        return cls(*map(frozenset, lists))


def image_sum(image: ByteImage) -> str:
    """Sum of the pixels of an image: the same for a copy under another name or lossless format."""
    content = f"{image.shape}".encode() + image.tobytes()
    return hashlib.sha256(content).hexdigest()[:SUM_DIGITS]


def holds_images(X: object) -> TypeGuard[Sequence[ByteImage]]:
    """Whether X is images, each of two axes or three, and not a table of features."""
    if hasattr(X, "shape"):
        return len(X.shape) in {3, 4}
    return isinstance(X, Sequence) and (not X or np.ndim(X[0]) in {2, 3})


def as_images(images: Iterable[Any]) -> list[ByteImage]:
    """Images as arrays; those of Pillow in colours of other kinds become RGB.

    Raises
    ------
    ImageError
        If one is no image.
    """
    found = []
    for place, image in enumerate(images):
        is_plain = getattr(image, "mode", "L") in PLAIN_MODES
        array = np.asarray(image if is_plain else image.convert("RGB"))
        if array.ndim not in {2, 3}:
            raise ImageError(
                f"image {place} is {type(image).__name__} of shape {array.shape}, expected an "
                "array (rows, columns) or (rows, columns, 3); terrain.read_image reads a file"
            )
        found.append(array)
    return found


def common_size(images: Sequence[ByteImage]) -> int:
    """Return the side of square patches of one size; PatchError for any others."""
    shapes = {image.shape[:2] for image in images}
    if len(shapes) > 1 or any(rows != columns for rows, columns in shapes):
        raise PatchError(f"patches must be square and of one size; found: {sorted(shapes)}")
    return int(images[0].shape[0])


def labels_and_groups(
    n_images: int, y: Sequence[str] | AnyArray, groups: Sequence[str] | AnyArray | None
) -> tuple[AnyArray, AnyArray]:
    """Labels and groups (n,), a group for each image where none are given.

    Raises
    ------
    PatchError
        Unless there are two classes of two groups each, with allowed names.
    """
    labels = np.asarray(y)
    of = np.arange(n_images) if groups is None else np.asarray(groups)
    _check_labels(n_images, labels, of)
    return labels, of


def _check_labels(n_images: int, labels: AnyArray, groups: AnyArray) -> None:
    if not n_images == len(labels) == len(groups):
        raise PatchError(f"{n_images} images, {len(labels)} labels and {len(groups)} groups")
    check_names(map(str, np.unique(labels).tolist()))
    photos: dict[Hashable, set[Hashable]] = {}
    for label, group in sorted(zip(labels.tolist(), groups.tolist(), strict=True)):
        photos.setdefault(label, set()).add(group)
    if len(photos) < 2 or min(map(len, photos.values())) < 2:
        seen = ", ".join(f"{label} {len(members)}" for label, members in photos.items())
        few = [str(label) for label, members in photos.items() if len(members) < 2]
        raise PatchError(
            "training needs at least 2 classes with patches of at least 2 photographs each, "
            f"so that some can be held out; photographs found: {seen or 'none'}"
            + (f". Add photographs of {', '.join(few)}" if few else "")
            + (", or leave that out" if few and len(photos) - len(few) > 1 else "")
        )


def check_names(terrains: Iterable[str]) -> None:
    """Raise PatchError if a terrain has a name of what is unknown, such as `unknown 1`."""
    for name in sorted(terrains):
        if RESERVED.fullmatch(name.strip()):
            raise PatchError(
                f"the name {name!r} is reserved for terrain that is not known; "
                "give this class the name of its terrain"
            )


def check_codes(codes: AnyArray, classes: int) -> None:
    """Raise ValueError unless codes (n,) are whole numbers that use each of the classes."""
    if codes.ndim != 1 or codes.dtype.kind != "i" or set(codes.tolist()) != set(range(classes)):
        raise ValueError(f"codes of {codes.dtype} {codes.shape} do not name {classes} classes")


def has_colour(images: Sequence[ByteImage], labels: AnyArray) -> bool:
    """Whether every image has channels, and most of each class differ between them.

    A few colourless photographs are nothing unusual; a colourless class would make colour a
    mark of its camera.
    """
    if any(image.ndim != 3 for image in images):
        return False
    coloured: dict[str, list[bool]] = {}
    for image, label in zip(images, labels, strict=True):
        coloured.setdefault(label, []).append(bool((image != image[..., :1]).any()))
    return all(2 * sum(of_class) > len(of_class) for of_class in coloured.values())
