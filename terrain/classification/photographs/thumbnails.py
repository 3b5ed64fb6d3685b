"""Small images of photographs, by which copies that were saved again are recognised."""

from collections.abc import Iterator
from functools import lru_cache

import cv2
import numpy as np

from odometry.arrays import ByteImage, FloatArray
from terrain.images import to_grey

THUMBNAIL_PX = 24
BLUR_PX = 2.0  # of the halved image: noise and compression do not count
ALIKE = 0.97  # correlation of thumbnails; of 401 photographs of terrain 0.96 at most
LEVELS = 127  # of a value that is kept


def thumbnail_of_half(grey: ByteImage) -> FloatArray:
    """Values (N,) of mean zero and length one of a halved image; zero where it is flat."""
    blurred = cv2.GaussianBlur(grey, (0, 0), BLUR_PX)
    size = (THUMBNAIL_PX, THUMBNAIL_PX)
    values = cv2.resize(blurred, size, interpolation=cv2.INTER_AREA).astype(np.float64).ravel()
    values -= values.mean()
    length = float(np.linalg.norm(values))
    return values / length if length > THUMBNAIL_PX else np.zeros_like(values)


def thumbnail(image: ByteImage) -> FloatArray:
    """The same of a whole image, grey or RGB."""
    grey = to_grey(image)
    half = (max(grey.shape[1] // 2, 1), max(grey.shape[0] // 2, 1))
    return thumbnail_of_half(cv2.resize(grey, half, interpolation=cv2.INTER_AREA).astype(np.uint8))


def thumbnail_text(image: ByteImage) -> str:
    """The thumbnail as digits, a byte a value."""
    values = thumbnail(image)
    largest = max(float(np.abs(values).max()), np.finfo(float).tiny)
    return np.rint(LEVELS * values / largest).astype(np.int8).tobytes().hex()


def views(thumbnails: FloatArray) -> Iterator[FloatArray]:
    """Thumbnails (N, values) as they are, turned by quarters and mirrored: eight times (N, values).

    Programs that make training sets larger save photographs like this, cameras held upright too.
    """
    squares = thumbnails.reshape(-1, THUMBNAIL_PX, THUMBNAIL_PX)
    for quarters in range(4):
        turned = np.rot90(squares, quarters, axes=(1, 2))
        yield turned.reshape(thumbnails.shape)
        yield turned[:, :, ::-1].reshape(thumbnails.shape)


def looks_like_one(image: ByteImage, texts: frozenset[str]) -> bool:
    """Whether an image, turned or mirrored, looks nearly like one that a text was taken of."""
    own = np.concatenate(list(views(thumbnail(image)[None])))
    return bool((_thumbnails(texts) @ own.T).max(initial=0.0) > ALIKE)


@lru_cache(maxsize=1)
def _thumbnails(texts: frozenset[str]) -> FloatArray:
    """Rows of length one, as `thumbnail` makes them; zero where that is."""
    rows = [np.frombuffer(bytes.fromhex(text), np.int8) for text in sorted(texts)]
    table = np.array(rows, dtype=np.float64).reshape(-1, THUMBNAIL_PX**2)
    lengths = np.linalg.norm(table, axis=1, keepdims=True)
    return np.asarray(table / np.maximum(lengths, np.finfo(float).tiny))
