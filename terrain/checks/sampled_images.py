"""A few images spread over a run, read within bounds of time and memory."""

import hashlib
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import AnyArray, IntArray
from odometry.run import Run
from terrain.image_size import PIXELS, is_whole, stated_size

FILES = 100  # read whole: at most some hundred megabytes from the disk, one at a time
DECODED = 20  # of them, which takes about a second at two megapixels
MOST_BYTES = 64 * 1024**2  # of a file; a compressed image of PIXELS pixels is smaller


@dataclass(frozen=True)
class SampledImage:
    """One image file.

    Attributes
    ----------
    row : int
        Of images.csv.
    stamp_s : float
    file : Path
    size : (int, int) or None
        Width and height in pixels that the file states.
    damage : str
        Why it cannot be used whole, or "".
    digest : bytes
        Equal for files of equal bytes.
    """

    row: int
    stamp_s: float
    file: Path
    size: tuple[int, int] | None
    damage: str
    digest: bytes


def sample_images(run: Run) -> tuple[SampledImage, ...]:
    """Look at the headers and ends of at most FILES images; nothing is decoded."""
    if run.images is None:
        return ()
    names, stamps_s = run.images["file"], run.images.stamps_s
    return tuple(
        _sampled(int(row), float(stamps_s[row]), run.folder / str(names[row]))
        for row in spread(len(run.images), FILES)
    )


def spread(count: int, most: int) -> IntArray:
    """At most so many of the numbers below `count`, evenly spread, both ends among them."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))


def decode(image: SampledImage) -> AnyArray | None:
    """Pixels as they are stored, 16 bits kept; None where OpenCV cannot decode them."""
    if image.damage:
        return None
    try:
        encoded = np.frombuffer(image.file.read_bytes(), np.uint8)
        decoded: AnyArray | None = cv2.imdecode(encoded, cv2.IMREAD_UNCHANGED)
    except (OSError, cv2.error):
        return None
    return decoded


def _sampled(row: int, stamp_s: float, file: Path) -> SampledImage:
    try:
        count = file.stat().st_size
        encoded = file.read_bytes() if count <= MOST_BYTES else b""
    except OSError as error:
        return SampledImage(row, stamp_s, file, None, f"cannot be opened ({error.strerror})", b"")
    size = stated_size(encoded)
    damage = "too large" if count > MOST_BYTES else _damage(encoded, size)
    return SampledImage(row, stamp_s, file, size, damage, hashlib.sha256(encoded).digest())


def _damage(encoded: bytes, size: tuple[int, int] | None) -> str:
    if not encoded:
        return "empty"
    if size is None:
        return "no image"
    if size[0] * size[1] > PIXELS:
        return "too large"
    return "" if is_whole(encoded) else "truncated"
