"""Folders of photographs that are not what they seem: classes that vanish, copies, pieces."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import chain
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.findings.finding import counted
from terrain.classification.photographs.pieces import pieces
from terrain.classification.photographs.shifted_frames import shifted_frames
from terrain.classification.photographs.thumbnails import (
    ALIKE,
    THUMBNAIL_PX,
    thumbnail_of_half,
    views,
)
from terrain.errors import PatchError
from terrain.spelling import BY_SPELLING, alike_names

OTHER_SUFFIXES = (
    *(".webp", ".tif", ".tiff", ".bmp", ".gif", ".heic", ".heif", ".avif", ".ppm", ".pgm"),
    *(".jpe", ".jfif", ".jp2", ".dng"),
)


def check_classes(root: Path, classes: Sequence[str], suffixes: Sequence[str]) -> None:
    """Refuse folders of which a class would vanish, or be taken for two.

    Parameters
    ----------
    root : Path
        Of `root/<class>/photograph`.
    classes : sequence of str
        Names of folders that hold photographs.
    suffixes : sequence of str
        Of photographs.

    Raises
    ------
    PatchError
        If a folder holds images of another format alone, or photographs in folders within, or two
        names are spellings of one.
    """
    for folder in sorted(path for path in root.iterdir() if path.is_dir()):
        if folder.name in classes or folder.name.startswith("."):
            continue
        for path in sorted(folder.rglob("*")):
            if path.suffix.lower() in (*OTHER_SUFFIXES, *suffixes) and path.is_file():
                raise PatchError(
                    f"{folder} holds no photographs that are read, but {path.relative_to(folder)}; "
                    f"expected {folder}/*.jpg or *.png: convert or move its images"
                )
    if alike := alike_names(classes):
        raise PatchError(
            f"{root}: {' and '.join(map(repr, alike))} {BY_SPELLING}; expected one "
            "folder for each terrain"
        )


def unread_note(photos: Sequence[Path], suffixes: Sequence[str]) -> str:
    """Which images beside or below photographs are not read, by format or place; "" for none."""
    folders = sorted({photo.parent for photo in photos})
    below = [(path, path.parent == folder) for folder in folders for path in folder.rglob("*")]
    unread = sorted(
        path
        for path, beside in below
        if path.suffix.lower() in (OTHER_SUFFIXES if beside else (*OTHER_SUFFIXES, *suffixes))
        and not any(part.startswith(".") for part in path.relative_to(path.parents[1]).parts)
    )
    if not unread:
        return ""
    there = counted(len(photos), "photograph")
    return (
        f"not read: {counted(len(unread), 'image')} beside {there}, such as {unread[0]}: "
        "convert them to JPEG or PNG, in the folder of their terrain itself"
    )


def check_no_photo_in_two_classes(photos: Sequence[tuple[Path, str]]) -> None:
    """Refuse files of the same bytes under two labels.

    Raises
    ------
    PatchError
        That names both.
    """
    of_size: dict[int, list[tuple[Path, str]]] = defaultdict(list)
    for path, label in photos:
        of_size[path.stat().st_size].append((path, label))
    for same_size in of_size.values():
        known: dict[bytes, tuple[Path, str]] = {}
        for path, label in same_size if len(same_size) > 1 else ():
            other, labelled = known.setdefault(path.read_bytes(), (path, label))
            if labelled != label:
                raise PatchError(
                    f"{other} and {path} are the same photograph, labelled {labelled!r} and "
                    f"{label!r}; expected one label for each"
                )


def look_alikes(group_of: Mapping[Path, str]) -> list[tuple[Path, Path]]:
    """Photographs that look nearly like one of another group, each with such ones, in order.

    By the correlation of small blurred thumbnails: images of one scene, frames of a camera that
    hardly moves, copies that were compressed again, turned by quarters or mirrored. Those without
    any contrast are like none. And frames of a burst, by `shifted_frames`, and pieces of one
    photograph, by `pieces`. Of many that look alike each is named with the nearest and the first.
    """
    photos = list(group_of)
    thumbnails = np.stack([_thumbnail(photo) for photo in photos])
    alike = np.full((len(photos), len(photos)), -1.0)
    for view in views(thumbnails):
        np.maximum(alike, thumbnails @ view.T, out=alike)
    group = np.unique(list(group_of.values()), return_inverse=True)[1]
    alike[group[:, None] == group] = -1.0
    pairs: set[tuple[Path, Path]] = set()
    for one in np.flatnonzero(alike.max(axis=1) > ALIKE).tolist():
        for other in (alike[one].argmax(), (alike[one] > ALIKE).argmax()):
            pairs.add((photos[one], photos[int(other)]))
    for first, second in chain(shifted_frames(group_of), pieces(group_of)):
        pairs |= {(first, second), (second, first)}
    return sorted(pairs)


def _thumbnail(photo: Path) -> FloatArray:
    """Zero of an image that is flat or not read."""
    image = cv2.imread(str(photo), cv2.IMREAD_REDUCED_GRAYSCALE_2)
    return np.zeros(THUMBNAIL_PX**2) if image is None else thumbnail_of_half(np.asarray(image))
